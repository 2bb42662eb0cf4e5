"""The sets that predictors of plain motion train on: joints, windows and splits by name."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.errors import ConfigError
from models.data.clips import Clips, cut_clips
from models.data.h36m import read_h36m
from models.data.layouts import H36M, Layout
from models.data.splits import Split

MM = 0.001


@dataclass(frozen=True, slots=True)
class MotionSet:
    """A data set as predictors of plain motion see it.

    Attributes:
        layout: The joints.
        read: Folder of the sets, split -> recordings (T, J, 3) in metres.
        seen: Frames that the literature lets a model see.
        future: Frames that it asks for.
    """

    layout: Layout
    read: Callable[[Path, Split], list[Float32]]
    seen: int
    future: int

    def clips(self, data: Path, split: Split, seen: int, stride: int = 1) -> Clips:
        """All windows of a split, ``seen`` frames of past each."""
        return cut_clips(self.read(data, split), seen + self.future, stride)


def _h36m(data: Path, split: Split) -> list[Float32]:
    return [
        (sequence[:, H36M.joints] * MM).astype(np.float32)
        for sequence in read_h36m(data, split).values()
    ]


SETS: dict[str, MotionSet] = {"h36m": MotionSet(H36M, _h36m, seen=50, future=25)}


def motion_set(name: str) -> MotionSet:
    """A set by its name.

    Raises:
        ConfigError: If there is none of this name.
    """
    if name not in SETS:
        raise ConfigError(f"data is '{name}', which is none of {', '.join(SETS)}")
    return SETS[name]
