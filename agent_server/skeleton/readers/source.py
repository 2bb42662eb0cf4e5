"""What every reader gives: the frames of one recording, and what had to be left out."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import MAX_STAMP_NS
from agent_server.errors import RecordingError

MAX_COORDINATE = 1e6
"""No coordinate of a body is larger, whatever the table's unit. NaN is not smaller either."""


@dataclass(frozen=True, slots=True)
class Mark:
    """A moment that the data set's authors have tagged.

    Attributes:
        stamp_ns: When, on the recording's time line.
        tag: The data set's own name of it, for example ``G4``.
    """

    stamp_ns: int
    tag: str


@dataclass(frozen=True, slots=True)
class SourceRecording:
    """One recording of another tool or data set.

    Attributes:
        format: Name of the joint table of all frames, for example ``kinect_v1``.
        subject: Who moves, unique among the data sets, for example ``msrc12_p22``.
        frames: Sorted by time; the first one is at 0 ns. Several bodies may share an instant.
        marks: Sorted by time; empty for a source without tags.
        dropped: Reason -> how many frames or marks were left out for it.
    """

    format: str
    subject: str
    frames: tuple[SkeletonFrame, ...]
    marks: tuple[Mark, ...]
    dropped: Mapping[str, int]

    @property
    def end_ns(self) -> int:
        """Time of the last frame, in nanoseconds; 0 without frames."""
        return self.frames[-1].originating_ns if self.frames else 0


def read_bytes(path: Path) -> bytes:
    """The content of a source file.

    Raises:
        RecordingError: If it cannot be read.
    """
    try:
        return path.read_bytes()
    except OSError as error:
        raise RecordingError(f"{path} cannot be read: {error.strerror or error}") from error


def single_body(stamps_ns: list[int], joints: Float32, table: str) -> tuple[SkeletonFrame, ...]:
    """Frames of one body from its whole track.

    Args:
        stamps_ns: One time a frame, in nanoseconds.
        joints: Shape (T, J, 4): x, y, z in the table's unit, then the confidence. The frames
            are views of it; nobody may write to it afterwards.
        table: Name of the joint table.
    """
    joints = np.ascontiguousarray(joints, dtype=np.float32)
    joints.flags.writeable = False
    return tuple(
        SkeletonFrame(stamp, 0, table, row) for stamp, row in zip(stamps_ns, joints, strict=True)
    )


def fold_body_id(identity: int) -> int:
    """A sensor's id of a body within 53 bits.

    Kinect v2 numbers bodies from 2**56, which a JSON number in JavaScript cannot keep; its low
    53 bits tell bodies of one recording apart as well.
    """
    return identity & MAX_STAMP_NS
