"""Reading a recording: its records in file order, as they entered the session."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import BinaryIO

import msgspec
from mcap.opcode import Opcode
from mcap.records import Channel, ChunkIndex, Metadata, MetadataIndex, Statistics

from agent_server.domain.inputs import RawInput
from agent_server.domain.label import Label
from agent_server.domain.stamp import MAX_STAMP_NS, NS_PER_S
from agent_server.errors import InvalidInput, RecordingError
from agent_server.protocol import messages as m
from agent_server.recording import topics
from agent_server.recording.inputs import from_record
from agent_server.recording.metadata import METADATA_NAME, RecordingMetadata
from agent_server.recording.records import (
    CompressedImage,
    CoreEntry,
    CoreRecord,
    InputTimes,
    LabelRecord,
)
from agent_server.recording.scan import (
    RECOVER_HINT,
    DamagedError,
    RawRecord,
    Stored,
    open_file,
    read_record,
    read_summary,
)


@dataclass(frozen=True, slots=True)
class Record:
    """One record of a recording.

    Attributes:
        topic: For example ``/skeleton``.
        stamp_ns: Its time on the session's time line: capture time of what a sensor sent.
        sequence: Counts the records of the file from 0.
        message: The record itself: a message of the protocol, a label, or a core entry.
    """

    topic: str
    stamp_ns: int
    sequence: int
    message: m.Message | CoreEntry | CompressedImage


@dataclass(frozen=True, slots=True)
class RecordingSummary:
    """What a recording holds, from its index.

    Attributes:
        records: Number of all records.
        topics: Topic -> number of its records, in alphabetical order.
        start_ns: Earliest stamp; 0 without records.
        end_ns: Latest stamp; 0 without records.
        chunks: Number of chunks.
        size_bytes: Size of the file.
    """

    records: int
    topics: Mapping[str, int]
    start_ns: int
    end_ns: int
    chunks: int
    size_bytes: int

    @property
    def duration_s(self) -> float:
        """Time between the first and the last stamp, in seconds."""
        return (self.end_ns - self.start_ns) / NS_PER_S


class Recording:
    """A whole recording on disk. Made by :func:`open_recording`; each iteration reads anew.

    Args:
        path: The file.
        metadata: What it says about itself.
        summary: What it holds.
        chunks: Where its chunks are, in file order.
        channels: Id of a channel -> its topic, of the known topics only.
    """

    def __init__(
        self,
        path: Path,
        metadata: RecordingMetadata,
        summary: RecordingSummary,
        chunks: tuple[ChunkIndex, ...],
        channels: Mapping[int, str],
    ) -> None:
        self.path = path
        self.metadata = metadata
        self.summary = summary
        self._chunks = chunks
        self._channels = channels

    def __iter__(self) -> Iterator[Record]:
        """All records of the known topics, in file order."""
        return self.records()

    def records(
        self,
        only: Collection[str] | None = None,
        start_ns: int = 0,
        end_ns: int = MAX_STAMP_NS,
    ) -> Iterator[Record]:
        """Records in file order. Chunks that hold nothing of what is asked for are skipped.

        Args:
            only: Names of the topics to read; None reads all.
            start_ns: Earliest stamp to read.
            end_ns: Latest stamp to read.

        Raises:
            DamagedError: At a chunk that cannot be read.
            RecordingError: At a record that is not what its topic holds.
        """
        wanted = {
            channel: _decoder(name)
            for channel, name in self._channels.items()
            if only is None or name in only
        }
        with open_file(self.path) as file:
            for index in self._chunks:
                holds = index.message_index_offsets
                if holds and holds.keys().isdisjoint(wanted):
                    continue
                if index.message_end_time < start_ns or index.message_start_time > end_ns:
                    continue
                raw = read_record(
                    file, self.path, index.chunk_start_offset, self.summary.size_bytes
                )
                for record in self._decoded(raw, wanted):
                    if start_ns <= record.stamp_ns <= end_ns:
                        yield record

    def events(self) -> Iterator[RawInput]:
        """What clients sent in, as domain values, in the order in which it entered the core.

        Raises:
            RecordingError: As :meth:`records` does.
        """
        for record in self.records(_RAW_INPUTS):
            yield self._raw_input(record)

    def entries(self) -> Iterator[RawInput | CoreEntry]:
        """All that entered the core, in its order: what clients sent, and the core's log.

        Raises:
            RecordingError: As :meth:`records` does.
        """
        for record in self.records((*_RAW_INPUTS, topics.CORE.name)):
            if isinstance(record.message, CoreRecord):
                yield record.message
            else:
                yield self._raw_input(record)

    def labels(self) -> tuple[Label, ...]:
        """Ground truth, sorted by onset; empty where nobody labelled the recording.

        Raises:
            RecordingError: As :meth:`records` does.
        """
        labels = [
            record.message.to_domain()
            for record in self.records((topics.LABEL.name,))
            if isinstance(record.message, LabelRecord)
        ]
        return tuple(sorted(labels, key=lambda label: (label.onset_ns, label.offset_ns)))

    def times(self) -> Iterator[tuple[int, int, int]]:
        """When inputs came: their sequence, and when each was received and had been dealt with.

        In nanoseconds since the recording began, on the clock of whoever recorded; nothing where
        nobody took the time, as in a generated or converted recording.

        Raises:
            RecordingError: As :meth:`records` does.
        """
        for record in self.records((topics.TIMES.name,)):
            if isinstance(record.message, InputTimes):
                rows = record.message
                yield from zip(rows.sequences, rows.received_ns, rows.taken_ns, strict=False)

    def _decoded(self, raw: RawRecord, wanted: "Mapping[int, Decoder]") -> Iterator[Record]:
        for item in raw.chunk():
            if not isinstance(item, Stored):
                continue
            decoder = wanted.get(item.channel_id)
            if decoder is None:
                continue
            topic = self._channels[item.channel_id]
            try:
                message = decoder.decode(item.data)
            except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
                raise RecordingError(
                    f"{self.path}, record {item.sequence} on {topic}, in the chunk at byte "
                    f"{raw.offset}: {error}"
                ) from error
            yield Record(topic, item.log_time, item.sequence, message)

    def _raw_input(self, record: Record) -> RawInput:
        try:
            return from_record(record.message, record.stamp_ns)
        except InvalidInput as error:
            raise RecordingError(
                f"{self.path}, record {record.sequence} on {record.topic}: {error}"
            ) from error


def open_recording(path: Path) -> Recording:
    """Open a recording that was finished or recovered.

    Raises:
        RecordingError: If it cannot be read, is no recording of this product, is of a newer
            format, or is truncated; the text then says how to recover it.
        DamagedError: If its index or metadata are corrupt.
    """
    with open_file(path) as file:
        size = file.seek(0, 2)
        statistics: Statistics | None = None
        channels: dict[int, str] = {}
        chunks: list[ChunkIndex] = []
        metadata: RecordingMetadata | None = None
        for raw in read_summary(file, path, size):
            match raw.opcode:
                case Opcode.STATISTICS:
                    statistics = raw.parse(Statistics.read)
                case Opcode.CHANNEL:
                    channel = raw.parse(Channel.read)
                    channels[channel.id] = channel.topic
                case Opcode.CHUNK_INDEX:
                    chunks.append(raw.parse(ChunkIndex.read))
                case Opcode.METADATA_INDEX:
                    index = raw.parse(MetadataIndex.read)
                    if index.name == METADATA_NAME:
                        metadata = _metadata(file, path, index.offset, size)
    if metadata is None:
        raise RecordingError(
            f"{path} is no recording of this server: it has no metadata {METADATA_NAME!r} in its "
            f"index, which ends at byte {size}"
        )
    if statistics is None or len(chunks) != statistics.chunk_count:
        raise RecordingError(
            f"{path} has no index of its chunks before its end at byte {size}; {RECOVER_HINT}"
        )
    chunks.sort(key=lambda chunk: chunk.chunk_start_offset)
    return Recording(
        path,
        metadata,
        _summary(statistics, channels, size),
        tuple(chunks),
        {channel: name for channel, name in channels.items() if name in topics.TOPICS},
    )


def _metadata(file: BinaryIO, path: Path, offset: int, size: int) -> RecordingMetadata:
    raw = read_record(file, path, offset, size)
    if raw.opcode != Opcode.METADATA:
        raise DamagedError(path, offset, "the index names this as metadata, which it is not")
    return RecordingMetadata.from_strings(raw.parse(Metadata.read).metadata, path, offset)


def _summary(statistics: Statistics, channels: Mapping[int, str], size: int) -> RecordingSummary:
    counts: dict[str, int] = {}
    for channel, count in statistics.channel_message_counts.items():
        name = channels.get(channel, "")
        counts[name] = counts.get(name, 0) + count
    return RecordingSummary(
        records=statistics.message_count,
        topics=dict(sorted(counts.items())),
        start_ns=statistics.message_start_time,
        end_ns=statistics.message_end_time,
        chunks=statistics.chunk_count,
        size_bytes=size,
    )


@cache
def _decoder(topic: str) -> "Decoder":
    return msgspec.json.Decoder(topics.TOPICS[topic].record)


Decoder = msgspec.json.Decoder[m.Message | CoreEntry | CompressedImage]
_RAW_INPUTS = tuple(topic.name for topic in topics.RAW_INPUTS)
