"""Labels from a table or from ELAN into a recording."""

import heapq
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from operator import attrgetter
from pathlib import Path

from agent_server.domain.label import Label
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import InvalidInput
from agent_server.qa.tools.elan import read_elan
from agent_server.qa.tools.items import Entry, Tagged, read_entries, write_entry
from agent_server.qa.tools.label_table import read_label_table
from agent_server.recording.reader import Recording, open_recording
from agent_server.recording.sink import AT_ONCE
from agent_server.recording.whole import whole_file
from agent_server.recording.writer import RecordingWriter


@dataclass(frozen=True, slots=True)
class AnnotateReport:
    """What was labelled.

    Attributes:
        added: Gesture -> number of labels that were added.
        kept: Labels that the recording had before and still has.
        removed: Labels that it had before.
    """

    added: Mapping[str, int]
    kept: int
    removed: int


def annotate(
    source: Path, output: Path, labels: Path, *, shift_ns: int = 0, replace_all: bool = False
) -> AnnotateReport:
    """Write a recording again, with labels.

    Everything else stays as it is, in its order: a replay comes to the same decisions.

    Args:
        source: A recording.
        output: File to create; it must not exist.
        labels: ``*.csv`` or ``*.eaf``.
        shift_ns: What is added to the times of the labels, for a video that began at another
            time than the recording.
        replace_all: Whether the labels that the recording has are left out.

    Raises:
        InvalidInput: If the labels are wrong or lie outside the recording.
        RecordingError: If a file cannot be read or written.
    """
    readers = {".csv": read_label_table, ".eaf": read_elan}
    read = readers.get(labels.suffix.lower())
    if read is None:
        raise InvalidInput(
            f"{labels} is neither a .csv nor an .eaf file: name one of these", field="labels"
        )
    recording = open_recording(source)
    new = [_shifted(label, shift_ns, recording, labels) for label in read(labels)]
    new.sort(key=attrgetter("onset_ns"))
    entries = list(read_entries(recording))
    old = sum(isinstance(entry.item, Tagged) for entry in entries)
    if replace_all:
        entries = [entry for entry in entries if not isinstance(entry.item, Tagged)]
    with (
        whole_file(output) as path,
        RecordingWriter(path, recording.metadata, AT_ONCE) as writer,
    ):
        for entry in _woven(entries, new):
            write_entry(writer, entry)
    return AnnotateReport(
        Counter(label.gesture for label in new),
        0 if replace_all else old,
        old if replace_all else 0,
    )


def _woven(entries: list[Entry], labels: list[Label]) -> Iterator[Entry]:
    """Labels among the records: each before the first record that is later."""
    added = [Entry(label.onset_ns, Tagged(label, "")) for label in labels]
    # Records are not sorted by time, but by when they came: the latest time so far is.
    reached = 0
    timed: list[tuple[int, Entry]] = []
    for entry in entries:
        reached = max(reached, entry.stamp_ns)
        timed.append((reached, entry))
    merged = heapq.merge(
        ((entry.stamp_ns, entry) for entry in added), timed, key=lambda pair: pair[0]
    )
    return (entry for _, entry in merged)


def _shifted(label: Label, by_ns: int, recording: Recording, path: Path) -> Label:
    moved = replace(label, onset_ns=label.onset_ns + by_ns, offset_ns=label.offset_ns + by_ns)
    end_ns = recording.summary.end_ns
    if moved.onset_ns < 0 or moved.onset_ns > end_ns:
        raise InvalidInput(
            f"{path}: {label.gesture} begins at {moved.onset_ns / NS_PER_S:.3f} s, outside the "
            f"recording, which lasts {end_ns / NS_PER_S:.3f} s: count seconds from its start, or "
            "shift all labels with --shift",
            field="onset_s",
        )
    return moved
