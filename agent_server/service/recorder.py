"""Recording live sessions: one file a session, and a disk that fails never stops a session."""

import logging
from collections.abc import Callable
from pathlib import Path
from queue import Empty, Full, Queue
from threading import Thread

from agent_server import __version__
from agent_server.clock import Clock
from agent_server.domain.inputs import RawInput
from agent_server.errors import RecordingError
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.records import CoreEntry
from agent_server.recording.writer import Output, RecordingWriter
from agent_server.service.models import Models

log = logging.getLogger(__name__)

MAX_WAITING = 20_000
"""Records that may wait for the disk: some minutes of a session."""
FLUSH_S = 0.5
CLOSE_S = 5.0


class Recorder:
    """A journal on disk, written by a thread of its own, so that a slow disk stalls nobody.

    When the disk fails, or is so slow that too much waits, it says so once and takes no more.

    Args:
        path: File to create.
        metadata: What the recording says about itself.
        with_images: Whether images of the face are written too.
    """

    def __init__(
        self, path: Path, metadata: RecordingMetadata, *, with_images: bool = False
    ) -> None:
        self._with_images = with_images
        self._waiting: Queue[_Write | None] = Queue(MAX_WAITING)
        self._has_failed = False
        self._thread = Thread(target=self._run, args=(path, metadata), name=path.name, daemon=True)
        self._thread.start()

    def append_input(self, value: RawInput) -> None:
        """Write what a client sent."""
        self._do(lambda writer: writer.append_input(value))

    def append_image(self, jpeg: bytes, stamp_ns: int) -> None:
        """Write an image, if images are to be recorded."""
        if self._with_images:
            self._do(lambda writer: writer.append_image(jpeg, stamp_ns))

    def append_core(self, entry: CoreEntry) -> None:
        """Write what else the core was told."""
        self._do(lambda writer: writer.append_core(entry))

    def append_output(self, message: Output, stamp_ns: int) -> None:
        """Write what came of it."""
        self._do(lambda writer: writer.append_output(message, stamp_ns))

    def close(self) -> None:
        """Finish the file; a disk that hangs is not waited for long."""
        self._do(None)
        self._thread.join(CLOSE_S)

    def _do(self, write: "_Write | None") -> None:
        if self._has_failed:
            return
        try:
            self._waiting.put_nowait(write)
        except Full:
            self._has_failed = True
            log.error("recording stopped, the session goes on: the disk is too slow")

    def _run(self, path: Path, metadata: RecordingMetadata) -> None:
        try:
            with RecordingWriter(path, metadata) as writer:
                self._write_all(writer)
        except RecordingError as error:
            self._has_failed = True
            log.error("recording stopped, the session goes on: %s", error)

    def _write_all(self, writer: RecordingWriter) -> None:
        """Write what comes until there is no more, and flush when nothing comes for a while."""
        while not (self._has_failed and self._waiting.empty()):
            try:
                write = self._waiting.get(timeout=FLUSH_S)
            except Empty:
                writer.flush()
                continue
            if write is None:
                return
            write(writer)


_Write = Callable[[RecordingWriter], None]


def recorder(
    folder: Path, session: str, models: Models, clock: Clock, *, with_images: bool = False
) -> Recorder:
    """A recorder into a new file of ``folder``, named after the session and the time."""
    wall = clock.wall()
    name = f"{session}-{wall[:23].replace(':', '').replace('.', '')}.mcap"
    metadata = RecordingMetadata(
        session=session,
        server_version=__version__,
        bundles={model.name: model.sha256 for _, model in models.by_task},
        created=wall,
    )
    return Recorder(folder / name, metadata, with_images=with_images)
