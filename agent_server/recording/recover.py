"""Saving what is whole of a recording whose writer was interrupted, or that was damaged."""

from collections import Counter
from collections.abc import Mapping
from contextlib import closing, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from mcap.opcode import Opcode
from mcap.records import Channel, Metadata, Schema
from mcap.stream_reader import MAGIC_SIZE

from agent_server.errors import RecordingError
from agent_server.recording.metadata import FORMAT_VERSION, METADATA_NAME, RecordingMetadata
from agent_server.recording.reader import open_recording
from agent_server.recording.scan import (
    DamagedError,
    RawRecord,
    Stored,
    open_file,
    read_records,
    read_summary,
)
from agent_server.recording.sink import McapSink
from agent_server.recording.topics import TOPICS
from agent_server.recording.whole import whole_file


@dataclass(frozen=True, slots=True)
class RecoveryReport:
    """What was saved and what was not.

    Attributes:
        records: Number of records saved.
        topics: Topic -> number of its records saved.
        end_ns: Latest stamp saved; 0 without records.
        chunks: Number of chunks read.
        damaged_records: Number of chunks and metadata records that could not be read.
        missing_records: Records known to be lost from the gaps in the sequence; those after
            the last one saved are not known.
        finished: Whether the writer had come to the end of the records.
        lost_bytes: Bytes at the end of the file that make no whole record.
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

    Records keep their bytes, stamps, sequence numbers and order.

    Args:
        damaged: A recording that is truncated or corrupt; it stays as it is.
        output: File to create; it must not exist.

    Raises:
        RecordingError: If nothing can be saved, or a file cannot be read or written.
    """
    with whole_file(output) as part:
        finished, lost_bytes = False, 0
        with open_file(damaged) as file, closing(_Copy(part)) as copy:
            size = file.seek(0, 2)
            copy.take_names(file, damaged, size)
            try:
                for raw in read_records(file, damaged, MAGIC_SIZE, size):
                    if raw.opcode == Opcode.DATA_END:
                        finished = True
                        break
                    copy.take(raw)
            except DamagedError as error:
                lost_bytes = size - error.offset
            copy.complete_metadata(damaged)
        copy.check(part)
    return copy.report(finished, lost_bytes)


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
        self._has_metadata = False

    def take_names(self, file: BinaryIO, path: Path, size: int) -> None:
        """Take the channels from the summary, if there is one.

        They stand in the chunks that first use them too, but such a chunk may be damaged.
        """
        with suppress(RecordingError):
            for raw in read_summary(file, path, size):
                if raw.opcode == Opcode.SCHEMA:
                    self._item(raw.parse(Schema.read))
                elif raw.opcode == Opcode.CHANNEL:
                    self._item(raw.parse(Channel.read))

    def take(self, raw: RawRecord) -> None:
        """Copy one record of the old file, if it holds something and can be read."""
        try:
            if raw.opcode == Opcode.METADATA:
                self._metadata(raw)
            elif raw.opcode == Opcode.CHUNK:
                for item in raw.chunk():
                    self._item(item)
                self._chunks += 1
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
                RecordingMetadata.from_strings(record.metadata, raw.path)
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
            self._counts[source.topic] += 1
            self._end_ns = max(self._end_ns, item.log_time)
            self._next_sequence = max(self._next_sequence, item.sequence + 1)

    def _channel(self, source: Channel) -> int:
        if source.id not in self._channels:
            schema = self._schemas[source.schema_id]
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
        read = Counter(record.topic for record in open_recording(path))
        lost = {name: n for name, n in self._counts.items() if name in TOPICS and n != read[name]}
        if lost:
            raise RecordingError(f"{path} was written, but does not read back: {lost}")

    def report(self, finished: bool, lost_bytes: int) -> RecoveryReport:
        """What came of it."""
        records = self._counts.total()
        return RecoveryReport(
            records=records,
            topics=dict(sorted(self._counts.items())),
            end_ns=self._end_ns,
            chunks=self._chunks,
            damaged_records=self._damaged,
            missing_records=self._next_sequence - records,
            finished=finished,
            lost_bytes=lost_bytes,
        )
