"""Body tracks of any sensor as JSON lines, the format that is simplest to write.

The first line is a header, every further one a body at an instant; docs/kinect-json.md
describes them, with an example.
"""

from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Annotated, TypeVar

import msgspec
import numpy as np
from msgspec import Meta

from agent_server.domain.arrays import Float32
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import MAX_STAMP_NS, NS_PER_S, to_ns
from agent_server.errors import InvalidInput
from agent_server.skeleton.formats import JointFormat, get_format
from agent_server.skeleton.readers.source import (
    MAX_COORDINATE,
    SourceRecording,
    fold_body_id,
    read_bytes,
)

T = TypeVar("T")
Joint = Annotated[tuple[float, ...], Meta(min_length=3, max_length=4)]


class Header(msgspec.Struct, frozen=True):
    """First line of a file. ``rate_hz`` is needed where lines give ``frame`` and no time."""

    format: str
    subject: Annotated[str, Meta(min_length=1)] = "unknown"
    rate_hz: Annotated[float, Meta(gt=0)] | None = None


class Line(msgspec.Struct, frozen=True):
    """One body at one instant. Exactly one of the three times is given."""

    joints: dict[str, Joint] | list[Joint]
    body_id: Annotated[int, Meta(ge=0)] = 0
    originating_ns: Annotated[int, Meta(ge=0, le=MAX_STAMP_NS)] | None = None
    time_s: Annotated[float, Meta(ge=0, le=MAX_STAMP_NS / NS_PER_S)] | None = None
    frame: Annotated[int, Meta(ge=0)] | None = None


def read_kinect_json(path: Path) -> SourceRecording:
    """Read a JSON-lines export.

    Time 0 is the earliest line; lines may come in any order. A joint that a line does not name
    has confidence 0, one with three numbers has confidence 1. Lines in which no joint is
    tracked are left out and counted as ``untracked``.

    Raises:
        RecordingError: If the file cannot be read.
        InvalidInput: If its content is wrong; names file, line and field.
    """
    text = read_bytes(path).splitlines()
    rows = [(number, row) for number, row in enumerate(text, start=1) if row.strip()]
    if not rows:
        raise InvalidInput(f"{path} is empty: its first line is a header", code="empty")
    header = _decode(path, *rows[0], Header)
    try:
        reader = _LineReader(path, header.rate_hz, get_format(header.format))
    except InvalidInput as error:
        raise _wrong(path, rows[0][0], "format", str(error)) from None
    frames: list[SkeletonFrame] = []
    seen: dict[tuple[int, int], int] = {}
    dropped: Counter[str] = Counter()
    for number, row in rows[1:]:
        frame = reader.read(number, _decode(path, number, row, Line))
        before = seen.setdefault((frame.originating_ns, frame.body_id), number)
        if before != number:
            raise _wrong(
                path,
                number,
                "body_id",
                f"body {frame.body_id} is at this time in line {before} too",
            )
        if frame.joints[:, 3].any():
            frames.append(frame)
        else:
            dropped["untracked"] += 1
    return SourceRecording(
        format=header.format,
        subject=header.subject,
        frames=_from_zero(frames),
        marks=(),
        dropped=dict(dropped),
    )


class _LineReader:
    """Turns the lines of one file into frames."""

    def __init__(self, path: Path, rate_hz: float | None, table: JointFormat) -> None:
        self._path = path
        self._rate_hz = rate_hz
        self._table = table
        self._index = {_plain(name): index for index, name in enumerate(table.names)}

    def read(self, number: int, line: Line) -> SkeletonFrame:
        return SkeletonFrame(
            originating_ns=self._stamp(number, line),
            body_id=fold_body_id(line.body_id),
            format=self._table.name,
            joints=self._joints(number, line.joints),
        )

    def _stamp(self, number: int, line: Line) -> int:
        given = [
            name
            for name in ("originating_ns", "time_s", "frame")
            if getattr(line, name) is not None
        ]
        if len(given) != 1:
            raise _wrong(
                self._path,
                number,
                given[-1] if given else "time_s",
                f"give exactly one of originating_ns, time_s and frame, got {given or 'none'}",
            )
        if line.originating_ns is not None:
            return line.originating_ns
        if line.time_s is not None:
            return to_ns(line.time_s)
        if self._rate_hz is None:
            raise _wrong(self._path, number, "frame", "the header must give rate_hz for it")
        stamp = to_ns((line.frame or 0) / self._rate_hz)
        if stamp > MAX_STAMP_NS:
            raise _wrong(self._path, number, "frame", f"{line.frame} is too large")
        return stamp

    def _joints(self, number: int, given: dict[str, Joint] | list[Joint]) -> Float32:
        names = self._table.names
        joints = np.zeros((len(names), 4), dtype=np.float32)
        if isinstance(given, dict):
            for name, values in given.items():
                index = self._index.get(_plain(name))
                if index is None:
                    raise _wrong(
                        self._path,
                        number,
                        f"joints.{name}",
                        f"{self._table.name} has no such joint, it has {', '.join(names)}",
                    )
                joints[index] = self._joint(number, f"joints.{name}", values)
        elif len(given) != len(names):
            raise _wrong(
                self._path,
                number,
                "joints",
                f"{self._table.name} has {len(names)} joints, got {len(given)}",
            )
        else:
            for index, values in enumerate(given):
                joints[index] = self._joint(number, f"joints[{index}]", values)
        joints.flags.writeable = False
        return joints

    def _joint(self, number: int, field: str, values: Joint) -> Joint:
        if not all(abs(value) <= MAX_COORDINATE for value in values):
            raise _wrong(self._path, number, field, f"{values} is far too large")
        if len(values) == 3:
            return (*values, 1.0)
        if not 0.0 <= values[3] <= 1.0:
            raise _wrong(self._path, number, field, f"confidence {values[3]:g} is not in 0..1")
        return values


def _from_zero(frames: list[SkeletonFrame]) -> tuple[SkeletonFrame, ...]:
    frames = sorted(frames, key=lambda frame: (frame.originating_ns, frame.body_id))
    start = frames[0].originating_ns if frames else 0
    return tuple(replace(frame, originating_ns=frame.originating_ns - start) for frame in frames)


def _plain(name: str) -> str:
    """A joint's name without its spelling: ``SpineShoulder`` is ``spine_shoulder``."""
    return name.replace("_", "").replace(" ", "").lower()


def _decode(path: Path, number: int, row: bytes, kind: type[T]) -> T:
    try:
        return msgspec.json.decode(row, type=kind)
    except msgspec.ValidationError as error:
        sentence, _, place = str(error).partition(" - at `")
        raise _wrong(path, number, place.rstrip("`").removeprefix("$."), sentence) from None
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise _wrong(path, number, "", f"this is no JSON object: {error}") from None


def _wrong(path: Path, number: int, field: str, why: str) -> InvalidInput:
    place = f"line {number}, {field}" if field else f"line {number}"
    return InvalidInput(f"{path}, {place}: {why}", field=field or None, code="malformed")
