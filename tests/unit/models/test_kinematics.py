"""Forward kinematics: hand-computed turns, and what holds for every tree."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

torch = pytest.importorskip("torch", reason="needs the train extra")
pytest.importorskip("kornia", reason="needs the train extra")

from models.data.kinematics import forward_kinematics, rotation_matrices  # noqa: E402

PARENTS = (-1, 0, 1, 2, 1, 0)
OFFSETS = torch.tensor(
    [
        *([0.5, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.0, 0.0]),
        *([1.0, 0.0, 1.0], [0.0, 0.0, 3.0], [0.0, -1.0, 0.5]),
    ],
    dtype=torch.float64,
)
BELOW_1 = [2, 3, 4]
QUARTER = np.pi / 2


def walk(maps: np.ndarray) -> np.ndarray:
    rotations = rotation_matrices(torch.from_numpy(np.asarray(maps, dtype=np.float64)))
    return forward_kinematics(rotations, PARENTS, OFFSETS).numpy()


def no_turn(frames: int = 1) -> np.ndarray:
    return np.zeros((frames, len(PARENTS), 3))


def random_maps(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(3, len(PARENTS), 3))


seeds = st.integers(0, 2**32 - 1)


def test_without_rotations_offsets_add_up():
    expected = [[0.5, 0, 0], [0.5, 1, 0], [2.5, 1, 0], [3.5, 1, 1], [0.5, 1, 3], [0.5, -1, 0.5]]
    np.testing.assert_array_equal(walk(no_turn(2)), [expected, expected])


def test_a_quarter_turn_about_z_takes_x_to_y():
    maps = no_turn()
    maps[0, 1] = [0, 0, QUARTER]
    positions = walk(maps)[0]
    np.testing.assert_allclose(positions[2], [0.5, 3, 0], atol=1e-6)  # 1 + 2 along y
    np.testing.assert_allclose(positions[3], [0.5, 4, 1], atol=1e-6)


def test_a_childs_rotation_is_in_its_parents_axes():
    maps = no_turn()
    maps[0, 1] = [0, 0, QUARTER]
    maps[0, 2] = [QUARTER, 0, 0]  # first (1, 0, 1) -> (1, -1, 0), then -> (1, 1, 0)
    np.testing.assert_allclose(walk(maps)[0, 3], [1.5, 4, 0], atol=1e-6)


def test_a_rotation_moves_what_hangs_on_the_joint_and_nothing_else():
    maps = no_turn()
    maps[0, 1] = [0.3, -0.7, 0.4]
    moved = np.abs(walk(maps) - walk(no_turn())).max(axis=(0, 2)) > 1e-3
    assert np.flatnonzero(moved).tolist() == BELOW_1


@given(seeds)
@settings(derandomize=True, deadline=None, max_examples=25)
def test_lengths_are_kept(seed):
    positions = walk(random_maps(seed))
    bones = positions[:, 1:] - positions[:, PARENTS[1:]]
    expected = np.broadcast_to(np.linalg.norm(OFFSETS[1:], axis=1), (3, 5))
    np.testing.assert_allclose(np.linalg.norm(bones, axis=2), expected, atol=1e-5)


@given(seeds)
@settings(derandomize=True, deadline=None, max_examples=25)
def test_row_vectors_are_the_same_walk_with_transposed_rotations(seed):
    local = rotation_matrices(torch.from_numpy(random_maps(seed)))
    columns = forward_kinematics(local.transpose(-1, -2), PARENTS, OFFSETS).numpy()
    offsets = OFFSETS.numpy()
    for frame in range(3):
        turned, places = [], []
        for joint, parent in enumerate(PARENTS):
            own = local[frame, joint].numpy()
            turned.append(own if parent < 0 else own @ turned[parent])
            places.append(
                offsets[joint] if parent < 0 else offsets[joint] @ turned[parent] + places[parent]
            )
        np.testing.assert_allclose(columns[frame], places, atol=1e-9)


def test_offsets_may_change_with_time():
    offsets = OFFSETS.repeat(2, 1, 1)
    offsets[1, 1] = torch.tensor([0.0, 5.0, 0.0])
    rotations = rotation_matrices(torch.zeros(2, len(PARENTS), 3, dtype=torch.float64))
    positions = forward_kinematics(rotations, PARENTS, offsets).numpy()
    np.testing.assert_allclose(positions[1, BELOW_1] - positions[0, BELOW_1], [[0, 4, 0]] * 3)
