"""What holds of the path from sensor frames to 25 Hz whatever comes in."""

from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from agent_server.domain.motion import FRAME_NS, BodyLost
from agent_server.domain.skeleton import CoreFrame, SkeletonFrame
from agent_server.skeleton.formats import FORMATS
from agent_server.skeleton.mirror import MirrorDetector
from agent_server.skeleton.normalise import denormalise, normalise
from agent_server.skeleton.resample import Resampler
from agent_server.skeleton.retarget import Retargeter
from agent_server.skeleton.subject import Policy, SubjectLock

MS = 1_000_000
law = settings(derandomize=True, deadline=None, max_examples=150)


@st.composite
def streams(draw: st.DrawFn) -> list[CoreFrame]:
    """An irregular stream of 15 to 60 Hz with a few pauses."""
    steps = draw(
        st.lists(
            st.one_of(
                st.integers(16 * MS, 67 * MS),
                st.sampled_from([40 * MS, 80 * MS, 250 * MS, 250 * MS + 1, 700 * MS]),
            ),
            max_size=40,
        )
    )
    start = draw(st.integers(0, 2**50))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    stamps = start + np.cumsum([0, *steps])
    return [
        CoreFrame(
            int(stamp),
            1,
            rng.normal(size=(9, 3)).astype(np.float32),
            rng.choice(np.float32([0.0, 0.5, 1.0]), 9),
        )
        for stamp in stamps
    ]


def resample_offline(frames: list[CoreFrame]) -> list[tuple[int, np.ndarray, np.ndarray]]:
    """The same, naively: all frames at once, each stretch without a gap for itself."""
    cuts = [i for i, (a, b) in enumerate(pairwise(frames), 1) if b.stamp_ns - a.stamp_ns > 250 * MS]
    result = []
    for begin, end in pairwise([0, *cuts, len(frames)]):
        part = frames[begin:end]
        origin = part[0].stamp_ns
        times = np.array([frame.stamp_ns - origin for frame in part], dtype=np.float64)
        values = np.stack([frame.positions for frame in part]).reshape(len(part), 27)
        for at in range(0, int(times[-1]) + 1, FRAME_NS):
            position = [np.interp(at, times, values[:, column]) for column in range(27)]
            before = part[np.flatnonzero(times <= at)[-1]].confidence
            after = part[np.flatnonzero(times >= at)[0]].confidence
            result.append((origin + at, np.reshape(position, (9, 3)), np.minimum(before, after)))
    return result


@law
@given(frames=streams())
def test_resampling_online_equals_offline(frames: list[CoreFrame]) -> None:
    resampler = Resampler(max_gap_ns=250 * MS)
    online = [on_grid for frame in frames for on_grid in resampler.push(frame)]
    offline = resample_offline(frames)
    assert [frame.stamp_ns for frame in online] == [stamp for stamp, _, _ in offline]
    for frame, (_, positions, confidence) in zip(online, offline, strict=True):
        np.testing.assert_allclose(frame.positions, positions, atol=2e-6)
        np.testing.assert_array_equal(frame.confidence, confidence)
    steps = [b.stamp_ns - a.stamp_ns for a, b in pairwise(online)]
    assert sum(step != FRAME_NS for step in steps) == resampler.gaps


@law
@given(frames=streams(), data=st.data())
def test_resampling_does_not_look_ahead(frames: list[CoreFrame], data: st.DataObject) -> None:
    split = data.draw(st.integers(0, len(frames)))
    whole, first = Resampler(), Resampler()
    everything = [f for frame in frames for f in whole.push(frame)]
    beginning = [f for frame in frames[:split] for f in first.push(frame)]
    assert [f.stamp_ns for f in beginning] == [f.stamp_ns for f in everything[: len(beginning)]]
    for early, late in zip(beginning, everything, strict=False):
        np.testing.assert_array_equal(early.positions, late.positions)


@law
@given(frames=streams(), factor=st.floats(0.5, 2.0), shift=st.floats(-2.0, 2.0))
def test_resampling_commutes_with_linear_maps(
    frames: list[CoreFrame], factor: float, shift: float
) -> None:
    def mapped(frame: CoreFrame) -> CoreFrame:
        return CoreFrame(
            frame.stamp_ns,
            frame.body_id,
            (factor * frame.positions + shift).astype(np.float32),
            frame.confidence,
        )

    plain, moved = Resampler(), Resampler()
    for frame in frames:
        for expected, got in zip(plain.push(frame), moved.push(mapped(frame)), strict=True):
            np.testing.assert_allclose(got.positions, mapped(expected).positions, atol=1e-5)


offers = st.lists(
    st.tuples(
        st.one_of(st.integers(0, 120), st.sampled_from([200, 999, 1000, 1001, 2000, 5000])),
        st.integers(1, 3),
        st.sampled_from([1.0, 2.0, 3.0]),
    ),
    max_size=60,
)


def follow(
    policy: Policy,
    shown: list[tuple[int, int, float]],
    ticks: list[int],
) -> tuple[list[bool], list[BodyLost], int | None]:
    """Verdicts and losses when time is also told at ``ticks``."""
    lock = SubjectLock(policy, body_id=2 if policy == "explicit" else None)
    verdicts, losses, now = [], [], 0
    waiting = sorted(ticks, reverse=True)
    for wait, body_id, distance in shown:
        now += wait * MS
        while waiting and waiting[-1] <= now:
            losses.append(lock.advance(waiting.pop()))
        losses.append(lock.advance(now))
        verdicts.append(lock.offer(body_id, distance, now))
    while waiting:
        losses.append(lock.advance(waiting.pop()))
    losses.append(lock.advance(now + 10_000 * MS))
    return verdicts, [loss for loss in losses if loss], lock.followed


@law
@given(
    policy=st.sampled_from(["nearest", "first", "explicit"]),
    shown=offers,
    ticks=st.lists(st.integers(0, 20_000 * MS), max_size=30),
)
def test_telling_the_time_more_often_changes_nothing(
    policy: Policy, shown: list[tuple[int, int, float]], ticks: list[int]
) -> None:
    end = (sum(wait for wait, _, _ in shown) + 10_000) * MS
    ticks = [tick for tick in ticks if tick <= end]
    assert follow(policy, shown, ticks) == follow(policy, shown, [])


@law
@given(policy=st.sampled_from(["nearest", "first", "explicit"]), shown=offers)
def test_the_lock_follows_one_body_at_a_time(
    policy: Policy, shown: list[tuple[int, int, float]]
) -> None:
    lock = SubjectLock(policy, body_id=2 if policy == "explicit" else None)
    now, seen = 0, {}
    before: int | None = None
    for wait, body_id, distance in shown:
        now += wait * MS
        lock.advance(now)
        belongs = lock.offer(body_id, distance, now)
        assert not belongs or lock.followed == body_id
        seen[body_id] = now
        after = lock.followed
        if before is not None and after != before:
            # Nobody loses the lock who was there within the last second.
            assert now - seen[before] >= 1_000 * MS or before == body_id
        if policy == "explicit":
            assert belongs == (body_id == 2)
        before = after


@law
@given(name=st.sampled_from(sorted(FORMATS)), seed=st.integers(0, 2**32 - 1))
def test_retargeting_fills_like_the_naive_version(name: str, seed: int) -> None:
    """Joint by joint: the last row with confidence, and nothing before all have been seen."""
    rng = np.random.default_rng(seed)
    width = len(FORMATS[name].names)
    retargeter, reference = Retargeter(), Retargeter()
    last: dict[int, np.ndarray] = {}
    for index in range(12):
        joints = rng.normal(size=(width, 4)).astype(np.float32)
        joints[:, 3] = 1.0
        whole = reference.push(SkeletonFrame(index * 33 * MS, 1, name, joints))
        assert whole is not None
        hidden = rng.random(width) < 0.15
        partial = joints.copy()
        partial[hidden] = 0.0
        core = retargeter.push(SkeletonFrame(index * 33 * MS, 1, name, partial))
        tracked = [
            not any(hidden[FORMATS[name].names.index(joint)] for joint, _ in shares)
            for shares in FORMATS[name].core
        ]
        last.update({j: whole.positions[j] for j in range(9) if tracked[j]})
        assert (core is None) == (len(last) < 9)
        if core is not None:
            np.testing.assert_array_equal(core.positions, [last[j] for j in range(9)])
            np.testing.assert_array_equal(core.confidence, np.float32(tracked))


@law
@given(seed=st.integers(0, 2**32 - 1), batch=st.integers(1, 4))
def test_normalising_a_batch_equals_a_loop_and_can_be_undone(seed: int, batch: int) -> None:
    motion = np.random.default_rng(seed).normal(0, 3, (batch, 75, 9, 3)).astype(np.float32)
    moved, origin = normalise(motion)
    for one, one_moved, one_origin in zip(motion, moved, origin, strict=True):
        alone, alone_origin = normalise(one)
        np.testing.assert_array_equal(alone, one_moved)
        np.testing.assert_array_equal(alone_origin, one_origin)
    np.testing.assert_allclose(denormalise(moved, origin), motion, atol=2e-6)


@law
@given(seed=st.integers(0, 2**32 - 1), data=st.data())
def test_the_mirror_verdict_does_not_depend_on_place_or_size(
    seed: int, data: st.DataObject
) -> None:
    rng = np.random.default_rng(seed)
    motion = rng.normal(0, 0.02, (40, 5, 9, 3)).astype(np.float32)
    motion += np.float32(
        [
            *((0.0, 0.6, 2.0), (0.0, 0.4, 2.0), (0.0, 0.0, 2.0)),
            *((0.18, 0.35, 2.0), (0.25, 0.1, 2.0), (0.24, -0.1, 1.9)),
            *((-0.18, 0.35, 2.0), (-0.25, 0.1, 2.0), (-0.24, -0.1, 1.9)),
        ]
    ).reshape(9, 3)
    shift = np.float32([data.draw(st.floats(-3, 3)) for _ in range(3)])
    swap = [0, 1, 2, 6, 7, 8, 3, 4, 5]
    confidence = np.ones((5, 9), np.float32)
    here, there, mended = MirrorDetector(), MirrorDetector(), MirrorDetector()
    for chunk in motion:
        said = here.update(chunk, confidence)
        assert there.update(chunk + shift, confidence) == said
        assert not mended.update(chunk[:, swap], confidence)
    assert said
