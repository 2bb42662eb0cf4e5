"""Labels from a table or from ELAN into a recording."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from agent_server.domain.label import Label
from agent_server.errors import InvalidInput
from agent_server.qa.tools.elan import read_elan
from agent_server.recording.items import Tagged
from agent_server.recording.label_table import read_label_table
from agent_server.recording.reader import Recording, open_recording
from agent_server.recording.relabel import require_within, write_labelled
from agent_server.recording.whole import whole_file


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
    new = [Tagged(_shifted(label, shift_ns, recording, labels), "") for label in read(labels)]
    with whole_file(output) as path:
        old = write_labelled(recording, path, new, keeps_old=not replace_all)
    return AnnotateReport(
        Counter(tagged.label.gesture for tagged in new),
        0 if replace_all else old,
        old if replace_all else 0,
    )


def _shifted(label: Label, by_ns: int, recording: Recording, path: Path) -> Label:
    moved = replace(label, onset_ns=label.onset_ns + by_ns, offset_ns=label.offset_ns + by_ns)
    require_within(moved, recording, str(path))
    return moved
