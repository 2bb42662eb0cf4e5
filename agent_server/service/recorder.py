"""Recording live sessions: one file a session, and a disk that fails never stops a session."""

import logging
from collections.abc import Callable
from pathlib import Path
from queue import Empty, Full, Queue
from threading import Thread

from agent_server import __version__
from agent_server.clock import Clock
from agent_server.domain.affect import AffectSample
from agent_server.domain.command import Ack
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import RecordingError
from agent_server.protocol.messages import CommandMessage, DecisionMessage, SceneState
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.records import CoreEntry
from agent_server.recording.writer import RecordingWriter
from agent_server.service.worker import Models

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
    """

    def __init__(self, path: Path, metadata: RecordingMetadata) -> None:
        self._waiting: Queue[_Write | None] = Queue(MAX_WAITING)
        self._has_failed = False
        self._thread = Thread(target=self._run, args=(path, metadata), name=path.name, daemon=True)
        self._thread.start()

    def append_skeleton(self, frame: SkeletonFrame) -> None:
        """Write a frame."""
        self._do(lambda writer: writer.append_skeleton(frame))

    def append_affect(self, sample: AffectSample) -> None:
        """Write a sample."""
        self._do(lambda writer: writer.append_affect(sample))

    def append_ack(self, ack: Ack) -> None:
        """Write a renderer's word."""
        self._do(lambda writer: writer.append_ack(ack))

    def append_scene_event(self, event: ObjectChanged) -> None:
        """Write a change by hand."""
        self._do(lambda writer: writer.append_scene_event(event))

    def append_core(self, entry: CoreEntry) -> None:
        """Write what else the core was told."""
        self._do(lambda writer: writer.append_core(entry))

    def append_decision(self, decision: DecisionMessage, stamp_ns: int) -> None:
        """Write a decision."""
        self._do(lambda writer: writer.append_decision(decision, stamp_ns))

    def append_command(self, command: CommandMessage) -> None:
        """Write a command."""
        self._do(lambda writer: writer.append_command(command))

    def append_scene(self, state: SceneState, stamp_ns: int) -> None:
        """Write the room after a change."""
        self._do(lambda writer: writer.append_scene(state, stamp_ns))

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


def recorder(folder: Path, session: str, models: Models, clock: Clock) -> Recorder:
    """A recorder into a new file of ``folder``, named after the session and the time."""
    wall = clock.wall()
    name = f"{session}-{wall[:23].replace(':', '').replace('.', '')}.mcap"
    metadata = RecordingMetadata(
        session=session,
        server_version=__version__,
        bundles={model.name: model.sha256 for model in (models.predictor, models.classifier)},
        created=wall,
    )
    return Recorder(folder / name, metadata)
