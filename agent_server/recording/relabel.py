"""Other labels for a recording: everything else stays as it is, in its order."""

import heapq
import shutil
from collections.abc import Iterable, Iterator
from pathlib import Path

from agent_server.domain.label import Label
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import InvalidInput
from agent_server.recording.items import Entry, Tagged, read_entries, write_entry
from agent_server.recording.reader import Recording, open_recording
from agent_server.recording.sink import AT_ONCE
from agent_server.recording.whole import whole_file
from agent_server.recording.writer import RecordingWriter


def write_labelled(
    recording: Recording, output: Path, labels: Iterable[Tagged], *, keeps_old: bool
) -> int:
    """Write a recording again, with labels.

    Args:
        recording: What is labelled.
        output: File to create.
        labels: In any order.
        keeps_old: Whether the labels that the recording has stay beside them.

    Returns:
        How many labels the recording has.

    Raises:
        RecordingError: If a file cannot be read or written.
    """
    entries = list(read_entries(recording))
    others = [entry for entry in entries if not isinstance(entry.item, Tagged)]
    new = sorted(labels, key=lambda one: one.label.onset_ns)
    with RecordingWriter(output, recording.metadata, AT_ONCE) as writer:
        for entry in _woven(entries if keeps_old else others, new):
            write_entry(writer, entry)
    return len(entries) - len(others)


def save_labels(path: Path, labels: Iterable[Label]) -> None:
    """Put these labels in the place of those that a recording has, in its own file.

    The file is replaced at once when the new one is whole, and keeps its mode and its age, by
    which old recordings are deleted. A label that stays as it was keeps its data set's tag.

    Raises:
        InvalidInput: If a label begins outside the recording.
        RecordingError: If the file cannot be read or written.
    """
    recording = open_recording(path)
    items = (entry.item for entry in read_entries(recording))
    tags = {item.label: item.tag for item in items if isinstance(item, Tagged)}
    new = [Tagged(label, tags.get(label, "")) for label in labels]
    for one in new:
        require_within(one.label, recording, path.name)
    with whole_file(path, replaces=True) as part:
        write_labelled(recording, part, new, keeps_old=False)
        shutil.copystat(path, part)


def require_within(label: Label, recording: Recording, where: str) -> None:
    """Refuse a label that begins outside a recording.

    Raises:
        InvalidInput: It names the label by ``where``.
    """
    end_ns = recording.summary.end_ns
    if not 0 <= label.onset_ns <= end_ns:
        raise InvalidInput(
            f"{where}: {label.gesture} begins at {label.onset_ns / NS_PER_S:.3f} s, outside the "
            f"recording, which lasts {end_ns / NS_PER_S:.3f} s: count seconds from its start, or "
            "shift all labels (annotate --shift)",
            field="onset_s",
        )


def _woven(entries: list[Entry], labels: list[Tagged]) -> Iterator[Entry]:
    """Labels among the records: each before the first record that is later."""
    added = [Entry(one.label.onset_ns, one) for one in labels]
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
