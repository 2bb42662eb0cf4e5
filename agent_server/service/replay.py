"""Replay: a recording through the same core, without a network and without waiting.

A recording made by a live session holds the order in which things entered its core; that order
is followed to the letter. A recording without it (made by the generator or converted from a
data set) is dealt with as by a live session that is never late.
"""

import logging
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from itertools import islice

import msgspec

from agent_server.domain.affect import AffectSample, Calibration
from agent_server.domain.command import Ack
from agent_server.domain.decision import Decision
from agent_server.domain.face import FaceBlendshapes, FaceLandmarks, GazeSample
from agent_server.domain.inputs import RawInput
from agent_server.domain.motion import BodyLost
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import RecordingError
from agent_server.protocol.convert import decision_body
from agent_server.recording.parts import later_parts
from agent_server.recording.reader import Recording, open_recording
from agent_server.recording.records import (
    BodyGone,
    CoreEntry,
    ModelsChanged,
    RendererChanged,
    Restored,
    SensorChanged,
    Tick,
    WindowDone,
    WindowSkipped,
)
from agent_server.recording.topics import CORE
from agent_server.service.core import Core, Job, PendingWindow
from agent_server.service.models import Models
from agent_server.service.worker import infer
from agent_server.stages.affect import read_affect
from agent_server.stages.classify import classify
from agent_server.stages.predict import hold_last

log = logging.getLogger(__name__)

LOOK_AHEAD = 512
"""Entries that are read at once: eight seconds of body and face."""
BATCH = 32
"""Windows that the models are given at once, where they are known early enough."""


def replay(recording: Recording, core: Core, models: Models) -> Iterator[Decision]:
    """Every decision on a recording, in order.

    The models see many windows and faces at once, which changes no bit of what they say
    (``batch_exact``); the decisions on them are made one by one.

    Args:
        recording: What was recorded. After the first part of one that was written in parts come
            the others, as far as they are there.
        core: A fresh core whose session id is the recording's.
        models: The models to decide with.

    Raises:
        RecordingError: If the recording cannot be read or contradicts itself.
    """
    is_whole = recording.metadata.part == 1
    if CORE.name in recording.summary.topics and is_whole:
        return _Follower(recording, core, models).run(_all_entries(recording))
    if not is_whole:
        log.warning(
            "%s is part %d of a recording: what came before is not known, and every window is "
            "decided on anew; replay the first part for the decisions as they were",
            recording.path,
            recording.metadata.part,
        )
    core.set_face(recording.metadata.face or "expected")
    return replay_stream(core, models, recording.events())


def replay_stream(core: Core, models: Models, events: Iterable[RawInput]) -> Iterator[Decision]:
    """Every decision on a bare stream of inputs, in the order in which they were captured."""
    return _Punctual(core, models).run(events)


def _all_entries(first: Recording) -> Iterator[RawInput | CoreEntry]:
    yield from first.entries()
    for path in later_parts(first.path):
        yield from open_recording(path).entries()


def log_line(decision: Decision) -> bytes:
    """A decision as a line of a decision log, without the line's end."""
    return msgspec.json.encode(decision_body(decision))


class _Replay(ABC):
    """Runs the half of the core that makes windows ahead of the half that decides on them."""

    def __init__(self, core: Core, models: Models) -> None:
        self._core = core
        self._models = models
        self._waiting: list[tuple[PendingWindow, str | None]] = []

    def run(self, entries: Iterable[RawInput | CoreEntry]) -> Iterator[Decision]:
        """The decisions on all entries."""
        rest = iter(entries)
        while block := list(islice(rest, LOOK_AHEAD)):
            faces = [one for one in block if isinstance(one, FaceLandmarks | FaceBlendshapes)]
            estimates = iter(read_affect(self._models.affect, faces))
            for entry in block:
                if isinstance(entry, FaceLandmarks | FaceBlendshapes):
                    self._core.look(entry, next(estimates))
                elif isinstance(entry, SkeletonFrame):
                    yield from self._take(self._core.observe(entry))
                else:
                    yield from self._enter(entry)
        yield from self._decide_all()

    @abstractmethod
    def _take(self, jobs: list[Job]) -> Iterator[Decision]:
        """Deal with the jobs that a frame gives."""

    def _enter(self, entry: RawInput | CoreEntry) -> Iterator[Decision]:
        match entry:
            case AffectSample():
                self._core.feel(entry)
            case GazeSample():
                self._core.gaze(entry)
            case _:
                # The room sees it too, and must have seen all decisions that came before.
                yield from self._decide_all()
                self._tell(entry)

    def _tell(self, entry: RawInput | CoreEntry) -> None:
        match entry:
            case Calibration():
                self._core.calibrate(entry)
            case Ack():
                self._core.acknowledge(entry)
            case ObjectChanged():
                self._core.change_object(entry)

    def _wait(self, pending: PendingWindow, failure: str | None) -> Iterator[Decision]:
        self._waiting.append((pending, failure))
        if len(self._waiting) >= BATCH:
            yield from self._decide_all()

    def _decide_all(self) -> Iterator[Decision]:
        """Decide on every window that waits, in order."""
        waiting, self._waiting = self._waiting, []
        good = [pending.window for pending, failure in waiting if failure is None]
        inferences = iter(infer(self._models, good) if good else ())
        for pending, failure in waiting:
            if failure is None:
                inference = next(inferences)
                forecast, classification = inference.forecast, inference.classification
            else:
                forecast = hold_last(pending.window, failure)
                classification = classify(self._models.classifier, [pending.window], [forecast])[0]
            yield self._core.decide(pending, forecast, classification).decision


class _Punctual(_Replay):
    """Decides on a bare stream as if every window were decided on at once."""

    def _take(self, jobs: list[Job]) -> Iterator[Decision]:
        for job in jobs:
            if isinstance(job, BodyLost):
                yield from self._decide_all()
                self._core.lose_body(job)
            else:
                yield from self._wait(job, None)


class _Follower(_Replay):
    """Follows the log of what entered a live session's core."""

    def __init__(self, recording: Recording, core: Core, models: Models) -> None:
        super().__init__(core, models)
        self._recording = recording
        self._windows: dict[int, PendingWindow] = {}

    def _take(self, jobs: list[Job]) -> Iterator[Decision]:
        """Windows wait until the log says what became of them; a loss is in the log itself."""
        for job in jobs:
            if isinstance(job, PendingWindow):
                self._windows[job.window.index] = job
        return iter(())

    def _enter(self, entry: RawInput | CoreEntry) -> Iterator[Decision]:
        match entry:
            case WindowDone(index=index, failure=failure):
                yield from self._wait(self._pop(index), failure)
            case WindowSkipped(index=index):
                self._pop(index)
            case _:
                yield from super()._enter(entry)

    def _tell(self, entry: RawInput | CoreEntry) -> None:
        match entry:
            case Tick(stamp_ns=now_ns):
                self._take(self._core.tick(now_ns)[0])
            case RendererChanged(stamp_ns=now_ns, attached=attached):
                self._core.set_renderer(attached, now_ns)
            case SensorChanged(face=face):
                self._core.set_face(face)
            case Restored(room=room):
                self._core.restore(room)
            case ModelsChanged(stamp_ns=now_ns):
                raise RecordingError(
                    f"{self._recording.path}: from {now_ns / NS_PER_S:.1f} s on other models "
                    "decided, which were swapped in while it was recorded; a replay has one set "
                    "of models, so replay recordings of before and after the swap"
                )
            case BodyGone(stamp_ns=now_ns, body_id=body_id):
                self._core.lose_body(BodyLost(now_ns, body_id))
            case _:
                super()._tell(entry)

    def _pop(self, index: int) -> PendingWindow:
        pending = self._windows.pop(index, None)
        if pending is None:
            raise RecordingError(
                f"{self._recording.path}: its log speaks of window {index}, which its frames do "
                "not give: it was recorded with other settings, or is damaged"
            )
        return pending
