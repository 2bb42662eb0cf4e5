"""Recording live sessions: one file a session, and a disk that fails never stops a session."""

import logging
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

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


class Recorder:
    """A journal on disk. When the disk fails it says so once and takes no more.

    Args:
        path: File to create.
        metadata: What the recording says about itself.
    """

    def __init__(self, path: Path, metadata: RecordingMetadata) -> None:
        self._writer: RecordingWriter | None = None
        try:
            self._writer = RecordingWriter(path, metadata)
        except RecordingError as error:
            log.error("nothing is recorded, the session goes on: %s", error)

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

    def flush(self) -> None:
        """Hand what was written to the operating system."""
        self._do(RecordingWriter.flush)

    def close(self) -> None:
        """Finish the file."""
        self._do(RecordingWriter.close)
        self._writer = None

    def _do(self, write: Callable[[RecordingWriter], None]) -> None:
        if self._writer is None:
            return
        try:
            write(self._writer)
        except RecordingError as error:
            log.error("recording stopped, the session goes on: %s", error)
            with suppress(RecordingError):
                self._writer.close()
            self._writer = None


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
