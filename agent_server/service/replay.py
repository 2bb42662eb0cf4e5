"""Replay: a recording through the same core, without a network and without waiting.

A recording made by a live session holds the order in which things entered its core; that order
is followed to the letter. A recording without it (made by the generator or converted from a
data set) is dealt with as by a live session that is never late.
"""

from collections.abc import Iterable, Iterator

import msgspec

from agent_server.domain.affect import AffectSample, Calibration
from agent_server.domain.command import Ack
from agent_server.domain.decision import Decision
from agent_server.domain.face import FaceBlendshapes, FaceLandmarks, GazeSample
from agent_server.domain.inputs import RawInput
from agent_server.domain.motion import BodyLost
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import RecordingError
from agent_server.protocol.convert import decision_body
from agent_server.recording.reader import Recording
from agent_server.recording.records import (
    BodyGone,
    CoreEntry,
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
from agent_server.stages.classify import classify
from agent_server.stages.predict import hold_last


def replay(recording: Recording, core: Core, models: Models) -> Iterator[Decision]:
    """Every decision on a recording, in order.

    Args:
        recording: What was recorded.
        core: A fresh core whose session id is the recording's.
        models: The models to decide with.

    Raises:
        RecordingError: If the recording cannot be read or contradicts itself.
    """
    if CORE.name in recording.summary.topics:
        yield from _Follower(recording, core, models).run()
        return
    core.set_face(recording.metadata.face or "expected")
    yield from replay_stream(core, models, recording.events())


def replay_stream(core: Core, models: Models, events: Iterable[RawInput]) -> Iterator[Decision]:
    """Every decision on a bare stream of inputs, in the order in which they were captured."""
    for event in events:
        for job in _enter(core, event):
            if isinstance(job, BodyLost):
                core.lose_body(job)
            else:
                inference = infer(models, [job.window])[0]
                yield core.decide(job, inference.forecast, inference.classification).decision


def log_line(decision: Decision) -> bytes:
    """A decision as a line of a decision log, without the line's end."""
    return msgspec.json.encode(decision_body(decision))


def _enter(core: Core, event: RawInput) -> list[Job]:
    match event:
        case SkeletonFrame():
            return core.observe(event)
        case AffectSample():
            core.feel(event)
        case FaceLandmarks() | FaceBlendshapes():
            core.look(event)
        case GazeSample():
            core.gaze(event)
        case Calibration():
            core.calibrate(event)
        case Ack():
            core.acknowledge(event)
        case ObjectChanged():
            core.change_object(event)
    return []


class _Follower:
    """Follows the log of what entered a live session's core."""

    def __init__(self, recording: Recording, core: Core, models: Models) -> None:
        self._recording = recording
        self._core = core
        self._models = models
        self._windows: dict[int, PendingWindow] = {}

    def run(self) -> Iterator[Decision]:
        for entry in self._recording.entries():
            if isinstance(entry, RawInput):
                self._keep(_enter(self._core, entry))
            elif isinstance(entry, WindowDone):
                yield self._decide(entry)
            else:
                self._apply(entry)

    def _apply(self, entry: CoreEntry) -> None:
        match entry:
            case WindowSkipped(index=index):
                self._take(index)
            case Tick(stamp_ns=now_ns):
                self._keep(self._core.tick(now_ns)[0])
            case RendererChanged(stamp_ns=now_ns, attached=attached):
                self._core.set_renderer(attached, now_ns)
            case SensorChanged(face=face):
                self._core.set_face(face)
            case Restored(room=room):
                self._core.restore(room)
            case BodyGone(stamp_ns=now_ns, body_id=body_id):
                self._core.lose_body(BodyLost(now_ns, body_id))

    def _decide(self, entry: WindowDone) -> Decision:
        pending = self._take(entry.index)
        window = pending.window
        if entry.failure is None:
            inference = infer(self._models, [window])[0]
            forecast, classification = inference.forecast, inference.classification
        else:
            forecast = hold_last(window, entry.failure)
            classification = classify(self._models.classifier, [window], [forecast])[0]
        return self._core.decide(pending, forecast, classification).decision

    def _keep(self, jobs: Iterable[Job]) -> None:
        """Windows wait until the log says what became of them; a loss is in the log itself."""
        for job in jobs:
            if isinstance(job, PendingWindow):
                self._windows[job.window.index] = job

    def _take(self, index: int) -> PendingWindow:
        pending = self._windows.pop(index, None)
        if pending is None:
            raise RecordingError(
                f"{self._recording.path}: its log speaks of window {index}, which its frames do "
                "not give: it was recorded with other settings, or is damaged"
            )
        return pending
