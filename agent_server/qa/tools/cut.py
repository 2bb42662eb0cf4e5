"""A part of a recording as a recording of its own."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from agent_server.config import Settings
from agent_server.domain.command import Ack
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import InvalidInput
from agent_server.protocol import messages as m
from agent_server.qa.tools.grid import ELECTION_NS, grid_start
from agent_server.recording import topics
from agent_server.recording.items import Entry, Tagged, read_entries, write_entry
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.reader import Recording, open_recording
from agent_server.recording.records import SensorChanged
from agent_server.recording.sink import AT_ONCE
from agent_server.recording.whole import whole_file
from agent_server.recording.writer import RecordingWriter


@dataclass(frozen=True, slots=True)
class CutReport:
    """What a cut kept.

    Attributes:
        records: How many records.
        start_s: Where it begins in the whole; a window begins 0.2 s later.
        duration_s: Length of the part.
        exact: Whether it begins where the recording does, so that its log of the core is kept
            and its replay comes to the same decisions, bit by bit.
        labels: Labels kept.
        split_labels: Labels left out, because the cut goes through their gesture.
    """

    records: int
    start_s: float
    duration_s: float
    exact: bool
    labels: int
    split_labels: int


def cut(source: Path, output: Path, start_ns: int, end_ns: int) -> CutReport:
    """Keep what was captured from one time to another; the new recording begins at 0.

    A part that begins with the recording keeps everything. Any other begins a little earlier,
    at the start of a window, and keeps what clients sent but for acks, labels and images: what
    the core was told counts windows from the start. The room begins as it stood, as far as the
    recording tells.

    Args:
        source: A recording.
        output: File to create; it must not exist.
        start_ns: Where the part begins.
        end_ns: Where it ends.

    Raises:
        InvalidInput: If the part is empty.
        RecordingError: If a file cannot be read or written.
    """
    recording = open_recording(source)
    last_ns = recording.summary.end_ns
    if not 0 <= start_ns < end_ns or start_ns > last_ns:
        raise InvalidInput(
            f"{source} lasts from 0 to {last_ns / NS_PER_S:.3f} s, and the part from "
            f"{start_ns / NS_PER_S:.3f} to {end_ns / NS_PER_S:.3f} s is empty: name one within it",
            field="start_ns",
        )
    if start_ns <= recording.summary.start_ns:
        return _cut_end(recording, output, end_ns)
    return _cut_both(recording, output, start_ns, end_ns)


def _cut_end(recording: Recording, output: Path, end_ns: int) -> CutReport:
    entries, split = _part(recording, 0, end_ns)
    _write(output, recording.metadata, entries)
    return _report(entries, split, 0, min(end_ns, recording.summary.end_ns), exact=True)


def _cut_both(recording: Recording, output: Path, start_ns: int, end_ns: int) -> CutReport:
    frames = (event for event in recording.events() if isinstance(event, SkeletonFrame))
    grid = grid_start(frames, start_ns, Settings())
    zero_ns, made_up = start_ns, []
    if grid is not None:
        zero_ns = grid.stamp_ns - ELECTION_NS
        made_up = [Entry(frame.originating_ns, frame) for frame in grid.frames]
    entries, split = _part(recording, zero_ns, end_ns)
    kept = [entry for entry in entries if not entry.is_derived and not isinstance(entry.item, Ack)]
    if grid is not None:
        kept = [entry for entry in kept if not _is_before(entry, grid.stamp_ns)]
    # The frames that are made up come before all others; nothing else is sorted.
    shifted = [entry.moved(-zero_ns) for entry in (*made_up, *kept)]
    metadata = replace(recording.metadata, face=_face_at(recording, zero_ns), part=1)
    written = [*_room_at(recording, zero_ns), *shifted]
    _write(output, metadata, written)
    end_ns = min(end_ns, recording.summary.end_ns)
    return _report(written, split, zero_ns, end_ns, exact=False)


def _is_before(entry: Entry, grid_ns: int) -> bool:
    """Whether it is a skeleton that a made-up one takes the place of."""
    return isinstance(entry.item, SkeletonFrame) and entry.stamp_ns <= grid_ns


def _part(recording: Recording, start_ns: int, end_ns: int) -> tuple[list[Entry], int]:
    """The records of a stretch, labels first, and how many labels were cut in two."""
    entries = [entry for entry in read_entries(recording) if _lies_in(entry, start_ns, end_ns)]
    labels = [entry.item for entry in entries if isinstance(entry.item, Tagged)]
    clipped = [_clipped(tagged, start_ns, end_ns) for tagged in labels]
    kept = [Entry(t.label.onset_ns, t) for t in clipped if t is not None]
    rest = [entry for entry in entries if not isinstance(entry.item, Tagged)]
    return [*kept, *rest], len(labels) - len(kept)


def _write(output: Path, metadata: RecordingMetadata, entries: list[Entry]) -> None:
    with whole_file(output) as path, RecordingWriter(path, metadata, AT_ONCE) as writer:
        for entry in entries:
            write_entry(writer, entry)


def _report(
    entries: list[Entry], split: int, start_ns: int, end_ns: int, *, exact: bool
) -> CutReport:
    labels = sum(isinstance(entry.item, Tagged) for entry in entries)
    length_s = (end_ns - start_ns) / NS_PER_S
    return CutReport(len(entries), start_ns / NS_PER_S, length_s, exact, labels, split)


def decision_time(source: Path, decision: str) -> int:
    """When the window of a recorded decision ended.

    Args:
        source: A recording.
        decision: Its id, or its index.

    Raises:
        InvalidInput: If the recording does not hold it.
    """
    recording = open_recording(source)
    count = 0
    for record in recording.records((topics.DECISION.name,)):
        if isinstance(record.message, m.DecisionMessage):
            body = record.message.decision
            if decision in (body.id, str(body.index)):
                return body.end_ns
            count += 1
    raise InvalidInput(
        f"{source} holds {count} decisions, and none is {decision!r}: name one by its id or index, "
        "or cut by time (agent-server replay shows when each decision came)",
        field="decision",
    )


def _lies_in(entry: Entry, start_ns: int, end_ns: int) -> bool:
    if isinstance(entry.item, Tagged):
        label = entry.item.label
        return label.onset_ns < end_ns and label.offset_ns > start_ns
    return start_ns <= entry.stamp_ns <= end_ns


def _clipped(tagged: Tagged, start_ns: int, end_ns: int) -> Tagged | None:
    """A label within the part; a gesture that is cut in two is none any more."""
    label = tagged.label
    if start_ns <= label.onset_ns and label.offset_ns <= end_ns:
        return tagged
    if not label.quiet:
        return None
    inner = replace(
        label, onset_ns=max(label.onset_ns, start_ns), offset_ns=min(label.offset_ns, end_ns)
    )
    return replace(tagged, label=inner)


def _face_at(recording: Recording, stamp_ns: int) -> str | None:
    """What the sensors had said of the face by then."""
    face = recording.metadata.face
    for record in recording.records((topics.CORE.name,)):
        if isinstance(record.message, SensorChanged) and record.message.open:
            if face is not None and record.stamp_ns > stamp_ns:
                break
            face = record.message.face
    return face


def _room_at(recording: Recording, stamp_ns: int) -> Iterator[Entry]:
    """The objects' states at that time as changes at the start of the part."""
    objects: dict[str, str] = {}
    for record in recording.records((topics.SCENE.name,)):
        if record.stamp_ns > stamp_ns:
            break
        if isinstance(record.message, m.SceneState):
            objects = record.message.objects
    for name, state in objects.items():
        yield Entry(0, ObjectChanged(0, name, state))
