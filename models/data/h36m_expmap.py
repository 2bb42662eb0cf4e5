"""Human3.6M in the published exponential-map text layout.

``S5/walking_1.txt``: comma-separated rows of 33 triples, the root's translation and then 32
joints as exponential maps in radians, at 50 rows a second. Use is limited to academic
evaluation, as with the npz of :mod:`models.data.h36m`, which holds the positions that this
reader computes.
"""

from collections.abc import Mapping
from pathlib import Path

import torch

from agent_server.domain.arrays import Float32, frozen
from agent_server.errors import InvalidInput
from models.data.h36m import JOINTS, SUBJECTS, Split
from models.data.kinematics import forward_kinematics, rotation_matrices
from models.data.tables import read_rows

COLUMNS = 3 * (1 + JOINTS)
ROWS_PER_FRAME = 2

SKELETON: tuple[tuple[str, int, tuple[float, float, float]], ...] = (
    ("hips", -1, (0.0, 0.0, 0.0)),
    ("right hip", 0, (-132.948591, 0.0, 0.0)),
    ("right knee", 1, (0.0, -442.894612, 0.0)),
    ("right ankle", 2, (0.0, -454.206447, 0.0)),
    ("right toe base", 3, (0.0, 0.0, 162.767078)),
    ("right toe tip", 4, (0.0, 0.0, 74.999437)),
    ("left hip", 0, (132.948826, 0.0, 0.0)),
    ("left knee", 6, (0.0, -442.894413, 0.0)),
    ("left ankle", 7, (0.0, -454.20659, 0.0)),
    ("left toe base", 8, (0.0, 0.0, 162.767426)),
    ("left toe tip", 9, (0.0, 0.0, 74.999948)),
    ("spine", 0, (0.0, 0.1, 0.0)),
    ("mid spine", 11, (0.0, 233.383263, 0.0)),
    ("neck", 12, (0.0, 257.077681, 0.0)),
    ("head", 13, (0.0, 121.134938, 0.0)),
    ("head top", 14, (0.0, 115.002227, 0.0)),
    ("left collar", 12, (0.0, 257.077681, 0.0)),
    ("left shoulder", 16, (0.0, 151.034226, 0.0)),
    ("left elbow", 17, (0.0, 278.882773, 0.0)),
    ("left wrist", 18, (0.0, 251.733451, 0.0)),
    ("left thumb base", 19, (0.0, 0.0, 0.0)),
    ("left thumb tip", 20, (0.0, 0.0, 99.999627)),
    ("left hand", 19, (0.0, 100.000188, 0.0)),
    ("left hand tip", 22, (0.0, 0.0, 0.0)),
    ("right collar", 12, (0.0, 257.077681, 0.0)),
    ("right shoulder", 24, (0.0, 151.031437, 0.0)),
    ("right elbow", 25, (0.0, 278.892924, 0.0)),
    ("right wrist", 26, (0.0, 251.72868, 0.0)),
    ("right thumb base", 27, (0.0, 0.0, 0.0)),
    ("right thumb tip", 28, (0.0, 0.0, 99.999888)),
    ("right hand", 27, (0.0, 137.499922, 0.0)),
    ("right hand tip", 30, (0.0, 0.0, 0.0)),
)
"""Name, parent (-1 for none) and offset from it in mm of the 32 joints, in the files' order: the
one skeleton that the set gives all its subjects. x points to the body's left, y up, z forwards;
an arm's offsets run along y, since its rotation in the rest pose is not zero."""

PARENTS = tuple(parent for _, parent, _ in SKELETON)


def positions_of(exponential_maps: torch.Tensor) -> torch.Tensor:
    """Joint positions from rotations; the root's orientation is taken as zero.

    Args:
        exponential_maps: Shape (T, 32, 3), radians.

    Returns:
        Shape (T, 32, 3), mm.
    """
    maps = exponential_maps.clone()
    maps[:, 0] = 0.0
    offsets = torch.tensor([offset for _, _, offset in SKELETON], dtype=maps.dtype)
    # The set is written for row vectors, hence the transpose.
    return forward_kinematics(rotation_matrices(maps).transpose(-1, -2), PARENTS, offsets)


def read_h36m_expmap(folder: Path, split: Split) -> Mapping[str, Float32]:
    """Sequences of a split at 25 Hz by key, in the order of their names.

    Args:
        folder: Folder that holds ``S1/``, ``S5/`` and so on.
        split: ``train``, ``validation`` or ``test``.

    Returns:
        Key, for example ``S5__walking_1`` -> positions, shape (T, 32, 3), read-only, mm, the
        root's translation and orientation dropped; what :func:`models.data.h36m.read_h36m` gives.

    Raises:
        InvalidInput: If a subject of the split is not there or a file does not fit the layout.
    """
    sequences: dict[str, Float32] = {}
    for subject in SUBJECTS[split]:
        paths = sorted((folder / subject).glob("*.txt"))
        if not paths:
            raise InvalidInput(
                f"{folder / subject} holds no ACTION_N.txt: give the folder that holds "
                f"{', '.join(SUBJECTS[split])}"
            )
        for path in paths:
            rows = read_rows(path, COLUMNS)[::ROWS_PER_FRAME, 3:]
            maps = torch.from_numpy(rows.reshape(-1, JOINTS, 3))
            sequences[f"{subject}__{path.stem}"] = frozen(
                positions_of(maps).numpy(), (None, JOINTS, 3)
            )
    return dict(sorted(sequences.items()))
