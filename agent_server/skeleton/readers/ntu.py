"""NTU RGB+D and NTU RGB+D 120: ``.skeleton`` text files, Kinect v2 at 30 Hz.

Shahroudy, Liu, Ng and Wang, "NTU RGB+D: A large scale dataset for 3D human activity
analysis", CVPR 2016. A file holds the number of frames; each frame the number of bodies; each
body a line about it (ten numbers, the first its id), the number of joints (25), and a line a
joint: x, y, z in metres, its place in the depth and the colour image, its orientation as a
quaternion, and its tracking state (0 not tracked, 1 inferred, 2 tracked).
"""

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import to_ns
from agent_server.errors import InvalidInput
from agent_server.skeleton.readers.source import (
    MAX_COORDINATE,
    Mark,
    SourceRecording,
    fold_body_id,
    read_bytes,
)

FORMAT = "ntu"
RATE_HZ = 30
JOINTS = 25
BODY_NUMBERS = 10
JOINT_NUMBERS = 12

_NAME = re.compile(r"^S\d{3}C\d{3}(?P<subject>P\d{3})R\d{3}(?P<action>A\d{3})\.skeleton$")
_CONFIDENCE = {"0": 0.0, "1": 0.5, "2": 1.0}


def read_ntu(path: Path) -> SourceRecording:
    """Read one ``SsssCcccPpppRrrrAaaa.skeleton`` file.

    Time 0 is the first frame that shows a body; frames before and without one are counted as
    ``empty``. Bodies keep their ids, folded into 53 bits. The action becomes a mark at 0 ns,
    for example ``A023``.

    Raises:
        RecordingError: If the file cannot be read.
        InvalidInput: If its name or content is not that of the set; names file, line, field.
    """
    name = _NAME.match(path.name)
    if name is None:
        raise InvalidInput(
            f"{path} is not named SsssCcccPpppRrrrAaaa.skeleton, so its action and subject are "
            "unknown",
            field="name",
            code="unknown_name",
        )
    text = _Lines(path)
    dropped: Counter[str] = Counter()
    frames: list[SkeletonFrame] = []
    first: int | None = None
    for index in range(text.count("frame count")):
        bodies = list(_bodies(text))
        if not bodies:
            dropped["empty"] += 1
            continue
        first = index if first is None else first
        stamp = to_ns((index - first) / RATE_HZ)
        frames += (SkeletonFrame(stamp, body, FORMAT, joints) for body, joints in bodies)
    return SourceRecording(
        format=FORMAT,
        subject=f"ntu_{name['subject'].lower()}",
        frames=tuple(frames),
        marks=(Mark(0, name["action"]),),
        dropped=dict(dropped),
    )


class _Lines:
    """The lines of a file, taken one by one; knows where it is for the errors."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._lines = read_bytes(path).decode("ascii", errors="replace").splitlines()
        self._number = 0

    def take(self, field: str, numbers: int) -> list[str]:
        """The next line, split into as many values as ``numbers``."""
        if self._number == len(self._lines):
            raise self.wrong(field, "the file ends here")
        values = self._lines[self._number].split()
        self._number += 1
        if len(values) != numbers:
            raise self.wrong(field, f"expected {numbers} numbers, got {len(values)}")
        return values

    def count(self, field: str) -> int:
        """The next line, a whole number that is not negative."""
        value = self.take(field, 1)[0]
        if not value.isdecimal():
            raise self.wrong(field, f"expected a whole number, got {value!r}")
        return int(value)

    def wrong(self, field: str, why: str) -> InvalidInput:
        """What to raise about the line that was taken last."""
        return InvalidInput(
            f"{self._path}, line {self._number}, {field}: {why}", field=field, code="malformed"
        )


def _bodies(text: _Lines) -> Iterator[tuple[int, Float32]]:
    """Id and joints, shape (25, 4), of every body of the next frame."""
    seen: set[int] = set()
    for _ in range(text.count("body count")):
        identity = text.take("body", BODY_NUMBERS)[0]
        if not identity.isdecimal():
            raise text.wrong("body id", f"expected a whole number, got {identity!r}")
        body = fold_body_id(int(identity))
        if body in seen:
            raise text.wrong("body id", f"{identity} comes twice in one frame")
        seen.add(body)
        joints = text.count("joint count")
        if joints != JOINTS:
            raise text.wrong("joint count", f"expected {JOINTS}, got {joints}")
        yield body, _joints(text)


def _joints(text: _Lines) -> Float32:
    joints = np.empty((JOINTS, 4), dtype=np.float32)
    for index in range(JOINTS):
        field = f"joints[{index}]"
        values = text.take(field, JOINT_NUMBERS)
        try:
            place = [float(value) for value in values[:3]]
            confidence = _CONFIDENCE[values[-1]]
        except ValueError:
            raise text.wrong(field, f"x, y, z are {values[:3]}") from None
        except KeyError:
            raise text.wrong(field, f"tracking state {values[-1]!r} is none of 0, 1, 2") from None
        if not all(abs(value) <= MAX_COORDINATE for value in place):
            raise text.wrong(field, f"x, y, z are {values[:3]}: not finite, or far too large")
        joints[index] = *place, confidence
    joints.flags.writeable = False
    return joints
