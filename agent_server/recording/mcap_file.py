"""The bytes of an MCAP file, in order: chunks, then an index and a summary.

The library's own writer compresses at a level that cannot be chosen, and there a face takes a
twentieth more. This one gives the same bytes at the same level; its records are the library's.
"""

import struct
import zlib
from collections import Counter
from collections.abc import Sequence
from typing import Protocol

import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Message,
    MessageIndex,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)
from mcap.writer import MCAP0_MAGIC

_FOOTER = struct.Struct("<BQQQ")  # opcode, length, start of the summary and of its offsets
_FOOTER_BYTES = 20


class Output(Protocol):
    """Where the bytes go."""

    def write(self, data: bytes) -> int:
        """Write all of them."""
        ...

    def tell(self) -> int:
        """How many were written."""
        ...


class McapFile:
    """One file that is written from its beginning to its end.

    Args:
        output: Where the bytes go; what it raises comes through.
        library: What the file says has written it.
        level: Of zstd.
    """

    def __init__(self, output: Output, library: str, level: int) -> None:
        self._output = output
        self._compressor = zstandard.ZstdCompressor(level=level)
        self._crc = 0
        self._schemas: list[Schema] = []
        self._channels: list[Channel] = []
        self._counts: Counter[int] = Counter()
        self._span_ns: tuple[int, int] | None = None
        self._chunks = _Group(Opcode.CHUNK_INDEX)
        self._metadata = _Group(Opcode.METADATA_INDEX)
        self._chunk = _OpenChunk()
        self._write(MCAP0_MAGIC)
        self._record(Header("", library))

    def metadata(self, name: str, strings: dict[str, str]) -> None:
        """Write a metadata record, ahead of the messages of the chunk in progress."""
        offset = self._output.tell()
        length = self._record(Metadata(name=name, metadata=strings))
        self._metadata.add(MetadataIndex(offset=offset, length=length, name=name))

    def schema(self, name: str, encoding: str, data: bytes) -> int:
        """Name a schema; gives its id."""
        schema = Schema(id=len(self._schemas) + 1, data=data, encoding=encoding, name=name)
        self._schemas.append(schema)
        schema.write(self._chunk.records)
        return schema.id

    def channel(self, topic: str, encoding: str, schema: int) -> int:
        """Name a topic; gives its id."""
        number = len(self._channels) + 1
        channel = Channel(number, topic, encoding, metadata={}, schema_id=schema)
        self._channels.append(channel)
        channel.write(self._chunk.records)
        return channel.id

    def message(self, channel: int, stamp_ns: int, sequence: int, data: bytes) -> None:
        """Add a message to the chunk in progress."""
        self._chunk.add(Message(channel, stamp_ns, data, stamp_ns, sequence))

    def flush(self) -> None:
        """Write the chunk in progress, if it has messages."""
        chunk = self._chunk
        if not chunk.indexes:
            return
        stamps = [stamp for index in chunk.indexes.values() for stamp, _ in index.records]
        first_ns, last_ns = min(stamps), max(stamps)
        content = _bytes(chunk.records)
        packed = self._compressor.compress(content)
        offset = self._output.tell()
        length = self._record(
            Chunk(
                compression="zstd",
                data=packed,
                message_end_time=last_ns,
                message_start_time=first_ns,
                uncompressed_crc=zlib.crc32(content),
                uncompressed_size=len(content),
            )
        )
        after = self._output.tell()
        builder, places = RecordBuilder(), {}
        for channel, index in chunk.indexes.items():
            places[channel] = after + builder.count
            index.write(builder)
        indexes = _bytes(builder)
        self._write(indexes)
        self._chunks.add(
            ChunkIndex(
                chunk_length=length,
                chunk_start_offset=offset,
                compression="zstd",
                compressed_size=len(packed),
                message_end_time=last_ns,
                message_index_length=len(indexes),
                message_index_offsets=places,
                message_start_time=first_ns,
                uncompressed_size=len(content),
            )
        )
        for channel, index in chunk.indexes.items():
            self._counts[channel] += len(index.records)
        known = self._span_ns or (first_ns, last_ns)
        self._span_ns = (min(known[0], first_ns), max(known[1], last_ns))
        self._chunk = _OpenChunk()

    def finish(self) -> None:
        """Write the chunk in progress, the index and the summary."""
        self.flush()
        self._record(DataEnd(self._crc))
        start = self._output.tell()
        groups = [_Group(Opcode.SCHEMA), _Group(Opcode.CHANNEL), _Group(Opcode.STATISTICS)]
        named: tuple[Sequence[McapRecord], ...] = (
            self._schemas,
            self._channels,
            (self._statistics(),),
        )
        for group, records in zip(groups, named, strict=True):
            for record in records:
                group.add(record)
        groups += [self._chunks, _Group(Opcode.ATTACHMENT_INDEX), self._metadata]
        summary, offsets = bytearray(), RecordBuilder()
        for group in groups:
            SummaryOffset(
                group_opcode=group.opcode,
                group_start=start + len(summary),
                group_length=len(group.data),
            ).write(offsets)
            summary += group.data
        offsets_start = start + len(summary)
        summary += _bytes(offsets)
        head = _FOOTER.pack(Opcode.FOOTER, _FOOTER_BYTES, start, offsets_start)
        crc = zlib.crc32(head, zlib.crc32(summary))
        self._write(bytes(summary))
        self._record(Footer(start, offsets_start, crc))
        self._write(MCAP0_MAGIC)

    def _statistics(self) -> Statistics:
        first_ns, last_ns = self._span_ns or (0, 0)
        return Statistics(
            attachment_count=0,
            channel_count=len(self._channels),
            channel_message_counts=self._counts,
            chunk_count=self._chunks.count,
            message_count=self._counts.total(),
            message_end_time=last_ns,
            message_start_time=first_ns,
            metadata_count=self._metadata.count,
            schema_count=len(self._schemas),
        )

    def _record(self, record: McapRecord) -> int:
        """Write one record; gives its length."""
        builder = RecordBuilder()
        record.write(builder)
        data = _bytes(builder)
        self._write(data)
        return len(data)

    def _write(self, data: bytes) -> None:
        self._output.write(data)
        self._crc = zlib.crc32(data, self._crc)


def _bytes(builder: RecordBuilder) -> bytes:
    """What was built; the builder is empty then."""
    data: bytes = builder.end()  # type: ignore[no-untyped-call]
    return data


class _OpenChunk:
    """A chunk that is not written yet."""

    def __init__(self) -> None:
        self.records = RecordBuilder()
        self.indexes: dict[int, MessageIndex] = {}

    def add(self, message: Message) -> None:
        index = self.indexes.setdefault(message.channel_id, MessageIndex(message.channel_id, []))
        index.records.append((message.log_time, self.records.count))
        message.write(self.records)


class _Group:
    """Records of one kind in the summary, as bytes."""

    def __init__(self, opcode: Opcode) -> None:
        self.opcode = opcode
        self.data = bytearray()
        self.count = 0

    def add(self, record: McapRecord) -> None:
        builder = RecordBuilder()
        record.write(builder)
        self.data += _bytes(builder)
        self.count += 1
