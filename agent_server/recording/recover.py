"""Saving what is whole of a recording whose writer was interrupted, or that was damaged."""

from collections import Counter
from collections.abc import Mapping
from contextlib import closing, suppress
from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path
from typing import BinaryIO

from mcap.opcode import Opcode
from mcap.records import Channel, Metadata, Schema, Statistics
from mcap.stream_reader import MAGIC_SIZE

from agent_server.errors import RecordingError
from agent_server.recording.metadata import FORMAT_VERSION, METADATA_NAME, RecordingMetadata
from agent_server.recording.reader import open_recording
from agent_server.recording.scan import (
    DamagedError,
    RawRecord,
    Stored,
    next_chunk,
    open_file,
    read_records,
    read_summary,
)
from agent_server.recording.sink import McapSink
from agent_server.recording.whole import whole_file


@dataclass(frozen=True, slots=True)
class RecoveryReport:
    """What was saved and what was not.

    Attributes:
        records: Number of records saved.
        topics: Topic -> number of its records saved.
        end_ns: Latest stamp saved; 0 without records.
        chunks: Number of chunks read.
        damaged_records: Number of places at which something could not be read.
        missing_records: Records known to be lost: exactly, where the file's summary is whole, else
            from the gaps in the sequence, and those after the last one saved are not known.
        finished: Whether the writer had come to the end of the records.
        lost_bytes: Bytes that make no whole record.
    """

    records: int
    topics: Mapping[str, int]
    end_ns: int
    chunks: int
    damaged_records: int
    missing_records: int
    finished: bool
    lost_bytes: int

    @property
    def complete(self) -> bool:
        """Whether nothing was lost."""
        return self.finished and not (self.damaged_records or self.missing_records)


def recover(damaged: Path, output: Path) -> RecoveryReport:
    """Copy all whole chunks of a recording to a new one, and check it by reading it.

    Where the file makes no sense, reading goes on with the next chunk that can be found. Records
    keep their bytes, stamps, sequence numbers and order.

    Args:
        damaged: A recording that is truncated or corrupt; it stays as it is.
        output: File to create; it must not exist.

    Raises:
        RecordingError: If nothing can be saved, or a file cannot be read or written.
    """
    with whole_file(output) as part:
        with open_file(damaged) as file, closing(_Copy(part)) as copy:
            size = file.seek(0, 2)
            copy.take_summary(file, damaged, size)
            finished, lost_bytes = _copy_all(file, damaged, size, copy)
            copy.complete_metadata(damaged)
        copy.check(part)
    return copy.report(finished, lost_bytes)


def _copy_all(file: BinaryIO, path: Path, size: int, copy: "_Copy") -> tuple[bool, int]:
    """Copy what is whole; tells whether the end of the records is there, and what makes none."""
    at = searched = MAGIC_SIZE
    lost_bytes = 0
    while True:
        try:
            for raw in read_records(file, path, at, size):
                at = raw.offset
                if raw.opcode == Opcode.CHUNK:
                    searched = at + 1
                    copy.take_chunk(raw)
                    searched = raw.end
                elif raw.opcode == Opcode.METADATA:
                    copy.take_metadata(raw)
                elif raw.opcode == Opcode.DATA_END and len(raw.data) == _DATA_END_SIZE:
                    return True, lost_bytes
                elif raw.opcode not in _PASSED_OVER:
                    raise DamagedError(path, at, f"there is no record of kind {raw.opcode}")
                at = raw.end
            return False, lost_bytes
        except DamagedError:
            # Any length on the way here may have been wrong: the search begins after what was
            # last known to be whole.
            begin = next_chunk(file, searched)
            if begin is None:
                return False, lost_bytes + size - at
            copy.skip()
            lost_bytes += max(0, begin - at)
            at, searched = begin, begin + 1


_DATA_END_SIZE = 4
_PASSED_OVER = frozenset(
    (
        Opcode.HEADER,
        Opcode.SCHEMA,
        Opcode.CHANNEL,
        Opcode.MESSAGE,
        Opcode.MESSAGE_INDEX,
        Opcode.ATTACHMENT,
    )
)
"""What else may stand before the end of the data."""


class _Copy:
    """The new recording, and the count of what came into it and what did not."""

    def __init__(self, path: Path) -> None:
        self._sink = McapSink(path)
        self._schemas: dict[int, Schema] = {}
        self._sources: dict[int, Channel] = {}
        self._channels: dict[int, int] = {}
        self._counts: Counter[str] = Counter()
        self._end_ns = 0
        self._next_sequence = 0
        self._chunks = 0
        self._damaged = 0
        self._digest = blake2b()
        self._has_metadata = False
        self._promised: Statistics | None = None

    def take_summary(self, file: BinaryIO, path: Path, size: int) -> None:
        """Take the channels and the count of records from the summary, if there is one.

        Channels stand in the chunks that first use them too, but such a chunk may be damaged.
        """
        with suppress(RecordingError):
            for raw in read_summary(file, path, size):
                if raw.opcode == Opcode.SCHEMA:
                    self._item(raw.parse(Schema.read))
                elif raw.opcode == Opcode.CHANNEL:
                    self._item(raw.parse(Channel.read))
                elif raw.opcode == Opcode.STATISTICS:
                    self._promised = raw.parse(Statistics.read)

    def skip(self) -> None:
        """Something could not be read."""
        self._damaged += 1

    def take_chunk(self, raw: RawRecord) -> None:
        """Copy what a chunk holds.

        Raises:
            DamagedError: If it cannot be read; nothing of it is copied then.
        """
        for item in raw.chunk():
            self._item(item)
        self._chunks += 1

    def take_metadata(self, raw: RawRecord) -> None:
        """Copy a metadata record, if it can be read."""
        try:
            self._metadata(raw)
        except DamagedError:
            self._damaged += 1

    def complete_metadata(self, damaged: Path) -> None:
        """Stand in for the metadata where these are lost.

        Raises:
            RecordingError: If the records are lost as well.
        """
        if self._has_metadata:
            return
        if not self._counts:
            raise RecordingError(f"{damaged}: nothing can be saved, no record of it is whole")
        metadata = RecordingMetadata(
            session=damaged.stem,
            server_version="unknown",
            description="Recovered; what it said of itself is lost.",
        )
        self._sink.metadata(METADATA_NAME, metadata.to_strings())

    def _metadata(self, raw: RawRecord) -> None:
        record = raw.parse(Metadata.read)
        if record.name == METADATA_NAME:
            version = record.metadata.get("format_version", "")
            try:
                RecordingMetadata.from_strings(record.metadata, raw.path, raw.offset)
            except RecordingError as error:
                if version.isdecimal() and int(version) > FORMAT_VERSION:
                    raise
                raise DamagedError(raw.path, raw.offset, "its metadata are garbled") from error
            self._has_metadata = True
        self._sink.metadata(record.name, record.metadata)

    def _item(self, item: Schema | Channel | Stored) -> None:
        if isinstance(item, Schema):
            self._schemas[item.id] = item
        elif isinstance(item, Channel):
            self._sources[item.id] = item
        elif item.channel_id in self._sources:  # or the chunk that named it is lost
            source = self._sources[item.channel_id]
            self._sink.message(self._channel(source), item.log_time, item.sequence, item.data)
            self._digest.update(_identity(source.topic, item))
            self._counts[source.topic] += 1
            self._end_ns = max(self._end_ns, item.log_time)
            self._next_sequence = max(self._next_sequence, item.sequence + 1)

    def _channel(self, source: Channel) -> int:
        if source.id not in self._channels:
            schema = self._schemas.get(source.schema_id, _NO_SCHEMA)
            self._channels[source.id] = self._sink.channel(
                source.topic, source.message_encoding, (schema.name, schema.encoding, schema.data)
            )
        return self._channels[source.id]

    def close(self) -> None:
        """Finish the new file."""
        self._sink.close()

    def check(self, path: Path) -> None:
        """Read the new file and compare.

        Raises:
            RecordingError: If it does not hold what was copied.
        """
        size = open_recording(path).summary.size_bytes
        topics: dict[int, str] = {}
        digest = blake2b()
        with open_file(path) as file:
            for raw in read_records(file, path, MAGIC_SIZE, size - MAGIC_SIZE):
                if raw.opcode != Opcode.CHUNK:
                    continue
                for item in raw.chunk():
                    if isinstance(item, Channel):
                        topics[item.id] = item.topic
                    elif isinstance(item, Stored):
                        digest.update(_identity(topics[item.channel_id], item))
        if digest.digest() != self._digest.digest():
            raise RecordingError(f"{path} was written, but does not read back: try another disk")

    def report(self, finished: bool, lost_bytes: int) -> RecoveryReport:
        """What came of it."""
        records = self._counts.total()
        promised = self._next_sequence if self._promised is None else self._promised.message_count
        return RecoveryReport(
            records=records,
            topics=dict(sorted(self._counts.items())),
            end_ns=self._end_ns,
            chunks=self._chunks,
            damaged_records=self._damaged,
            missing_records=max(0, promised - records),
            finished=finished,
            lost_bytes=lost_bytes,
        )


_NO_SCHEMA = Schema(id=0, data=b"", encoding="", name="")


def _identity(topic: str, item: Stored) -> bytes:
    """All that makes a record what it is."""
    head = f"{topic} {item.log_time} {item.sequence} {len(item.data)} "
    return head.encode() + item.data
