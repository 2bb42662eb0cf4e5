"""What is remembered of a session, so that it goes on after a restart.

It is written before a command is sent, so that no command can be out that a restarted server does
not know of. A write reaches the system's cache, not the platter: what a process that is killed has
written is there, and after a power failure no command would be worth starting any more.
"""

import logging
from pathlib import Path
from typing import Protocol

import msgspec

from agent_server.domain.scene import RoomState
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import ConfigError

log = logging.getLogger(__name__)

FORMAT = 1
SUFFIX = ".session.json"
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

    def forget(self, session: str) -> None:
        """The session has ended for good."""
        self._saved.pop(session, None)


class FolderStore:
    """Remembers each session in a file, which is replaced as a whole.

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
            saved = self._decoder.decode(path.read_bytes())
        except FileNotFoundError:
            return None
        except (OSError, msgspec.MsgspecError) as error:
            log.error("session %s begins anew: %s cannot be read: %s", session, path, error)
            return None
        # On some disks `Lab` and `lab` are one file.
        return saved if saved.session == session and saved.format == FORMAT else None

    def save(self, saved: Saved) -> None:
        """Write a session down."""
        path = self._path(saved.session)
        fresh = path.with_name(f"{path.name}.new")
        try:
            fresh.write_bytes(self._encoder.encode(saved))
            fresh.replace(path)
        except OSError as error:
            log.error(
                "session %s is not remembered over a restart: %s: %s",
                saved.session,
                path,
                error.strerror,
            )

    def forget(self, session: str) -> None:
        """The session has ended for good."""
        try:
            self._path(session).unlink(missing_ok=True)
        except OSError as error:
            log.error("session %s: its state was not removed: %s", session, error.strerror)

    def _path(self, session: str) -> Path:
        return self._folder / f"{session}{SUFFIX}"
