import numpy as np
import pytest

from agent_server.domain.arrays import Float32
from agent_server.domain.skeleton import CoreJoint
from agent_server.skeleton.quality import assess

POSE = np.array(
    [
        *((0.0, 0.60, 2.0), (0.0, 0.40, 2.0), (0.0, 0.0, 2.0)),
        *((-0.18, 0.35, 2.0), (-0.25, 0.10, 2.02), (-0.24, -0.10, 1.90)),
        *((0.18, 0.35, 2.0), (0.25, 0.10, 2.02), (0.24, -0.10, 1.90)),
    ],
    np.float32,
)


def still(pose: Float32 = POSE) -> tuple[Float32, Float32]:
    return np.repeat(pose[None], 25, axis=0), np.ones((25, 9), np.float32)


def test_a_person_who_stands_still_is_beyond_doubt() -> None:
    quality = assess(*still())
    assert (quality.measured, quality.filled, quality.warnings) == (1.0, 0.0, ())
    assert quality.bone_deviation == pytest.approx(0.0, abs=1e-6)


def test_shares_count_joint_samples() -> None:
    positions, confidence = still()
    confidence[:5, CoreJoint.LEFT_WRIST] = 0.0
    confidence[5:15, CoreJoint.LEFT_WRIST] = 0.5
    quality = assess(positions, confidence)
    assert quality.measured == pytest.approx(1 - 15 / 225)
    assert quality.filled == pytest.approx(5 / 225)


@pytest.mark.parametrize("factor", [1.3, 0.6])
def test_bone_deviation_is_relative_to_the_median_length(factor: float) -> None:
    positions, confidence = still()
    elbow, wrist = CoreJoint.RIGHT_ELBOW, CoreJoint.RIGHT_WRIST
    positions[11, wrist] = positions[11, elbow] + factor * (
        positions[11, wrist] - positions[11, elbow]
    )
    quality = assess(positions, confidence)
    assert quality.bone_deviation == pytest.approx(abs(factor - 1), abs=1e-5)
    assert quality.warnings == ()


def test_a_bone_that_jumps_is_reported() -> None:
    positions, confidence = still()
    positions[11, CoreJoint.RIGHT_WRIST] += (0.0, 0.0, 0.5)
    assert assess(positions, confidence).warnings == ("bone_length",)


@pytest.mark.parametrize("unit", [1000.0, 100.0, 0.01, 0.0])
def test_a_wrong_unit_is_reported(unit: float) -> None:
    positions, confidence = still(POSE * np.float32(unit))
    quality = assess(positions, confidence)
    assert "bone_length" in quality.warnings
    assert np.isfinite(quality.bone_deviation)


def test_a_joint_that_keeps_its_position_does_not_count_as_a_bone_that_stretches() -> None:
    positions, confidence = still()
    positions += np.linspace(0, 1, 25, dtype=np.float32)[:, None, None]
    wrist = CoreJoint.LEFT_WRIST
    positions[10:, wrist] = positions[10, wrist]
    assert assess(positions, confidence).bone_deviation > 1.0
    confidence[10:, wrist] = 0.0
    assert assess(positions, confidence).bone_deviation == pytest.approx(0.0, abs=1e-5)


def test_a_body_of_which_nothing_is_measured_has_no_bones_to_judge() -> None:
    positions, confidence = still()
    quality = assess(positions, 0 * confidence)
    assert (quality.measured, quality.filled, quality.bone_deviation) == (0.0, 1.0, 0.0)
    assert quality.warnings == ("occluded",)


@pytest.mark.parametrize(("joints", "reported"), [(1, False), (2, True)])
def test_two_hidden_joints_are_an_occlusion(joints: int, reported: bool) -> None:
    positions, confidence = still()
    confidence[:, -joints:] = 0.5
    assert ("occluded" in assess(positions, confidence).warnings) == reported


def bow(degrees: float) -> Float32:
    """The pose tilted forwards around the navel."""
    angle = np.deg2rad(degrees)
    turn = np.array(
        [
            [1, 0, 0],
            [0, np.cos(angle), np.sin(angle)],
            [0, -np.sin(angle), np.cos(angle)],
        ]
    )
    return ((POSE - POSE[2]) @ turn.T + POSE[2]).astype(np.float32)


@pytest.mark.parametrize(
    ("degrees", "reported"), [(0, False), (110, False), (130, True), (180, True)]
)
def test_upside_down_is_more_than_a_deep_bow(degrees: float, reported: bool) -> None:
    assert ("upside_down" in assess(*still(bow(degrees))).warnings) == reported


def test_a_flipped_vertical_axis_is_upside_down() -> None:
    assert assess(*still(POSE * np.float32([1, -1, 1]))).warnings == ("upside_down",)


def test_the_stream_says_whether_it_is_mirrored() -> None:
    assert assess(*still(), mirrored=True).warnings == ("mirrored",)
