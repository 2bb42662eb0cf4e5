"""MSRC-12 as the models see it: streams, tags and folds of people.

Fothergill et al., "Instructing People for Training Gestural Interactive Systems" (CHI 2012).
A tag marks the moment at which a gesture has been performed. For benchmarks only: no weight
that ships has seen these people.
"""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch

from agent_server.domain.gesture import IDLE
from agent_server.domain.motion import CLASSIFIED_FRAMES, FRAME_NS, RATE_HZ
from agent_server.skeleton.readers.msrc12 import read_msrc12
from agent_server.skeleton.readers.source import Mark
from models.data.real import CoreStream, core_stream, labelled_recordings, source_files
from models.data.windows import Recording, WindowSet

TAGS = tuple(f"G{number}" for number in range(1, 13))
STREAM_CLASSES = (*TAGS, IDLE)
"""Labels of windows of whole recordings."""
BEFORE_TAG_FRAMES = 1.5 * RATE_HZ
"""Benchmark windows start this long before the tag; the seen second ends 0.5 s before it."""
FOLDS = 3
EVERY = 4
"""Every fourth person is tested in a fold."""
VALIDATION_PEOPLE = 2
BEFORE_FRAMES = 22
AFTER_FRAMES = 14
"""In a stream, a gesture is taken to last from 0.9 s before its tag to 0.6 s after it."""


@dataclass(frozen=True, slots=True)
class TaggedStream:
    """A recording with its tags.

    Attributes:
        name: Name of the file.
        subject: Who moves.
        stream: Positions on the grid.
        marks: The tags.
    """

    name: str
    subject: str
    stream: CoreStream
    marks: tuple[Mark, ...]

    def frame_at(self, stamp_ns: int) -> float:
        """Where on the grid a moment lies, as a fractional frame."""
        stamps = self.stream.stamps_ns
        return float(np.interp(stamp_ns, stamps, np.arange(len(stamps))))


@dataclass(frozen=True, slots=True)
class Fold:
    """People of one rotation."""

    train: tuple[str, ...]
    validation: tuple[str, ...]
    test: tuple[str, ...]


def read_streams(folder: Path) -> list[TaggedStream]:
    """All recordings of the set's folder, in the order of their names.

    Raises:
        InvalidInput: If there is none.
    """
    streams = []
    for path in source_files(folder, "*.csv*"):
        recording = read_msrc12(path)
        stream = core_stream(recording.frames)
        streams.append(TaggedStream(path.name, recording.subject, stream, recording.marks))
    return streams


def folds(subjects: Collection[str]) -> list[Fold]:
    """Three rotations: every fourth person, sorted, is tested; two of the others validate."""
    people = sorted(set(subjects))
    rotations = []
    for first in range(FOLDS):
        test = people[first::EVERY]
        others = [person for person in people if person not in test]
        held = others[:: max(1, len(others) // VALIDATION_PEOPLE)][:VALIDATION_PEOPLE]
        train = tuple(person for person in others if person not in held)
        rotations.append(Fold(train, tuple(held), tuple(test)))
    return rotations


def tag_windows(
    streams: Sequence[TaggedStream], subjects: Collection[str], shift: int = 0
) -> WindowSet:
    """A window of 75 frames for each tag, which starts 1.5 s before it.

    Windows that leave their recording, or that a pause of the sensor cuts, are left out.

    Args:
        streams: Where from.
        subjects: Whose.
        shift: Frames by which windows also start earlier and later, for training.
    """
    chosen = [stream for stream in streams if stream.subject in subjects]
    starts, labels, base = [], [], 0
    for one in chosen:
        for mark in one.marks:
            middle = round(one.frame_at(mark.stamp_ns) - BEFORE_TAG_FRAMES)
            for start in range(middle - shift, middle + shift + 1):
                if _is_whole(one.stream, start):
                    starts.append(base + start)
                    labels.append(TAGS.index(mark.tag))
        base += len(one.stream.positions)
    frames = torch.from_numpy(np.concatenate([one.stream.positions for one in chosen]))
    return WindowSet(
        frames,
        frames,
        torch.tensor(starts),
        torch.tensor(labels),
        torch.tensor(labels),
        TAGS,
    )


def tagged_recordings(
    streams: Sequence[TaggedStream], subjects: Collection[str]
) -> list[Recording]:
    """Whole recordings with a stretch around each tag, cut where the sensor has paused."""
    return [
        part
        for one in streams
        if one.subject in subjects
        for part in labelled_recordings(one.stream, _spans(one.marks), one.subject)
    ]


def _is_whole(stream: CoreStream, start: int) -> bool:
    end = start + CLASSIFIED_FRAMES - 1
    if start < 0 or end >= len(stream.stamps_ns):
        return False
    span_ns = stream.stamps_ns[end] - stream.stamps_ns[start]
    return bool(span_ns == (CLASSIFIED_FRAMES - 1) * FRAME_NS)


def _spans(marks: Iterable[Mark]) -> list[tuple[str, int, int]]:
    return [
        (
            mark.tag,
            mark.stamp_ns - BEFORE_FRAMES * FRAME_NS,
            mark.stamp_ns + AFTER_FRAMES * FRAME_NS,
        )
        for mark in marks
    ]
