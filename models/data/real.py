"""Recordings of real people as the models see them: nine joints on a grid of 40 ms."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import FRAME_NS
from agent_server.domain.skeleton import CORE_JOINTS, SkeletonFrame
from agent_server.errors import InvalidInput
from agent_server.skeleton.resample import Resampler
from agent_server.skeleton.retarget import Retargeter
from models.data.windows import Recording, Stretch


@dataclass(frozen=True, slots=True)
class CoreStream:
    """A recording as the models see it.

    Attributes:
        stamps_ns: Shape (T,), on the grid of 40 ms; a pause starts a new grid.
        positions: Shape (T, 9, 3), metres in the camera frame.
    """

    stamps_ns: np.ndarray
    positions: Float32


def core_stream(skeletons: Iterable[SkeletonFrame]) -> CoreStream:
    """Retarget and resample the frames of one body just as the server does."""
    retargeter, resampler = Retargeter(), Resampler()
    frames = []
    for frame in skeletons:
        core = retargeter.push(frame)
        if core is not None:
            frames += resampler.push(core)
    positions = np.array([f.positions for f in frames], np.float32).reshape(-1, CORE_JOINTS, 3)
    return CoreStream(np.array([f.stamp_ns for f in frames], np.int64), positions)


def labelled_recordings(
    stream: CoreStream, spans: Sequence[tuple[str, int, int]], subject: str
) -> list[Recording]:
    """A recording for each part without a pause of the sensor.

    Args:
        stream: The motion.
        spans: Gesture, onset and offset in nanoseconds.
        subject: Who moves.
    """
    stamps = stream.stamps_ns
    breaks = (np.flatnonzero(np.diff(stamps) != FRAME_NS) + 1).tolist()
    parts = []
    for first, end in zip([0, *breaks], [*breaks, len(stamps)], strict=True):
        if first == end:
            continue
        stretches = []
        for gesture, onset_ns, offset_ns in spans:
            onset = round((onset_ns - int(stamps[first])) / FRAME_NS)
            offset = round((offset_ns - int(stamps[first])) / FRAME_NS)
            if onset < end - first and offset > 0:
                stretches.append(Stretch(gesture, onset, offset))
        positions = stream.positions[first:end]
        parts.append(Recording(positions, positions, tuple(stretches), subject))
    return parts


def source_files(folder: Path, pattern: str) -> list[Path]:
    """Files of a set, sorted.

    Raises:
        InvalidInput: If there is none.
    """
    files = sorted(folder.glob(pattern))
    if not files:
        raise InvalidInput(f"{folder} holds no {pattern}: give the folder of the sets as --data")
    return files
