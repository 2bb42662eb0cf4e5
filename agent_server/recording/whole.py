"""Files that appear under their name only when they are whole."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from agent_server.errors import RecordingError


@contextmanager
def whole_file(path: Path, *, replaces: bool = False) -> Iterator[Path]:
    """A path to write to, which becomes ``path`` when the block ends without an error.

    Args:
        path: The file.
        replaces: Whether it may take the place of another one.

    Raises:
        RecordingError: If ``path`` exists and is not to be replaced, or its folder cannot be
            written to.
    """
    if path.exists() and not replaces:
        raise RecordingError(f"{path} exists already: choose another name, or move it away")
    part = path.with_name(path.name + ".part")
    try:
        part.unlink(missing_ok=True)
        yield part
        part.replace(path)
    except OSError as error:
        raise RecordingError(f"{path} cannot be written: {error.strerror or error}") from error
    finally:
        part.unlink(missing_ok=True)
