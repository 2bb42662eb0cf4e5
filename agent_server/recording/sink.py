"""An MCAP file that is being written: chunks, and what happens when the disk fails."""

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum, auto
from io import FileIO
from pathlib import Path

from agent_server.domain.stamp import MAX_STAMP_NS, NS_PER_MS
from agent_server.errors import RecordingError
from agent_server.recording.holding import hold
from agent_server.recording.mcap_file import McapFile

CHUNK_BYTES = 256 * 1024
CHUNK_NS = 500 * NS_PER_MS
LIBRARY = "agent-server"
LEVEL = 5
"""Of zstd: faces are a twentieth smaller than at the usual 3, for 3 ms more a chunk."""

_MESSAGE_OVERHEAD = 31  # opcode, length, channel, sequence and two times


@dataclass(frozen=True, slots=True)
class ChunkLimits:
    """A chunk is closed at whichever limit is reached first.

    Attributes:
        size: Bytes before compression.
        span_ns: Stamps from its first message to its last.
    """

    size: int
    span_ns: int


LIVE = ChunkLimits(CHUNK_BYTES, CHUNK_NS)
AT_ONCE = ChunkLimits(1024 * 1024, MAX_STAMP_NS)
"""For a file whose records are all there when it is written: large chunks compress better."""


class _State(Enum):
    OPEN = auto()
    FAILED = auto()
    CLOSED = auto()


class _WholeWrites:
    """A file without a buffer, so that no bytes are written late; writes all or fails."""

    def __init__(self, raw: FileIO) -> None:
        self._raw = raw
        hold(raw.fileno())

    def write(self, data: bytes) -> int:
        rest = memoryview(data)
        while rest:
            rest = rest[self._raw.write(rest) :]
        return len(data)

    def tell(self) -> int:
        return self._raw.tell()

    def close(self) -> None:
        self._raw.close()

    def abandon(self, size: int) -> None:
        """Cut the file to ``size`` bytes as far as the disk lets it, and close it."""
        with suppress(OSError):
            self._raw.truncate(size)
        with suppress(OSError):
            self._raw.close()


class McapSink:
    """Writes messages in zstd chunks with CRCs, then an index and a summary.

    A chunk goes to the file at its limits: by default when it holds 256 KiB, or when a message is
    500 ms or more away from the chunk's first one; :meth:`flush` closes it early. When writing
    fails, the file is cut back to its last whole chunk, from which it can be recovered.

    Args:
        path: File to create; it must not exist, so that no recording is lost to another.
        limits: Of a chunk.

    Raises:
        RecordingError: If it cannot be created.
    """

    def __init__(self, path: Path, limits: ChunkLimits = LIVE) -> None:
        self._path = path
        self._limits = limits
        try:
            self._file = _WholeWrites(FileIO(path, "x"))
        except FileExistsError:
            raise RecordingError(
                f"{path} exists already: record under another name, or move it away"
            ) from None
        except OSError as error:
            raise RecordingError(f"{path} cannot be created: {error.strerror or error}") from error
        self._state = _State.OPEN
        self._pending_bytes = 0
        self._chunk_start_ns = 0
        self._safe_size = 0
        self._do(self._begin)

    @property
    def is_open(self) -> bool:
        """Whether it takes messages: it was neither closed nor has it failed."""
        return self._state is _State.OPEN

    @property
    def size(self) -> int:
        """Bytes in the file so far: whole chunks, without an index."""
        return self._safe_size

    def metadata(self, name: str, strings: Mapping[str, str]) -> None:
        """Write a metadata record.

        Raises:
            RecordingError: If the file cannot be written.
        """
        self._do(lambda: self._mcap.metadata(name, dict(strings)))

    def channel(self, topic: str, encoding: str, schema: tuple[str, str, bytes]) -> int:
        """Register a topic; its record is written with the next message.

        Args:
            topic: Its name.
            encoding: How its messages are coded.
            schema: Name, encoding and text of its schema.

        Returns:
            Its id.
        """
        self._check_open()
        return self._mcap.channel(topic, encoding, self._mcap.schema(*schema))

    def message(self, channel: int, stamp_ns: int, sequence: int, data: bytes) -> None:
        """Add one message.

        Raises:
            RecordingError: If the file cannot be written or is closed, or the time is no time
                of a session.
        """
        self._check_open()
        if not 0 <= stamp_ns <= MAX_STAMP_NS:
            raise RecordingError(
                f"{self._path}: stamp_ns is {stamp_ns}, outside 0..{MAX_STAMP_NS}: stamps count "
                "nanoseconds from the start of the session"
            )
        if self._pending_bytes == 0:
            self._chunk_start_ns = stamp_ns
        self._mcap.message(channel, stamp_ns, sequence, data)
        self._pending_bytes += _MESSAGE_OVERHEAD + len(data)
        away_ns = abs(stamp_ns - self._chunk_start_ns)
        if self._pending_bytes >= self._limits.size or away_ns >= self._limits.span_ns:
            self.flush()

    def flush(self) -> None:
        """Close the chunk in progress and hand it to the operating system.

        Raises:
            RecordingError: If the file cannot be written or is closed.
        """
        self._do(self._mcap.flush)
        self._pending_bytes = 0

    def close(self) -> None:
        """Write index and summary, and close the file. Does nothing the second time.

        Raises:
            RecordingError: If the file cannot be written.
        """
        if self._state is not _State.OPEN:
            return
        self.flush()
        self._do(self._mcap.finish)
        self._state = _State.CLOSED
        self._file.close()

    def _begin(self) -> None:
        self._mcap = McapFile(self._file, LIBRARY, LEVEL)

    def _check_open(self) -> None:
        if self._state is not _State.OPEN:
            failed = self._state is _State.FAILED
            raise RecordingError(
                f"{self._path}: the recording {'has failed before' if failed else 'is closed'}"
            )

    def _do(self, write: Callable[[], None]) -> None:
        self._check_open()
        try:
            write()
        except OSError as error:
            self._state = _State.FAILED
            self._file.abandon(self._safe_size)
            raise RecordingError(
                f"{self._path} cannot be written: {error.strerror or error}. What was written "
                f"up to byte {self._safe_size} is kept: recover it"
            ) from error
        self._safe_size = self._file.tell()
