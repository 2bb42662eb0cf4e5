"""The records of an MCAP file one by one, with the place of each for the errors.

The library's own readers follow lengths that they find in the file wherever these lead, and
raise what the parser happens to raise. Here every length is checked against the file, and
whatever is wrong becomes one error that says where.
"""

import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import BinaryIO, NamedTuple, TypeVar

import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Footer, McapRecord, Schema
from mcap.stream_reader import MAGIC_SIZE
from mcap.writer import MCAP0_MAGIC

from agent_server.errors import RecordingError

MAGIC = MCAP0_MAGIC
RECOVER_HINT = "`agent-server recover IN OUT` saves what is whole of it"

MAX_CHUNK_BYTES = 64 * 1024 * 1024
"""A chunk that says it is larger is held to be damaged, so that no byte asks for all memory."""

_PREFIX = struct.Struct("<BQ")  # opcode, length of what follows
_CHUNK = struct.Struct("<QQQII")  # first and last time, size, CRC, length of the compression's name
_MESSAGE = struct.Struct("<HIQQ")  # channel, sequence, two times
_LENGTH = struct.Struct("<Q")
_FOOTER_SIZE = _PREFIX.size + 20
_LENGTH_OF_NAME = 4
_ZSTD = b"\x04\x00\x00\x00zstd"
_SEARCH_BYTES = 1024 * 1024

_PARSE_ERRORS = (
    McapError,
    zstandard.ZstdError,
    struct.error,
    ValueError,
    OverflowError,
    MemoryError,
)
"""All that the library raises over bytes that make no sense; its CRC error is a ValueError."""

R = TypeVar("R", bound=McapRecord)


class DamagedError(RecordingError):
    """A recording is truncated or corrupt.

    Args:
        path: The recording.
        offset: Byte at which the damaged record begins.
        why: What is wrong with it.
    """

    def __init__(self, path: Path, offset: int, why: str) -> None:
        super().__init__(f"{path} is damaged at byte {offset}: {why}; {RECOVER_HINT}")
        self.offset = offset
        self.why = why


class Stored(NamedTuple):
    """A message as a chunk holds it: its channel, number, time and text."""

    channel_id: int
    sequence: int
    log_time: int
    data: bytes


@dataclass(frozen=True, slots=True)
class RawRecord:
    """One record as it stands in the file.

    Attributes:
        path: The file.
        offset: Byte at which it begins.
        opcode: Its kind.
        data: What follows its length.
    """

    path: Path
    offset: int
    opcode: int
    data: bytes

    @property
    def end(self) -> int:
        """Byte after it."""
        return self.offset + _PREFIX.size + len(self.data)

    def parse(self, read: Callable[[ReadDataStream], R]) -> R:
        """The record as a library type.

        Raises:
            DamagedError: If it cannot be one.
        """
        try:
            return read(ReadDataStream(BytesIO(self.data)))
        except _PARSE_ERRORS as error:
            raise DamagedError(self.path, self.offset, f"{error!r}") from error

    def chunk(self) -> Iterator[Schema | Channel | Stored]:
        """What a chunk holds, in order, once all of it is checked against its CRC.

        Raises:
            DamagedError: If it cannot be read.
        """
        if self.opcode != Opcode.CHUNK:
            raise DamagedError(self.path, self.offset, "this is no chunk")
        try:
            content = _content(self.data)
        except _PARSE_ERRORS as error:
            raise DamagedError(self.path, self.offset, f"its chunk is corrupt ({error})") from error
        return self._items(content)

    def _items(self, content: bytes) -> Iterator[Schema | Channel | Stored]:
        at, size, header = 0, len(content), _PREFIX.size + _MESSAGE.size
        while at < size:
            try:
                opcode, length = _PREFIX.unpack_from(content, at)
                end = at + _PREFIX.size + length
                if end > size:
                    raise ValueError("a record in it is too long")
                if opcode == Opcode.MESSAGE:
                    channel, sequence, stamp, _ = _MESSAGE.unpack_from(content, at + _PREFIX.size)
                    yield Stored(channel, sequence, stamp, content[at + header : end])
                elif opcode in _NAMES:
                    stream = ReadDataStream(BytesIO(content[at + _PREFIX.size : end]))
                    yield _NAMES[opcode].read(stream)
            except _PARSE_ERRORS as error:
                raise DamagedError(
                    self.path, self.offset, f"its chunk is corrupt ({error})"
                ) from error
            at = end


_NAMES: dict[int, type[Schema] | type[Channel]] = {
    Opcode.SCHEMA: Schema,
    Opcode.CHANNEL: Channel,
}


def _content(data: bytes) -> bytes:
    """The records of a chunk, unpacked."""
    _, _, size, crc, name_length = _CHUNK.unpack_from(data)
    at = _CHUNK.size + name_length
    compression = data[_CHUNK.size : at]
    (length,) = _LENGTH.unpack_from(data, at)
    packed = memoryview(data)[at + _LENGTH.size :]
    if length != len(packed):
        raise ValueError(f"it is {len(packed)} bytes long, not {length}")
    if size > MAX_CHUNK_BYTES:
        raise ValueError(f"it says that it unpacks to {size} bytes")
    if compression == b"zstd":
        # A size within the packed bytes would go before the limit.
        if zstandard.frame_content_size(packed) not in (-1, size):
            raise ValueError("it speaks of two sizes")
        content: bytes = zstandard.ZstdDecompressor().decompress(packed, max_output_size=size)
    elif compression == b"":
        content = bytes(packed)
    else:
        raise ValueError(f"it is compressed with {compression!r}, which is neither zstd nor none")
    if len(content) != size:
        raise ValueError(f"it unpacks to {len(content)} bytes, not {size}")
    if crc and zlib.crc32(content) != crc:
        raise ValueError("its CRC is wrong")
    return content


def open_file(path: Path) -> BinaryIO:
    """Open a recording that begins as one.

    Raises:
        RecordingError: If it cannot be opened or is no MCAP file.
    """
    try:
        file = path.open("rb")
        magic = file.read(MAGIC_SIZE)
    except OSError as error:
        raise RecordingError(f"{path} cannot be read: {error.strerror or error}") from error
    if magic != MAGIC:
        file.close()
        raise RecordingError(f"{path} is no MCAP file: at byte 0 it has {magic!r}")
    return file


def read_record(file: BinaryIO, path: Path, offset: int, end: int) -> RawRecord:
    """The record at ``offset`` of a part of the file that ends at ``end``.

    Raises:
        DamagedError: If it does not end within that part.
    """
    file.seek(offset)
    prefix = file.read(_PREFIX.size)
    if len(prefix) < _PREFIX.size or offset + _PREFIX.size > end:
        raise DamagedError(path, offset, "the file ends within a record")
    opcode, length = _PREFIX.unpack(prefix)
    if offset + _PREFIX.size + length > end:
        raise DamagedError(path, offset, "a record is longer than what is left of the file")
    return RawRecord(path, offset, opcode, file.read(length))


def next_chunk(file: BinaryIO, start: int) -> int | None:
    """Where the first compressed chunk from ``start`` on seems to begin; None if there is none.

    It is told by the name of its compression, which stands at a fixed place within it. What it
    holds is checked when it is read.
    """
    at, before = start, b""
    while block := _read_at(file, at, _SEARCH_BYTES):
        text = before + block
        found = text.find(_ZSTD)
        while found >= 0:
            begin = at - len(before) + found - _PREFIX.size - _CHUNK.size + _LENGTH_OF_NAME
            if begin >= start and _read_at(file, begin, 1) == bytes([Opcode.CHUNK]):
                return begin
            found = text.find(_ZSTD, found + 1)
        at += len(block)
        before = text[1 - len(_ZSTD) :]
    return None


def _read_at(file: BinaryIO, offset: int, count: int) -> bytes:
    file.seek(offset)
    return file.read(count)


def read_records(file: BinaryIO, path: Path, start: int, end: int) -> Iterator[RawRecord]:
    """All records from ``start`` to ``end``, in file order.

    Raises:
        DamagedError: At the first one that does not end within that part.
    """
    while start < end:
        record = read_record(file, path, start, end)
        yield record
        start = record.end


def read_summary(file: BinaryIO, path: Path, size: int) -> list[RawRecord]:
    """The records of the summary of a file of ``size`` bytes, checked against their CRC.

    Raises:
        RecordingError: If there is none because the writer was interrupted.
        DamagedError: If it is corrupt.
    """
    file.seek(max(size - MAGIC_SIZE, 0))
    if size < 2 * MAGIC_SIZE + _FOOTER_SIZE or file.read(MAGIC_SIZE) != MAGIC:
        raise RecordingError(
            f"{path} is truncated at byte {size}: it has no end, its writer was interrupted; "
            f"{RECOVER_HINT}"
        )
    footer_start = size - MAGIC_SIZE - _FOOTER_SIZE
    raw = read_record(file, path, footer_start, size - MAGIC_SIZE)
    if raw.opcode != Opcode.FOOTER:
        raise DamagedError(path, footer_start, "there is no footer")
    footer = raw.parse(Footer.read)
    if not 0 < footer.summary_start <= footer_start:
        raise DamagedError(path, footer_start, "there is no summary")
    file.seek(footer.summary_start)
    covered = file.read(footer_start + _FOOTER_SIZE - 4 - footer.summary_start)
    if footer.summary_crc and zlib.crc32(covered) != footer.summary_crc:
        raise DamagedError(path, footer.summary_start, "the summary's CRC is wrong")
    return list(read_records(file, path, footer.summary_start, footer_start))
