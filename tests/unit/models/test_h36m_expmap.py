"""Human3.6M from exponential maps: the files, the skeleton, and the rotations' convention."""

import math
import os
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")
pytest.importorskip("kornia", reason="needs the train extra")

from agent_server.errors import InvalidInput  # noqa: E402
from models.data.h36m import JOINTS, read_h36m  # noqa: E402
from models.data.h36m_expmap import (  # noqa: E402
    COLUMNS,
    PARENTS,
    SKELETON,
    positions_of,
    read_h36m_expmap,
)

DATA = Path(os.environ.get("AGENT_SERVER_DATA", "nowhere"))
needs_data = pytest.mark.skipif(
    not (DATA / "h36m").is_dir(), reason="AGENT_SERVER_DATA has no h36m"
)

NAMES = [name for name, _, _ in SKELETON]
OFFSETS = np.array([offset for _, _, offset in SKELETON])


def write(folder, name, rows, subject="S5"):
    (folder / subject).mkdir(exist_ok=True)
    np.savetxt(folder / subject / f"{name}.txt", rows, delimiter=",")


def rodrigues(vector):
    angle = np.linalg.norm(vector)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def row_vector_walk(maps):
    """The published recipe for one frame, joint by joint; the root's map is not used."""
    turned, places = [np.eye(3)], [OFFSETS[0]]
    for joint in range(1, JOINTS):
        parent = PARENTS[joint]
        turned.append(rodrigues(maps[joint]) @ turned[parent])
        places.append(OFFSETS[joint] @ turned[parent] + places[parent])
    return np.array(places)


def pose(**turns):
    """Positions with some joints turned, radians, by their names with _ for a space."""
    maps = torch.zeros(1, JOINTS, 3, dtype=torch.float64)
    for name, turn in turns.items():
        maps[0, NAMES.index(name.replace("_", " "))] = torch.tensor(turn, dtype=torch.float64)
    return dict(zip(NAMES, positions_of(maps)[0].numpy(), strict=True))


def test_every_second_row_without_the_roots_motion_is_a_frame(tmp_path):
    rows = np.random.default_rng(3).normal(size=(5, COLUMNS))
    write(tmp_path, "walking_1", rows)
    write(tmp_path, "eating_2", rows[:2])
    sequences = read_h36m_expmap(tmp_path, "test")
    assert list(sequences) == ["S5__eating_2", "S5__walking_1"]
    walking = sequences["S5__walking_1"]
    assert walking.dtype == np.float32
    assert not walking.flags.writeable
    expected = [row_vector_walk(row[3:].reshape(JOINTS, 3)) for row in rows[::2]]
    np.testing.assert_allclose(walking, expected, atol=1e-2)  # mm, kept as float32


def test_a_split_has_its_own_subjects(tmp_path):
    for subject in ("S1", "S6", "S7", "S8", "S9", "S11", "S5"):
        write(tmp_path, "walking_1", np.zeros((2, COLUMNS)), subject)
    assert list(read_h36m_expmap(tmp_path, "validation")) == ["S11__walking_1"]
    assert len(read_h36m_expmap(tmp_path, "train")) == 5


def test_at_rest_the_body_stands_and_looks_along_z():
    rest = pose()
    np.testing.assert_allclose(rest["right ankle"], [-132.948591, -897.101059, 0], atol=1e-6)
    np.testing.assert_allclose(rest["head top"], [0, 726.698112, 0], atol=1e-6)
    assert rest["left toe tip"][2] > 200


def test_a_quarter_turn_about_x_lifts_the_thigh_forwards():
    lifted = pose(left_hip=(math.pi / 2, 0, 0))
    np.testing.assert_allclose(
        lifted["left knee"] - lifted["left hip"], [0, 0, 442.894413], atol=1e-2
    )


def test_a_rotation_moves_the_joints_that_hang_on_it_and_no_others():
    rest, bent = pose(), pose(left_shoulder=(0.4, 0.2, -0.9))
    moved = {name for name in NAMES if np.linalg.norm(bent[name] - rest[name]) > 1}
    assert moved == {
        *("left elbow", "left wrist", "left hand", "left hand tip"),
        *("left thumb base", "left thumb tip"),
    }


def test_what_does_not_fit_is_named(tmp_path):
    with pytest.raises(InvalidInput, match=r"S11 holds no ACTION_N\.txt: give the folder"):
        read_h36m_expmap(tmp_path, "validation")
    write(tmp_path, "walking_1", np.zeros((4, 96)))
    with pytest.raises(InvalidInput, match=r"walking_1\.txt, line 1 has 96 columns, expected 99"):
        read_h36m_expmap(tmp_path, "test")
    rows = np.zeros((4, COLUMNS))
    rows[2, 7] = np.nan
    write(tmp_path, "walking_1", rows)
    with pytest.raises(InvalidInput, match="line 3, column 8 is 'nan', expected a finite number"):
        read_h36m_expmap(tmp_path, "test")


@needs_data
@pytest.mark.parametrize("split", ["train", "validation", "test"])
def test_the_skeleton_is_that_of_the_published_positions(split):
    lengths = np.linalg.norm(OFFSETS[1:], axis=1)
    for key, positions in read_h36m(DATA, split).items():
        bones = positions[:, 1:] - positions[:, PARENTS[1:]]
        error_mm = np.abs(np.linalg.norm(bones, axis=2) - lengths).max()
        assert error_mm < 0.2, key
        # These hang on the root, whose rotation is left out, so they show the axes too.
        hips = [NAMES.index(name) for name in ("right hip", "left hip", "spine")]
        np.testing.assert_allclose(positions[:3, hips], [OFFSETS[hips]] * 3, atol=0.06)
