"""A session in which a person is led through the repetitions of a gesture, written to a file."""

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from agent_server import __version__
from agent_server.clock import Clock
from agent_server.domain.inputs import RawInput
from agent_server.domain.label import Label
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import RecordingError
from agent_server.recording.director import TakeDirector
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.records import CoreEntry, SensorChanged
from agent_server.recording.takes import Cue, Done, Taken, TakePlan
from agent_server.recording.writer import RecordingWriter
from agent_server.service.journal import Journal, NoJournal


@dataclass(frozen=True, slots=True)
class SensorMoved:
    """A sensor came to the session, or left it."""

    is_here: bool


@dataclass(frozen=True, slots=True)
class OtherSession:
    """Somebody came to a session that nobody waits for."""

    session: str


Notice = Cue | SensorMoved | OtherSession


class TakeRecorder(NoJournal):
    """The journal of one session: writes what the sensor sends, and a label a repetition.

    The file appears with the first frame, and a repetition is on the disk once it is labelled.
    A file without any label would be of no use, so it is removed at the end.

    Args:
        folder: Where the file goes; it is made if need be.
        plan: What is to be recorded.
        session: Id of the session to record.
        clock: Names the file.
        tell: Is given everything that the person ought to know, at once.

    Attributes:
        path: The file.
        frames: How many frames were written, of all bodies.
        labels: What was written of labels.
        ended: Set when no more is written: everything is there, the disk failed, or the
            session was closed.
        is_complete: Every repetition was shown.
        failure: Why the file could not be written, or None.

    Raises:
        RecordingError: If the folder cannot be made or the file exists.
    """

    def __init__(
        self,
        folder: Path,
        plan: TakePlan,
        session: str,
        clock: Clock,
        tell: Callable[[Notice], None],
    ) -> None:
        self._created = clock.wall()
        moment = self._created[:19].replace(":", "")
        self.path = folder / f"{plan.gesture}-{plan.subject}-{moment}.mcap"
        self.director = TakeDirector(plan)
        self.frames = 0
        self.labels: list[Label] = []
        self.ended = asyncio.Event()
        self.is_complete = False
        self.failure: RecordingError | None = None
        self._plan = plan
        self._session = session
        self._tell = tell
        self._face = "expected"
        self._writer: RecordingWriter | None = None
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise RecordingError(f"{folder} cannot be made: {error.strerror or error}") from error
        if self.path.exists():
            raise RecordingError(f"{self.path} exists already: start again in a second")

    def open(self, session: str) -> Journal:
        """The journal of a session: this one if it is the session to record."""
        if session == self._session:
            return self
        self._tell(OtherSession(session))
        return NoJournal()

    def append_input(self, value: RawInput, arrival_ns: int) -> None:
        """Write what the sensor sends, from the first frame of a body on."""
        if isinstance(value, SkeletonFrame):
            self._write(lambda: self._append_frame(value))
        elif self._writer is not None:
            writer = self._writer
            self._write(lambda: writer.append_input(value))

    def append_core(self, entry: CoreEntry) -> None:
        """Take note of sensors that come and go, and of time that passes."""
        if isinstance(entry, SensorChanged):
            self._face = entry.face
            if not self.ended.is_set():
                self._tell(SensorMoved(entry.open))
        self._write(lambda: self._act(self.director.advance(entry.stamp_ns)))

    def close(self) -> None:
        """Finish the file. Does nothing the second time."""
        self._write(self._finish)

    def _append_frame(self, frame: SkeletonFrame) -> None:
        if self._writer is None:
            self._writer = RecordingWriter(self.path, self._metadata(frame))
        self._writer.append_input(frame)
        self.frames += 1
        self._act(self.director.push(frame))

    def _act(self, cues: list[Cue]) -> None:
        for cue in cues:
            if isinstance(cue, Taken) and self._writer is not None:
                self._writer.append_label(cue.label)
                self._writer.flush()
                self.labels.append(cue.label)
            self._tell(cue)
            if isinstance(cue, Done):
                self.is_complete = True
                self._finish()

    def _finish(self) -> None:
        self._act(self.director.stop())
        self.ended.set()
        if self._writer is None:
            return
        self._writer.close()
        if not self.labels:
            self.path.unlink()

    def _write(self, action: Callable[[], None]) -> None:
        """Act until the end. A session cannot deal with a failing disk, so it is kept for later."""
        if self.ended.is_set():
            return
        try:
            action()
        except RecordingError as error:
            self.failure = error
            self.ended.set()
            if self._writer is not None:
                with suppress(RecordingError):
                    self._writer.close()

    def _metadata(self, frame: SkeletonFrame) -> RecordingMetadata:
        return RecordingMetadata(
            session=self._session,
            server_version=__version__,
            face=self._face,
            joint_format=frame.format,
            created=self._created,
            description=f"{self._plan.subject} shows {self._plan.gesture}, to teach it.",
            origin="agent-server gestures record",
        )
