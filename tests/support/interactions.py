"""Two simple people who sway, and files of them as SBU has them."""

from pathlib import Path

import numpy as np
from scipy.io import savemat

from models.data.interactions import OFFSET, SBU, SBU_NAMES, SCALE, Interaction

STANDING = np.array(
    [
        *((0, 1.6, 0), (0, 1.4, 0), (0, 1.1, 0)),
        *((0, 1.4, -0.15), (0, 1.15, -0.2), (0, 0.9, -0.2)),
        *((0, 1.4, 0.15), (0, 1.15, 0.2), (0, 0.9, 0.2)),
        *((0, 0.9, -0.1), (0, 0.5, -0.1), (0, 0.1, -0.1)),
        *((0, 0.9, 0.1), (0, 0.5, 0.1), (0, 0.1, 0.1)),
    ]
)
"""Looks along x; left is at -z."""


def body(lean: float) -> np.ndarray:
    """A pose (15, 3) whose hands are ``lean`` metres in front of it."""
    pose = STANDING.copy()
    pose[[5, 8], 0] += lean
    return pose


def interaction(group: str, act: str, frames: int, number: int = 1) -> Interaction:
    """One who reaches out while the other draws back, each in a way of the act's own."""
    rate = 0.1 + 0.05 * int(act)
    reach = 0.4 * np.sin(rate * np.arange(frames))
    action = np.stack([body(each) for each in reach])
    around = np.array([-1.0, 1.0, -1.0])
    reaction = np.stack([body(-0.5 * each) for each in reach]) * around
    reaction[..., 0] += 1.0 + 0.3 * np.maximum(reach, 0)[:, None]
    shift = np.array([-0.5, 0.0, 2.0 + 0.01 * number])
    return Interaction(
        f"{group}/{act}/{number:03d}",
        group,
        SBU_NAMES[act],
        (action + shift).astype(np.float32),
        (reaction + shift).astype(np.float32),
    )


def interactions(count: int) -> list[Interaction]:
    """Some of each class and of several pairs of people, of 8 to 15 frames."""
    acts, groups = list(SBU_NAMES), ("s01s02", "s02s03", "s01s03")
    return [
        interaction(groups[at % 3], acts[at % len(acts)], 8 + at % 8, at + 1) for at in range(count)
    ]


def write_sbu(data: Path, part: str, rows: list[tuple[str, str, int]]) -> list[Interaction]:
    """Write files and the list of a split; a row is group, act and frames."""
    root = data / SBU.folder
    made, lines = [], []
    for group, act, frames in rows:
        one = interaction(group, act, frames)
        folder = Path("Skeletons_Check") / one.name
        (root / folder).mkdir(parents=True)
        for person, motion in (("A", one.action), ("B", one.reaction)):
            curve = ((motion - OFFSET) / SCALE).transpose(2, 1, 0).reshape(45, frames)
            savemat(root / folder / f"skeleton_{person}.mat", {"curve_B": curve})
        lines.append(f"{folder}/skeleton_A.mat {folder}/skeleton_B.mat")
        made.append(one)
    (root / f"{part.title()}.txt").write_text("\n".join(lines) + "\n")
    return made
