import numpy as np
import pytest

from agent_server.domain.skeleton import CORE_BONES
from agent_server.geometry import bones

POSE = np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0], [3.0, 4.0, 2.0]])
CHAIN = ((0, 1), (1, 2))


def test_bone_lengths_by_hand() -> None:
    np.testing.assert_array_equal(bones.bone_lengths(POSE, CHAIN), [5.0, 2.0])
    assert bones.bone_lengths(np.zeros((2, 25, 9, 3)), CORE_BONES).shape == (2, 25, 8)


def test_bone_length_error_is_the_mean_over_bones() -> None:
    longer = POSE.copy()
    longer[2, 2] = 1.0  # the second bone is 1 shorter
    assert bones.bone_length_error(longer, POSE, CHAIN) == pytest.approx(0.5)
    assert bones.bone_length_error(POSE, longer, CHAIN) == pytest.approx(0.5)


def test_gram_matrix_by_hand() -> None:
    np.testing.assert_array_equal(bones.gram_matrix(POSE), [[0, 0, 0], [0, 25, 25], [0, 25, 29]])


def test_gram_distance_of_a_stretched_pose() -> None:
    # No rotation helps against a stretch: what remains is (0.1 * size) squared.
    stretched = bones.gram_distance(1.1 * POSE, POSE)
    assert stretched == pytest.approx(0.01 * (POSE**2).sum())


@pytest.mark.parametrize("pose", [np.zeros((4, 3)), np.outer([0, 1, 2, 3], [1.0, 0, 0])])
def test_gram_distance_of_flat_poses(pose: np.ndarray) -> None:
    turned = pose @ np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    assert bones.gram_distance(pose, turned) == pytest.approx(0.0, abs=1e-28)
    assert np.isfinite(bones.gram_distance(pose, np.ones((4, 3))))
