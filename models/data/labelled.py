"""Recordings of one's own: MCAP files with labels, or MSRC-12's own files, as windows see them."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from agent_server.domain.gesture import IDLE
from agent_server.domain.inputs import RawInput
from agent_server.domain.motion import CLASSIFIED_FRAMES, RATE_HZ
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import InvalidInput
from agent_server.recording import topics
from agent_server.recording.reader import open_recording
from agent_server.recording.records import LabelRecord
from agent_server.skeleton.retarget import navel_distance
from agent_server.skeleton.subject import SubjectLock
from models.data.msrc12 import read_streams, tagged_recordings
from models.data.real import core_stream, labelled_recordings
from models.data.windows import Recording

FEWEST_REPETITIONS = 5
"""A gesture that somebody shows less often than this teaches nothing."""


@dataclass(frozen=True, slots=True)
class GestureSet:
    """Labelled recordings of some people.

    Attributes:
        recordings: Parts without a pause, each with the gestures that it shows.
        gestures: Names of the gestures, sorted; ``idle`` is none of them.
        subjects: Who moves, sorted.
    """

    recordings: tuple[Recording, ...]
    gestures: tuple[str, ...]
    subjects: tuple[str, ...]

    def of(self, *subjects: str) -> list[Recording]:
        """The recordings of some people."""
        return [one for one in self.recordings if one.subject in subjects]


def read_gestures(folder: Path, tags: bool = False) -> GestureSet:
    """Read the labelled recordings of a folder.

    Args:
        folder: Holds ``*.mcap`` with labels, or ``*.csv.gz`` with tagstreams of MSRC-12.
        tags: Take the data set's own names of the gestures, which converted recordings keep.

    Raises:
        InvalidInput: If there is nothing to learn from; the text says what to do.
        RecordingError: If a file cannot be read.
    """
    paths = sorted(folder.glob("*.mcap"))
    if paths:
        recordings = [part for path in paths for part in _read(path, tags)]
    elif any(folder.glob("*.tagstream")):
        streams = read_streams(folder)
        recordings = tagged_recordings(streams, {stream.subject for stream in streams})
    else:
        raise InvalidInput(
            f"{folder} holds no recordings: give a folder of *.mcap with labels (agent-server "
            "gestures record) or of MSRC-12's *.csv with *.tagstream"
        )
    shown = {stretch.gesture for one in recordings for stretch in one.stretches or ()}
    return GestureSet(
        tuple(recordings),
        tuple(sorted(shown)),
        tuple(sorted({one.subject for one in recordings})),
    )


def check_known(gestures: Sequence[str], known: Sequence[str], source: str) -> None:
    """Refuse gestures that nobody knows.

    Raises:
        InvalidInput: Names them, and what is known.
    """
    unknown = [name for name in gestures if name not in known]
    if unknown:
        raise InvalidInput(
            f"the recordings show {', '.join(unknown)}, {source} knows {', '.join(known)}: "
            "correct the labels, leave those recordings out, or train with them"
        )


def check_repetitions(recordings: Sequence[Recording], gestures: Sequence[str]) -> None:
    """Refuse to learn a gesture that is hardly shown.

    Raises:
        InvalidInput: Names the first one, and how often it is there.
    """
    count = Counter(stretch.gesture for one in recordings for stretch in one.stretches or ())
    for name in gestures:
        if count[name] < FEWEST_REPETITIONS:
            raise InvalidInput(
                f"{name} is shown {count[name]} times by the people to train on: record at least "
                f"{FEWEST_REPETITIONS} repetitions (agent-server gestures record {name})"
            )


def _read(path: Path, tags: bool) -> list[Recording]:
    recording = open_recording(path)
    labels = [
        record.message
        for record in recording.records((topics.LABEL.name,))
        if isinstance(record.message, LabelRecord)
    ]
    if not labels:
        raise InvalidInput(
            f"{path} has no labels: record it with agent-server gestures record, or leave it out"
        )
    subjects = {label.subject for label in labels}
    if len(subjects) > 1:
        raise InvalidInput(
            f"{path} has labels of {', '.join(sorted(subjects))}: record one person a file"
        )
    stream = core_stream(_followed(recording.events()))
    if len(stream.positions) < CLASSIFIED_FRAMES:
        raise InvalidInput(
            f"{path} has {len(stream.positions) / RATE_HZ:.1f} s of skeletons, at least "
            f"{CLASSIFIED_FRAMES / RATE_HZ:g} s are needed: record it again"
        )
    spans = [
        (label.tag if tags and label.tag else label.gesture, label.onset_ns, label.offset_ns)
        for label in labels
    ]
    shown = [span for span in spans if span[0] != IDLE]
    return labelled_recordings(stream, shown, labels[0].subject)


def _followed(events: Iterable[RawInput]) -> Iterator[SkeletonFrame]:
    """The frames of the person whom the server would follow, whichever id the sensor gives."""
    lock = SubjectLock("nearest")
    for frame in events:
        if not isinstance(frame, SkeletonFrame):
            continue
        lock.advance(frame.originating_ns)
        if lock.offer(frame.body_id, navel_distance(frame), frame.originating_ns):
            yield frame
