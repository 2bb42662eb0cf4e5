"""Recordings one after the other as one."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from agent_server.domain.command import Ack
from agent_server.domain.stamp import MAX_STAMP_NS, NS_PER_S
from agent_server.errors import InvalidInput
from agent_server.recording.items import Entry, read_entries, write_entry
from agent_server.recording.reader import Recording, open_recording
from agent_server.recording.sink import AT_ONCE
from agent_server.recording.whole import whole_file
from agent_server.recording.writer import RecordingWriter


@dataclass(frozen=True, slots=True)
class MergeReport:
    """What was joined.

    Attributes:
        recordings: How many.
        records: Records written.
        duration_s: Length of the whole.
        starts_s: Where each begins in it.
    """

    recordings: int
    records: int
    duration_s: float
    starts_s: tuple[float, ...]


def merge(sources: Sequence[Path], output: Path, gap_ns: int) -> MergeReport:
    """Join what clients sent in several recordings, with their labels and images.

    The room remembers over the joins, as in one session: a window that was closed in the first
    recording is closed in the second.

    Args:
        sources: Recordings in their order.
        output: File to create; it must not exist.
        gap_ns: Pause between two; after 2 s the first one's body counts as gone.

    Raises:
        InvalidInput: If the recordings do not go together.
        RecordingError: If a file cannot be read or written.
    """
    recordings = [open_recording(path) for path in sources]
    first = recordings[0]
    for other in recordings[1:]:
        if other.metadata.face != first.metadata.face:
            raise InvalidInput(
                f"the sensor of {first.path} says of the face {first.metadata.face!r}, that of "
                f"{other.path} {other.metadata.face!r}: join recordings of one kind of sensor",
                field="face",
            )
    starts = [0]
    for recording in recordings:
        starts.append(starts[-1] + recording.summary.end_ns + gap_ns)
    if starts[-1] > MAX_STAMP_NS:
        raise InvalidInput(
            f"together they last {starts[-1] / NS_PER_S:.0f} s, longer than stamps count: join "
            "fewer",
            field="sources",
        )
    names = ", ".join(path.name for path in sources)
    metadata = replace(first.metadata, description=f"Joined from {names}.", created=None, part=1)
    count = 0
    with whole_file(output) as path, RecordingWriter(path, metadata, AT_ONCE) as writer:
        for recording, start_ns in zip(recordings, starts, strict=False):
            for entry in _inputs(recording):
                write_entry(writer, entry.moved(start_ns))
                count += 1
    return MergeReport(
        len(recordings),
        count,
        (starts[-1] - gap_ns) / NS_PER_S,
        tuple(start / NS_PER_S for start in starts[:-1]),
    )


def _inputs(recording: Recording) -> Iterator[Entry]:
    """What can stand at another time: all but what the core made of it, and words on that."""
    for entry in read_entries(recording):
        if not entry.is_derived and not isinstance(entry.item, Ack):
            yield entry
