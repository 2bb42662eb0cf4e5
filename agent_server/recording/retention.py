"""How long recordings are kept: the oldest go first, and never one that is being written."""

import re
from dataclasses import dataclass
from pathlib import Path

from agent_server.recording.holding import is_held

_NAME = re.compile(r".+-\d{4}-\d\d-\d\dT\d{9}(\.\d+)?\.mcap")
"""As :func:`recording_name` and the parts of a recording are called; nothing else is touched."""


@dataclass(frozen=True, slots=True)
class Keep:
    """What is kept of a folder.

    Attributes:
        size: Bytes of all its recordings together; None keeps all.
        age_s: Seconds since a recording was last written; None keeps all.
    """

    size: int | None = None
    age_s: float | None = None


def recording_name(session: str, wall: str) -> str:
    """The file name of a session's recording that begins at a wall time in ISO 8601."""
    return f"{session}-{wall[:23].replace(':', '').replace('.', '')}.mcap"


def prune(folder: Path, keep: Keep, wall_s: float) -> list[Path]:
    """Delete what is too old, and the oldest of what is too much.

    Args:
        folder: Where recordings are. Files with other names than the recorder's are left alone.
        keep: What stays.
        wall_s: The time in seconds since 1970.

    Returns:
        What was deleted, the oldest first.

    Raises:
        OSError: If the folder cannot be read, or a file not be deleted.
    """
    files = sorted(
        (status.st_mtime, status.st_size, path)
        for path in folder.glob("*.mcap")
        if _NAME.fullmatch(path.name)
        for status in (path.stat(),)
    )
    total = sum(size for _, size, _ in files)
    deleted: list[Path] = []
    for written_s, size, path in files:
        is_old = keep.age_s is not None and wall_s - written_s > keep.age_s
        is_too_much = keep.size is not None and total > keep.size
        if not (is_old or is_too_much) or is_held(path):
            continue
        path.unlink()
        deleted.append(path)
        total -= size
    return deleted
