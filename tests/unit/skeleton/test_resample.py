import numpy as np
import pytest

from agent_server.domain.motion import FRAME_NS
from agent_server.domain.skeleton import CoreFrame
from agent_server.errors import InvalidInput
from agent_server.skeleton.resample import Resampler

MS = 1_000_000


def at(ms: float, value: float, *, confidence: float = 1.0, body_id: int = 1) -> CoreFrame:
    return CoreFrame(
        round(ms * MS),
        body_id,
        np.full((9, 3), value, np.float32),
        np.full(9, confidence, np.float32),
    )


def stamps_ms(frames: list[CoreFrame]) -> list[float]:
    return [frame.stamp_ns / MS for frame in frames]


def test_a_stream_on_the_grid_passes_unchanged() -> None:
    resampler = Resampler()
    frames = [at(7 + 40 * index, index**2) for index in range(10)]
    for frame in frames:
        (given,) = resampler.push(frame)
        assert given is frame


def test_values_between_two_frames_are_interpolated() -> None:
    resampler = Resampler()
    assert stamps_ms(resampler.push(at(0, 0.0))) == [0]
    assert resampler.push(at(33, 3.3)) == []
    (frame,) = resampler.push(at(66, 6.6))
    assert frame.stamp_ns == FRAME_NS
    np.testing.assert_allclose(frame.positions, 4.0, rtol=1e-6)
    assert not frame.positions.flags.writeable
    assert not frame.confidence.flags.writeable


def test_a_slow_stream_gives_several_frames_at_once() -> None:
    resampler = Resampler()
    resampler.push(at(0, 0.0))
    frames = resampler.push(at(160, 16.0))
    assert stamps_ms(frames) == [40, 80, 120, 160]
    np.testing.assert_allclose([f.positions[0, 0] for f in frames], [4, 8, 12, 16], rtol=1e-6)


def test_an_interpolated_frame_is_as_certain_as_the_less_certain_neighbour() -> None:
    resampler = Resampler()
    resampler.push(at(0, 0.0, confidence=1.0))
    (between, on_it) = resampler.push(at(80, 1.0, confidence=0.5))
    (after,) = resampler.push(at(121, 1.0, confidence=1.0))
    assert between.confidence.tolist() == [0.5] * 9
    assert on_it.confidence.tolist() == [0.5] * 9
    assert after.confidence.tolist() == [0.5] * 9
    assert resampler.push(at(165, 1.0, confidence=1.0))[0].confidence.tolist() == [1.0] * 9


def test_a_pause_beyond_the_limit_starts_a_new_grid() -> None:
    resampler = Resampler(max_gap_ns=250 * MS)
    resampler.push(at(0, 0.0))
    assert stamps_ms(resampler.push(at(250, 1.0))) == [40, 80, 120, 160, 200, 240]
    assert resampler.gaps == 0
    assert stamps_ms(resampler.push(at(500.000001, 2.0))) == [500.000001]
    assert resampler.gaps == 1
    assert stamps_ms(resampler.push(at(541, 2.0))) == [540.000001]


def test_another_body_starts_a_new_grid_and_is_no_gap() -> None:
    resampler = Resampler()
    resampler.push(at(0, 0.0))
    (frame,) = resampler.push(at(50, 9.0, body_id=2))
    assert (frame.stamp_ns, frame.body_id) == (50 * MS, 2)
    assert stamps_ms(resampler.push(at(95, 9.0, body_id=2))) == [90]
    assert resampler.gaps == 0


@pytest.mark.parametrize(("ms", "body_id"), [(100, 1), (99, 1), (0, 1)])
def test_time_must_go_on(ms: float, body_id: int) -> None:
    resampler = Resampler()
    resampler.push(at(67, 0.0))
    resampler.push(at(100, 1.0))
    with pytest.raises(InvalidInput, match="in the order of capture") as caught:
        resampler.push(at(ms, 2.0, body_id=body_id))
    assert (caught.value.code, caught.value.field) == ("out_of_order", "originating_ns")
    # The refused frame has left no trace.
    (frame,) = resampler.push(at(114, 1.0))
    assert frame.stamp_ns == 107 * MS
    assert frame.positions[0, 0] == 1.0


def test_the_grid_does_not_drift() -> None:
    resampler = Resampler()
    given = [frame for index in range(3000) for frame in resampler.push(at(index * 1000 / 30, 0.0))]
    assert [frame.stamp_ns for frame in given] == [index * FRAME_NS for index in range(len(given))]
    assert len(given) == 2500


def test_another_body_starts_a_grid_of_its_own_whatever_its_stamps() -> None:
    resampler = Resampler()
    resampler.push(at(100, 0.0))
    restarted = resampler.push(at(60, 1.0, body_id=2))
    assert [(frame.stamp_ns, frame.body_id) for frame in restarted] == [(60_000_000, 2)]
    assert resampler.gaps == 0
