"""Recordings of real people as the models see them: nine joints on a grid of 40 ms."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.skeleton import CORE_JOINTS
from agent_server.errors import InvalidInput
from agent_server.skeleton.readers.source import SourceRecording
from agent_server.skeleton.resample import Resampler
from agent_server.skeleton.retarget import Retargeter


@dataclass(frozen=True, slots=True)
class CoreStream:
    """A recording as the models see it.

    Attributes:
        stamps_ns: Shape (T,), on the grid of 40 ms; a pause starts a new grid.
        positions: Shape (T, 9, 3), metres in the camera frame.
    """

    stamps_ns: np.ndarray
    positions: Float32


def core_stream(recording: SourceRecording) -> CoreStream:
    """Retarget and resample a recording just as the server does."""
    retargeter, resampler = Retargeter(), Resampler()
    frames = []
    for frame in recording.frames:
        core = retargeter.push(frame)
        if core is not None:
            frames += resampler.push(core)
    positions = np.array([f.positions for f in frames], np.float32).reshape(-1, CORE_JOINTS, 3)
    return CoreStream(np.array([f.stamp_ns for f in frames], np.int64), positions)


def source_files(folder: Path, pattern: str) -> list[Path]:
    """Files of a set, sorted.

    Raises:
        InvalidInput: If there is none.
    """
    files = sorted(folder.glob(pattern))
    if not files:
        raise InvalidInput(f"{folder} holds no {pattern}: give the folder of the sets as --data")
    return files
