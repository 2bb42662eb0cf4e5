import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.domain.gesture import GESTURES, IDLE  # noqa: E402
from agent_server.domain.skeleton import CoreJoint  # noqa: E402
from models.data.windows import Recording, Stretch  # noqa: E402
from models.evaluation.forecasters import Forecaster, zero_velocity  # noqa: E402
from models.evaluation.gestures import (  # noqa: E402
    calibration_error,
    decisions,
    evaluate_decisions,
    false_reactions,
    hold_last,
    scores,
    sliding_seen,
)
from models.evaluation.prediction import evaluate, gain_percent, joint_speed  # noqa: E402
from models.evaluation.protocols import protocol_named  # noqa: E402


def rows(*names: str, level: float = 0.9) -> np.ndarray:
    out = np.full((len(names), len(GESTURES)), (1 - level) / 6, dtype=np.float32)
    out[np.arange(len(names)), [GESTURES.index(n) for n in names]] = level
    return out


SERVER = protocol_named("server")


def walking_on(count: int = 3) -> np.ndarray:
    """Windows in mm in which every joint of a rigid body moves by 1 mm a frame."""
    pose = 300 * np.random.default_rng(0).standard_normal((1, 1, 9, 3))
    motion = np.repeat(np.repeat(pose, 75, axis=1), count, axis=0).astype(np.float32)
    motion[..., 0] += np.arange(75)[None, :, None]
    return motion


def knows(scale: float = 1.0) -> Forecaster:
    """Goes on as fast as it went, times ``scale``."""

    def predict(seen: np.ndarray) -> np.ndarray:
        step = seen[:, -1:] - seen[:, -2:-1]
        return seen[:, -1:] + scale * step * np.arange(1, 51)[None, :, None, None]

    return Forecaster("knows", predict, 25, 9, 0)


def test_horizons_are_the_frames_at_40_ms() -> None:
    result = evaluate(zero_velocity(SERVER), SERVER, {"walk": walking_on()})
    assert result["average"]["mpjpe"] == {
        "80": 2, "160": 4, "320": 8, "400": 10, "560": 14, "1000": 25, "1500": 37, "2000": 50,
    }  # fmt: skip
    assert result["windows"] == 3


def test_speed_and_jump_are_set_against_the_truth() -> None:
    right = evaluate(knows(), SERVER, {"walk": walking_on()})["average"]
    assert max(right["mpjpe"].values()) < 0.05
    assert right["mpjs_error"] < 0.01
    fast = evaluate(knows(3.0), SERVER, {"walk": walking_on()})["average"]
    assert fast["mpjs_error"] == pytest.approx(2.0, abs=0.02)
    assert (fast["jump_mm"], fast["true_jump_mm"]) == (
        pytest.approx(3.0, abs=0.02),
        pytest.approx(1.0, abs=0.02),
    )


def test_actions_count_alike_whatever_their_number_of_windows() -> None:
    windows = {"walk": walking_on(9), "stand": np.repeat(walking_on(1)[:, :1], 75, axis=1)}
    result = evaluate(zero_velocity(SERVER), SERVER, windows)
    assert result["actions"]["walk"]["mpjpe"]["80"] == 2
    assert result["average"]["mpjpe"]["80"] == 1


def test_bones_are_compared_with_the_true_ones() -> None:
    def grows(seen: np.ndarray) -> np.ndarray:
        return np.repeat(2 * seen[:, -1:], 50, axis=1)

    swollen = evaluate(Forecaster("grows", grows, 1, 9, 0), SERVER, {"walk": walking_on()})
    assert swollen["average"]["bone_error_mm"] > 100
    assert evaluate(knows(), SERVER, {"walk": walking_on()})["average"]["bone_error_mm"] < 0.01


def test_a_model_may_need_less_than_the_protocol_shows() -> None:
    lengths = []

    def predict(seen: np.ndarray) -> np.ndarray:
        lengths.append(seen.shape[1])
        return np.repeat(seen[:, -1:], 50, axis=1)

    Forecaster("short", predict, 10, 9, 0)(walking_on()[:, :25])
    assert lengths == [10]


def test_the_speed_starts_with_the_step_from_the_last_seen_pose() -> None:
    start, future = np.zeros((1, 1, 9, 3), np.float32), np.ones((1, 4, 9, 3), np.float32)
    np.testing.assert_allclose(joint_speed(start, future), [3**0.5, 0, 0, 0], rtol=1e-6)


def test_a_gain_is_what_is_left_of_the_baseline() -> None:
    assert gain_percent({"80": 8.0, "160": 11.0}, {"80": 10.0, "160": 10.0}) == {
        "80": 20.0,
        "160": -10.0,
    }


def test_a_decision_takes_three_sure_windows_in_a_row() -> None:
    assert decisions(rows("hot", "hot")) == []
    assert decisions(rows("hot", "hot", "hot", "hot")) == [(2, "hot")]
    assert decisions(rows("hot", "hot", "cold", "hot", "hot")) == []
    assert decisions(rows(*["hot"] * 5, level=0.55)) == []
    assert decisions(rows(*[IDLE] * 5)) == []


def test_one_gesture_is_decided_on_once() -> None:
    assert [w for w, _ in decisions(rows(*["hot"] * 20))] == [2]
    again = decisions(rows(*["hot"] * 5, *[IDLE] * 15, *["hot"] * 5))
    assert [w for w, _ in again] == [2, 22]


def test_scores_count_only_classes_that_occur() -> None:
    labels = np.array([GESTURES.index(n) for n in ("hot", "hot", "idle", "idle")])
    result = scores(rows("hot", "cold", "idle", "idle"), labels)
    assert result["accuracy"] == 0.75
    assert result["balanced_accuracy"] == 0.75
    assert result["confusion"][GESTURES.index("hot")][GESTURES.index("cold")] == 1


def test_calibration_error_of_honest_and_boastful_probabilities() -> None:
    labels = np.array([GESTURES.index(n) for n in ["hot"] * 9 + ["cold"]])
    assert calibration_error(rows(*["hot"] * 10), labels) == pytest.approx(0.0, abs=1e-6)
    assert calibration_error(rows(*["smell"] * 10), labels) == pytest.approx(0.9, abs=1e-6)


def test_windows_slide_by_five_frames_and_are_normalised() -> None:
    stream = np.random.default_rng(0).standard_normal((41, 9, 3)).astype(np.float32)
    seen, last = sliding_seen(stream)
    assert last.tolist() == [24, 29, 34, 39]
    assert (seen[:, -1, CoreJoint.NAVEL] == 0).all()


def raised(height: float, frames: int = 120, onset: int = 40) -> np.ndarray:
    motion = np.zeros((frames, 9, 3), dtype=np.float32)
    motion[onset:, CoreJoint.RIGHT_WRIST, 1] = height
    return motion


def by_height(motion: np.ndarray) -> np.ndarray:
    """A classifier that holds a high right hand for a greeting."""
    high = motion[:, 24, CoreJoint.RIGHT_WRIST, 1] > 0.3
    return np.concatenate([rows("hello" if h else IDLE) for h in high])


def test_delays_run_from_onset_to_the_end_of_the_deciding_window() -> None:
    motion = raised(0.5)
    takes = [
        Recording(motion, motion, (Stretch("hello", 40, 110),), "v00"),
        Recording(motion, motion, (Stretch("hot", 40, 110),), "v00"),
        Recording(raised(0.1), raised(0.1), (Stretch("hello", 40, 110),), "v00"),
        Recording(motion, motion, (), "v00"),
    ]
    result = evaluate_decisions(by_height, hold_last, takes)
    assert (result["right"], result["wrong"], result["missed"]) == (0.3333, 0.3333, 0.3333)
    # Windows end at frames 24, 29, ...: 44, 49 and 54 are the first three that see the hand.
    assert result["delay_s_p50"] == pytest.approx((54 - 40) / 25)


def test_false_reactions_are_counted_over_time() -> None:
    result = false_reactions(by_height, hold_last, [raised(0.5, 1500, 1450), raised(0.0, 1500)])
    assert result["false_reactions"] == 1
    assert result["minutes"] == 2.0
    assert result["gestures"] == {"hello": 1}
