"""What is remembered of a session, so that it goes on after a restart.

It is written before a command is sent, so that no command can be out that a restarted server does
not know of. A write reaches the system's cache, not the platter: what a process that is killed has
written is there, and after a power failure no command would be worth starting any more.
"""

import logging
from io import FileIO
from pathlib import Path
from typing import Protocol

import msgspec

from agent_server.domain.scene import RoomState
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import ConfigError

log = logging.getLogger(__name__)

FORMAT = 1
SUFFIX = ".session.jsonl"
LARGEST_BYTES = 256 * 1024
"""A file that has grown beyond this is begun anew with its last state."""
KEPT_NS = 24 * 3600 * NS_PER_S
"""Who does not come back within a day begins anew."""


class Saved(msgspec.Struct, frozen=True):
    """One session as it was last written down.

    Attributes:
        session: Its id.
        ledger: Its ledger of commands.
        wall_ns: Wall-clock time of writing, since 1970.
        room: The room.
        format: Counts the layouts.
    """

    session: str
    ledger: str
    wall_ns: int
    room: RoomState
    format: int = FORMAT


class SessionStore(Protocol):
    """Where sessions are remembered."""

    def load(self, session: str) -> Saved | None:
        """What was saved of a session, or None."""
        ...

    def save(self, saved: Saved) -> None:
        """Write a session down. A store that fails says so, and the session goes on."""
        ...

    def release(self, session: str) -> None:
        """The session is closed; it may be opened again."""
        ...

    def forget(self, session: str) -> None:
        """The session has ended for good."""
        ...


class MemoryStore:
    """Remembers sessions as long as the process lives."""

    def __init__(self) -> None:
        self._saved: dict[str, Saved] = {}

    def load(self, session: str) -> Saved | None:
        """What was saved of a session, or None."""
        return self._saved.get(session)

    def save(self, saved: Saved) -> None:
        """Write a session down."""
        self._saved[saved.session] = saved

    def release(self, session: str) -> None:
        """Hold nothing open; there is nothing."""

    def forget(self, session: str) -> None:
        """The session has ended for good."""
        self._saved.pop(session, None)


class FolderStore:
    """Remembers each session in a file, a line a state; the last whole line holds.

    Args:
        folder: Where; it is made if need be.
        now_ns: Wall-clock time since 1970: files that are older than a day are removed.

    Raises:
        ConfigError: If the folder cannot be written.
    """

    def __init__(self, folder: Path, now_ns: int) -> None:
        self._folder = folder
        self._encoder = msgspec.json.Encoder()
        self._decoder = msgspec.json.Decoder(Saved)
        self._open: dict[str, FileIO] = {}
        try:
            folder.mkdir(parents=True, exist_ok=True)
            for path in folder.glob(f"*{SUFFIX}"):
                if now_ns - path.stat().st_mtime_ns > KEPT_NS:
                    path.unlink()
            probe = folder / ".writable"
            probe.touch()
            probe.unlink()
        except OSError as error:
            raise ConfigError(
                f"cannot keep sessions in {folder}: {error.strerror}; name a folder that can be "
                "written with --state, or with state in [server]"
            ) from error

    def load(self, session: str) -> Saved | None:
        """What was saved of a session, or None; a damaged file is as good as none, and said."""
        path = self._path(session)
        try:
            lines = path.read_bytes().splitlines()
        except FileNotFoundError:
            return None
        except OSError as error:
            log.error("session %s begins anew: %s: %s", session, path, error.strerror)
            return None
        for line in reversed(lines):
            try:
                saved = self._decoder.decode(line)
            except msgspec.MsgspecError:
                continue  # the server was killed, or the disk was full, in the middle of it
            # On some disks `Lab` and `lab` are one file.
            if saved.session == session and saved.format == FORMAT:
                return saved
        log.error("session %s begins anew: %s holds no state that can be read", session, path)
        return None

    def save(self, saved: Saved) -> None:
        """Write a session down."""
        line = self._encoder.encode(saved) + b"\n"
        try:
            file = self._open.get(saved.session)
            if file is None or file.tell() > LARGEST_BYTES:
                file = self._begin(saved.session)
            file.write(line)
        except OSError as error:
            log.error(
                "session %s is not remembered over a restart: %s: %s",
                saved.session,
                self._path(saved.session),
                error.strerror,
            )

    def forget(self, session: str) -> None:
        """The session has ended for good."""
        self.release(session)
        try:
            self._path(session).unlink(missing_ok=True)
        except OSError as error:
            log.error("session %s: its state was not removed: %s", session, error.strerror)

    def release(self, session: str) -> None:
        """Close the session's file, and remember the session."""
        file = self._open.pop(session, None)
        if file is not None:
            file.close()

    def _begin(self, session: str) -> FileIO:
        """The file for the states to come, reduced to its last one where it has grown large."""
        self.release(session)
        path = self._path(session)
        if path.exists() and path.stat().st_size > LARGEST_BYTES:
            last = self.load(session)
            fresh = path.with_name(f"{path.name}.new")
            fresh.write_bytes(b"" if last is None else self._encoder.encode(last) + b"\n")
            fresh.replace(path)
        file = FileIO(path, "a")
        if file.tell():
            file.write(b"\n")  # after a state that was cut off
        self._open[session] = file
        return file

    def _path(self, session: str) -> Path:
        return self._folder / f"{session}{SUFFIX}"
