"""The sets that predictors of plain motion train on: joints, windows and splits by name."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import PREDICTED_FRAMES
from agent_server.errors import ConfigError
from models.data.clips import Clips, cut_clips
from models.data.cmu import read_cmu_positions
from models.data.h36m import read_h36m
from models.data.layouts import CMU, CORE, H36M, Layout
from models.data.splits import Split, cmu_split

MM = 0.001


@dataclass(frozen=True, slots=True)
class MotionSet:
    """A data set as predictors of plain motion see it.

    Attributes:
        layout: The joints.
        read: Folder of the sets, split -> recordings (T, J, 3) in metres.
        future: Frames that the literature asks for.
    """

    layout: Layout
    read: Callable[[Path, Split], list[Float32]]
    future: int

    def clips(self, data: Path, split: Split, seen: int, stride: int = 1) -> Clips:
        """All windows of a split, ``seen`` frames of past each."""
        return cut_clips(self.read(data, split), seen + self.future, stride)


def _h36m(data: Path, split: Split) -> list[Float32]:
    return [
        (sequence[:, H36M.joints] * MM).astype(np.float32)
        for sequence in read_h36m(data, split).values()
    ]


def _cmu(data: Path, split: Split) -> list[Float32]:
    return [
        (sequence[:, CMU.joints] * MM).astype(np.float32)
        for sequence in read_cmu_positions(data, split).values()
    ]


def _core(data: Path, split: Split) -> list[Float32]:
    return [recording.observed for recording in cmu_split(data, split)]


SETS: dict[str, MotionSet] = {
    "h36m": MotionSet(H36M, _h36m, future=25),
    "cmu": MotionSet(CMU, _cmu, future=25),
    "core": MotionSet(CORE, _core, future=PREDICTED_FRAMES),
}
"""Human3.6M and CMU as the literature uses them, and the nine joints of CMU that servers see."""


def motion_set(name: str) -> MotionSet:
    """A set by its name.

    Raises:
        ConfigError: If there is none of this name.
    """
    if name not in SETS:
        raise ConfigError(f"data is '{name}', which is none of {', '.join(SETS)}")
    return SETS[name]
