"""Windows of the followed person: hop, gaps, other bodies, lost bodies."""

import pytest

from agent_server.config import SubjectSettings, WindowSettings
from agent_server.domain.motion import BodyLost, Window
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import InvalidInput
from agent_server.stages.perceive import Perception
from tests.support.bodies import frame, stream

S = 1_000_000_000


def perceive(frames, window=None, subject=None):
    perception = Perception(window or WindowSettings(), subject or SubjectSettings(policy="first"))
    found = []
    for one in frames:
        found.extend(perception.push(one))
    return perception, found


def test_a_window_every_200_ms_once_a_second_was_seen():
    _, found = perceive(stream(3))
    assert [window.index for window in found] == list(range(len(found)))
    assert [window.end_ns for window in found[:3]] == [960_000_000, 1_160_000_000, 1_360_000_000]
    assert all(window.end_ns - window.start_ns == 960_000_000 for window in found)
    assert found[0].positions.shape == (25, 9, 3)
    assert not found[0].positions.flags.writeable
    assert found[0].quality.measured == 1.0


def test_the_thesis_grid_does_not_overlap():
    _, found = perceive(stream(5), WindowSettings(mode="thesis"))
    assert [window.start_ns for window in found] == [0, S, 2 * S, 3 * S, 4 * S]


def test_a_gap_empties_the_window():
    frames = [*stream(1.5), *stream(2, start=60)]  # nothing from 1.5 s to 2 s
    perception, found = perceive(frames)
    ends = [window.end_ns for window in found]
    assert not any(1.5 * S < end < 2.9 * S for end in ends)
    assert any(end > 2.9 * S for end in ends)
    assert perception.counters["gaps"] == 1


def test_another_body_is_passed_over_and_counted():
    both = sorted(
        [*stream(3), *stream(3, body_id=5, shift=(0.5, 0, -0.5))],
        key=lambda one: (one.originating_ns, one.body_id),
    )
    perception, found = perceive(both)
    assert {window.body_id for window in found} == {0}
    assert perception.counters["other_bodies"] == 90


def test_the_followed_body_is_lost_two_seconds_after_its_last_frame():
    frames = [*stream(1), *stream(4, start=30, body_id=5)]
    subject = SubjectSettings(policy="explicit", body_id=0)
    _, found = perceive(frames, subject=subject)
    lost = [one for one in found if isinstance(one, BodyLost)]
    last = stream(1)[-1].originating_ns
    assert lost == [BodyLost(last + 2 * S, 0)]


def test_time_that_passes_without_frames_finds_the_loss_once():
    perception, _ = perceive(stream(1))
    assert perception.advance(2 * S) is None
    assert isinstance(perception.advance(4 * S), BodyLost)
    assert perception.advance(5 * S) is None


def test_a_frame_that_comes_again_or_late_is_refused_and_changes_nothing():
    frames = stream(3)
    perception, _ = perceive(frames[:20])
    for late in (frames[19], frames[3]):
        with pytest.raises(InvalidInput) as refused:
            perception.push(late)
        assert refused.value.code == "out_of_order"
    found = [one for late in frames[20:] for one in perception.push(late)]
    _, expected = perceive(frames)
    assert [w.positions.tobytes() for w in found] == [w.positions.tobytes() for w in expected]


def test_a_body_with_a_joint_that_was_never_seen_gives_no_window():
    frames = [frame(index, confidence=0.0) for index in range(60)]
    perception, found = perceive(frames)
    assert not any(isinstance(one, Window) for one in found)
    assert perception.counters["incomplete"] == 60


def test_ids_that_never_end_do_not_fill_the_memory():
    perception, _ = perceive([frame(index, body_id=index) for index in range(500)])
    assert len(perception._seen_ns) <= 64


def test_a_mirrored_stream_is_reported_in_the_windows_quality():
    def mirrored(one):
        joints = one.joints.copy()
        joints[:, 0] *= -1
        return SkeletonFrame(one.originating_ns, one.body_id, one.format, joints)

    _, found = perceive(stream(6))
    assert not any("mirrored" in window.quality.warnings for window in found)
    _, found = perceive([mirrored(one) for one in stream(6)])
    assert "mirrored" in found[-1].quality.warnings
