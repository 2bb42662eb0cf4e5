"""A recording in parts: one that has become too large or too old goes on in a new file."""

from dataclasses import dataclass, replace
from pathlib import Path
from types import TracebackType
from typing import Self

from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.writer import RecordingWriter


@dataclass(frozen=True, slots=True)
class PartLimits:
    """A part ends at whichever limit is reached first.

    Attributes:
        size: Bytes in its file.
        age_ns: Time since it was begun.
    """

    size: int
    age_ns: int


def part_path(first: Path, part: int) -> Path:
    """Where a part of a recording lies: ``NAME.mcap``, ``NAME.2.mcap``, ``NAME.3.mcap``, ..."""
    return first if part == 1 else first.with_suffix(f".{part}{first.suffix}")


def later_parts(first: Path) -> list[Path]:
    """The parts after the first, as far as none is missing."""
    found: list[Path] = []
    while (path := part_path(first, len(found) + 2)).exists():
        found.append(path)
    return found


class PartWriter:
    """Writes one recording into as many files as its limits ask for.

    Use it as a context manager. What is appended goes to ``current``, between calls of
    :meth:`turn_over`.

    Args:
        first: File of the first part; it must not exist.
        metadata: What the recording says about itself; each part says which one it is.
        limits: Of a part.
        now_ns: The time, on a monotonic clock.

    Attributes:
        current: The part that is being written.
        path: Its file.

    Raises:
        RecordingError: If a file cannot be created or written.
    """

    def __init__(
        self, first: Path, metadata: RecordingMetadata, limits: PartLimits, now_ns: int
    ) -> None:
        self._first = first
        self._metadata = metadata
        self._limits = limits
        self._part = 0
        self._begin(now_ns)

    def turn_over(self, now_ns: int, face: str | None) -> bool:
        """Begin the next part if this one is full; tells whether it did.

        Args:
            now_ns: The time.
            face: What the sensors say of the face by now, for the metadata of the next part.
        """
        is_full = self.current.size >= self._limits.size
        if not is_full and now_ns - self._begun_ns < self._limits.age_ns:
            return False
        self.current.close()
        self._metadata = replace(self._metadata, face=face or self._metadata.face)
        self._begin(now_ns)
        return True

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.current.close()

    def _begin(self, now_ns: int) -> None:
        self._part += 1
        self.path = part_path(self._first, self._part)
        self.current = RecordingWriter(self.path, replace(self._metadata, part=self._part))
        self._begun_ns = now_ns
