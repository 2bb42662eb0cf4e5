"""Recording live sessions, where a disk that fails, is full or slow never stops a session.

What enters and leaves a session waits in a bounded queue for a thread that writes. When the disk
fails, or so much waits that it cannot keep up, recording stops: it is logged, the session's
monitors are told, what is not written any more is counted, and what was written stays.
"""

import hashlib
import logging
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Thread

import msgspec

from agent_server import __version__
from agent_server.clock import Clock
from agent_server.config import RecordingSettings, Settings
from agent_server.domain.inputs import RawInput
from agent_server.domain.stamp import NS_PER_S, to_ns
from agent_server.errors import RecordingError
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.parts import PartLimits, PartWriter
from agent_server.recording.records import CoreEntry, SensorChanged
from agent_server.recording.retention import Keep, prune, recording_name
from agent_server.recording.writer import Output, RecordingWriter
from agent_server.service.journal import Journal
from agent_server.service.models import Models

log = logging.getLogger(__name__)

MAX_WAITING_BYTES = 64 * 1024 * 1024
"""What may wait for the disk: some minutes of a session, or some seconds with images."""
RECORD_BYTES = 4096
"""What a record that waits counts for, beside an image: a body has 2 KB, a face 8 KB."""
FLUSH_NS = NS_PER_S // 2
CLOSE_S = 5.0
PRUNE_NS = 60 * NS_PER_S
MB = 1_000_000

_Write = Callable[[RecordingWriter], None]


@dataclass(frozen=True, slots=True)
class _Waiting:
    write: _Write
    size: int
    face: str | None = None


class Recorder(Journal):
    """A journal on disk, written by a thread of its own.

    Args:
        path: File to create; parts after the first lie beside it.
        metadata: What the recording says about itself.
        clock: Where to read the time.
        settings: When a part ends, and what is kept of the folder.
        with_images: Whether images of the face are written too.
    """

    def __init__(
        self,
        path: Path,
        metadata: RecordingMetadata,
        clock: Clock,
        settings: RecordingSettings | None = None,
        *,
        with_images: bool = False,
    ) -> None:
        self._path = path
        self._metadata = metadata
        self._clock = clock
        self._settings = settings or RecordingSettings()
        self._with_images = with_images
        self._begun_ns = clock.now_ns()
        self._queue: SimpleQueue[_Waiting | None] = SimpleQueue()
        # One side only ever counts up each, so that no lock is needed.
        self._given = self._taken = 0
        self._failure: str | None = None
        self._told = False
        self._lost = 0
        self._thread = Thread(target=self._run, name=path.name, daemon=True)
        self._thread.start()

    def append_input(self, value: RawInput, arrival_ns: int) -> None:
        """Write what a client sent, when it came, and that it has been dealt with now."""
        times = (
            max(0, arrival_ns - self._begun_ns),
            max(0, self._clock.now_ns() - self._begun_ns),
        )
        self._give(lambda writer: writer.append_input(value, times))

    def append_image(self, jpeg: bytes, stamp_ns: int) -> None:
        """Write an image, if images are to be recorded."""
        if self._with_images:
            self._give(lambda writer: writer.append_image(jpeg, stamp_ns), len(jpeg))

    def append_core(self, entry: CoreEntry) -> None:
        """Write what else the core was told."""
        face = entry.face if isinstance(entry, SensorChanged) else None
        self._give(lambda writer: writer.append_core(entry), face=face)

    def append_output(self, message: Output, stamp_ns: int) -> None:
        """Write what came of it."""
        self._give(lambda writer: writer.append_output(message, stamp_ns))

    def take_failure(self) -> str | None:
        """Why recording has stopped, once."""
        if self._told or self._failure is None:
            return None
        self._told = True
        return self._failure

    @property
    def lost(self) -> int:
        """Records that were not written because recording had stopped."""
        return self._lost

    def close(self) -> None:
        """Finish the file; a disk that hangs is not waited for long."""
        self._queue.put(None)
        self._thread.join(CLOSE_S)
        if self._thread.is_alive():
            log.error("%s: the disk hangs, the end of the recording is not there", self._path)

    def _give(self, write: _Write, size: int = 0, face: str | None = None) -> None:
        if self._failure is not None:
            self._lost += 1
            return
        size += RECORD_BYTES
        if self._given - self._taken + size > MAX_WAITING_BYTES:
            self._lost += 1
            self._fail(f"{self._path}: the disk is too slow, {MAX_WAITING_BYTES / MB:.0f} MB wait")
            return
        self._given += size
        self._queue.put(_Waiting(write, size, face))

    def _fail(self, why: str) -> None:
        if self._failure is None:
            self._failure = why
            log.error("recording stopped, the session goes on: %s", why)

    def _run(self) -> None:
        settings = self._settings
        limits = PartLimits(round(settings.rotate_mb * MB), to_ns(settings.rotate_minutes * 60))
        try:
            with PartWriter(self._path, self._metadata, limits, self._begun_ns) as parts:
                self._write_all(parts)
        except RecordingError as error:
            self._fail(str(error))
        except Exception:  # whatever it was, the session goes on
            log.exception("a recording failed in a way that it should not")
            self._fail(f"{self._path}: the recorder failed")

    def _write_all(self, parts: PartWriter) -> None:
        """Write what comes until there is no more; nothing waits for longer than half a second."""
        flushed_ns = self._clock.now_ns()
        pruned_ns: int | None = None
        face: str | None = None
        while not (self._failure is not None and self._queue.empty()):
            try:
                waiting = self._queue.get(timeout=FLUSH_NS / NS_PER_S)
            except Empty:
                waiting = _NOTHING
            if waiting is None:
                return
            waiting.write(parts.current)
            self._taken += waiting.size
            face = waiting.face or face
            now_ns = self._clock.now_ns()
            if waiting is _NOTHING or now_ns - flushed_ns >= FLUSH_NS:
                parts.current.flush()
                flushed_ns = now_ns
            if parts.turn_over(now_ns, face) or pruned_ns is None or now_ns - pruned_ns >= PRUNE_NS:
                self._prune()
                pruned_ns = now_ns

    def _prune(self) -> None:
        kept = self._settings
        keep = Keep(size=round(kept.keep_mb * MB) or None, age_s=kept.keep_days * 24 * 3600 or None)
        try:
            for path in prune(self._path.parent, keep, self._clock.wall_ns() / NS_PER_S):
                log.info("deleted %s: older or more recordings than are to be kept", path)
        except OSError as error:
            log.warning("old recordings cannot be deleted: %s", error)


_NOTHING = _Waiting(lambda writer: None, 0)


def recorder(
    folder: Path, session: str, models: Models, clock: Clock, settings: Settings, rules: bytes
) -> Recorder:
    """A recorder into a new file of ``folder``, named after the session and the time.

    Args:
        folder: Where recordings go.
        session: Id of the session.
        models: The models, whose hashes it states.
        clock: Where to read the time.
        settings: All settings.
        rules: The room's rule file.
    """
    wall = clock.wall()
    chosen = settings.recording
    metadata = RecordingMetadata(
        session=session,
        server_version=__version__,
        bundles={model.name: model.sha256 for _, model in models.by_task},
        created=wall,
        config=settings_hash(settings),
        rules=hashlib.sha256(rules).hexdigest(),
        participant=chosen.participant or None,
        consent=chosen.consent,
    )
    return Recorder(
        folder / recording_name(session, wall),
        metadata,
        clock,
        chosen,
        with_images=settings.face.record_images,
    )


def settings_hash(settings: Settings) -> str:
    """SHA-256 of the settings that decisions depend on, in hexadecimal."""
    s = settings
    deciding = (s.window, s.subject, s.face.window_ms, s.gate, s.gaze, s.decide)
    return hashlib.sha256(msgspec.json.encode(deciding, order="sorted")).hexdigest()
