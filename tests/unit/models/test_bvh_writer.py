from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from agent_server.errors import InvalidInput
from models.data.bvh import read_bvh
from models.data.bvh_writer import write_bvh

NAMES = ("hand", "elbow", "torso", "head")
PARENTS = (1, 2, -1, 2)


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    positions = rng.normal(size=(7, 4, 3)).astype(np.float32)
    path = tmp_path / "motion.bvh"
    write_bvh(path, NAMES, PARENTS, positions, 15)
    names, found, rate = read_bvh(path)
    assert rate == pytest.approx(15)
    for at, name in enumerate(NAMES):
        np.testing.assert_allclose(found[:, names.index(name)], positions[:, at], atol=1e-5)


@pytest.mark.parametrize("parents", [(1, 0, -1, 2), (1, 2, -1)])
def test_parents_that_are_no_tree_are_refused(tmp_path: Path, parents: tuple[int, ...]) -> None:
    with pytest.raises(InvalidInput, match="of the parents are a tree"):
        write_bvh(tmp_path / "x.bvh", NAMES, parents, np.zeros((2, 4, 3), np.float32), 15)


def test_positions_of_another_shape_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match=r"ask for \(T, 4, 3\)"):
        write_bvh(tmp_path / "x.bvh", NAMES, PARENTS, np.zeros((2, 3, 3), np.float32), 15)
