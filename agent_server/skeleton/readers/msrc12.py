"""MSRC-12: repetitions of one of twelve gestures a file, Kinect v1 at 30 Hz.

Fothergill, Mentis, Kohli and Nowozin, "Instructing people for training gestural interactive
systems", CHI 2012. Each recording ``NAME.csv`` (or ``.csv.gz``) has a ``NAME.tagstream``
with the moments at which the gesture has been performed.
"""

import gzip
import io
import re
import zlib
from collections import Counter
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32, Float64
from agent_server.errors import InvalidInput
from agent_server.skeleton.readers.source import (
    MAX_COORDINATE,
    Mark,
    SourceRecording,
    read_bytes,
    single_body,
)

FORMAT = "kinect_v1"
JOINTS = 20
COLUMNS = 1 + 4 * JOINTS

GESTURES: dict[str, str] = {
    "G1": "lift outstretched arms",
    "G2": "duck",
    "G3": "push right",
    "G4": "goggles",
    "G5": "wind it up",
    "G6": "shoot",
    "G7": "bow",
    "G8": "throw",
    "G9": "had enough",
    "G10": "change weapon",
    "G11": "beat both",
    "G12": "kick",
}
"""Tag -> what the person does."""

_NAME = re.compile(r"^(?P<stem>P\w+_(?P<subject>p\d+))\.csv(\.gz)?$")
_NS_PER_TICK = 1_000
_TAG_HEADER = "XQPCTick;Tag"


def read_msrc12(path: Path) -> SourceRecording:
    """Read ``NAME.csv`` or ``NAME.csv.gz``, with ``NAME.tagstream`` where it is there.

    Time 0 is the first frame in which a body is tracked. Left out and counted are frames
    without a body (``untracked``), marks beyond the frames (``mark_outside``) and marks of a
    gesture that is none of the twelve (``unknown_tag``).

    Raises:
        RecordingError: If a file cannot be read.
        InvalidInput: If its name or content is not that of the set; names file and line.
    """
    name = _NAME.match(path.name)
    if name is None:
        raise InvalidInput(
            f"{path} is not named PX_Y_ZZ_pSS.csv or .csv.gz, so its subject is unknown",
            field="name",
            code="unknown_name",
        )
    table = _table(path)
    tracked = table[:, 1:].any(axis=1)
    dropped = Counter({"untracked": int((~tracked).sum())})
    table = table[tracked]
    ticks = table[:, 0].astype(np.int64)
    if (np.diff(ticks) <= 0).any():
        raise InvalidInput(f"{path}: its ticks do not increase", field="tick", code="out_of_order")
    stamps = (ticks - ticks[:1]) * _NS_PER_TICK
    tagstream = path.with_name(f"{name['stem']}.tagstream")
    marks: tuple[Mark, ...] = ()
    if tagstream.exists() and len(ticks):
        marks, left_out = _marks(tagstream, int(ticks[0]), int(stamps[-1]))
        dropped += left_out
    return SourceRecording(
        format=FORMAT,
        subject=f"msrc12_{name['subject']}",
        frames=single_body(stamps.tolist(), _joints(table), FORMAT),
        marks=marks,
        dropped=dict(+dropped),
    )


def _table(path: Path) -> Float64:
    """Shape (rows, 81): the tick in microseconds, then x, y, z, state of every joint."""
    data = read_bytes(path)
    try:
        text = gzip.decompress(data) if path.suffix == ".gz" else data
        table = np.loadtxt(io.BytesIO(text), comments=None, ndmin=2)
    except (OSError, EOFError, zlib.error, ValueError) as error:
        raise InvalidInput(f"{path}: {error}", code="malformed") from error
    if table.size and table.shape[1] != COLUMNS:
        raise InvalidInput(
            f"{path}: expected {COLUMNS} numbers a line (a tick and {JOINTS} joints of x, y, z, "
            f"state), got {table.shape[1]}",
            code="wrong_joint_count",
        )
    usable = (np.abs(table[:, 1:]) <= MAX_COORDINATE).all(axis=1) & np.isfinite(table[:, 0])
    if not usable.all():
        raise InvalidInput(
            f"{path}, line {int(usable.argmin()) + 1}: a number is not finite, or far too large",
            code="not_finite",
        )
    return table.reshape(-1, COLUMNS)


def _joints(table: Float64) -> Float32:
    joints = table[:, 1:].reshape(-1, JOINTS, 4).astype(np.float32)
    joints[:, :, 3] = joints[:, :, 3] != 0.0
    return joints


def _marks(path: Path, first_tick: int, end_ns: int) -> tuple[tuple[Mark, ...], Counter[str]]:
    lines = read_bytes(path).decode("utf-8", errors="replace").split("\n")
    marks: list[Mark] = []
    left_out: Counter[str] = Counter()
    for number, line in enumerate(lines, start=1):
        row = line.strip()
        if not row or row == _TAG_HEADER:
            continue
        counter, _, label = row.partition(";")
        if not counter.isdecimal() or not label.strip():
            raise InvalidInput(
                f"{path}, line {number}: expected {_TAG_HEADER}, got {row!r}",
                field="XQPCTick",
                code="malformed",
            )
        tag = label.split()[0]
        stamp = (_tick(int(counter)) - first_tick) * _NS_PER_TICK
        if tag not in GESTURES:
            left_out["unknown_tag"] += 1
        elif not 0 <= stamp <= end_ns:
            left_out["mark_outside"] += 1
        else:
            marks.append(Mark(stamp, tag))
    return tuple(sorted(marks, key=lambda mark: mark.stamp_ns)), left_out


def _tick(counter: int) -> int:
    """A performance counter's value as microseconds on the csv's clock.

    It is (counter * 1000 + 49875 / 2) / 49875, rounded down, in whole numbers.
    """
    return (2_000 * counter + 49_875) // (2 * 49_875)
