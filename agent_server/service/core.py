"""The heart of a session, pure in (value, stamp): no clock, no waiting, no chance.

It has two halves. :meth:`Core.observe` and its neighbours take what sensors send and give jobs,
in the order in which they must be dealt with. The other methods deal with jobs and with
what the renderer says, and give commands. A live session runs models between the halves; a
replay does the same without waiting, and so comes to the same decisions.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from agent_server.config import Settings
from agent_server.domain.affect import AffectSample, Calibrated, Calibration
from agent_server.domain.arrays import Float64
from agent_server.domain.command import Ack, Command, Ending
from agent_server.domain.decision import Decision, GateVerdict, Outcome, SceneVerdict
from agent_server.domain.face import Face, GazeSample
from agent_server.domain.gesture import Classification
from agent_server.domain.motion import BodyLost, Forecast, Window
from agent_server.domain.scene import Difference, ObjectChanged, RoomState, SceneSnapshot
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.scene.room import Acknowledgement, Room
from agent_server.scene.rulebook import Rules
from agent_server.service.models import Models
from agent_server.stages.affect import AffectEstimator
from agent_server.stages.decide import GestureTracker, Phase, Tracking
from agent_server.stages.gate import AffectGate
from agent_server.stages.perceive import Perception

_QUIET = {
    Phase.IDLE: (Outcome.IDLE, "nothing is going on"),
    Phase.UNSURE: (Outcome.UNSURE, "it is not clear enough yet"),
    Phase.COOLING_DOWN: (Outcome.COOLING_DOWN, "the same gesture ended a moment ago"),
    Phase.HANDLED: (Outcome.HANDLED, "it was answered already"),
}


@dataclass(frozen=True, slots=True)
class PendingWindow:
    """A window that waits for the models, with the gate as it stood when it was made."""

    window: Window
    gate: GateVerdict


Job = PendingWindow | BodyLost


@dataclass(frozen=True, slots=True)
class Result:
    """What a window came to.

    Attributes:
        decision: The decision with its reasons.
        commands: Commands for the renderer, in order.
    """

    decision: Decision
    commands: tuple[Command, ...]


class Core:
    """One session's stages and room.

    Args:
        session: Id of the session; ids of decisions and commands begin with it.
        settings: Thresholds and times.
        rules: The room's rules.
        models: The models; those that read affect from a face run here, the decisions name all.
    """

    def __init__(self, session: str, settings: Settings, rules: Rules, models: Models) -> None:
        self._session = session
        self.models: Mapping[str, str] = models.hashes
        self._rules = rules
        self._affect = AffectEstimator(models.affect, settings.face)
        self._gate = AffectGate(settings.gate, settings.gaze)
        self.perception = Perception(settings.window, settings.subject)
        self._tracker = GestureTracker(
            settings.decide, rules.ungated, 1 if settings.window.mode == "thesis" else None
        )
        self._room = Room(rules, session)
        self._next_decision = 0

    # ------------------------------------------------------------------ what sensors send

    def set_face(self, face: str) -> None:
        """Say what the sensors see of the person's face: ``expected``, ``none`` or ``gaze``."""
        self._gate.set_face(face)

    def observe(self, frame: SkeletonFrame) -> list[Job]:
        """Take a skeleton frame.

        Raises:
            InvalidInput: If it is out of order.
        """
        return [
            found if isinstance(found, BodyLost) else self._pending(found)
            for found in self.perception.push(frame)
        ]

    def feel(self, sample: AffectSample) -> None:
        """Take an affect sample.

        Raises:
            InvalidInput: If it is out of order.
        """
        self._gate.push(sample)

    def require(self, face: Face) -> None:
        """Refuse a face that :meth:`look` would not take, without reading it.

        Raises:
            InvalidInput: If it is out of order, or no model reads its kind.
        """
        self._gate.require_later(face.originating_ns)
        self._affect.require_model(face)

    def look(
        self, face: Face, estimate: Float64 | None = None
    ) -> tuple[AffectSample, Calibrated | None]:
        """Take a face and read affect from it, unless that has been done.

        Returns:
            What was read, and what a calibration came to that ended with it.

        Raises:
            InvalidInput: If it is out of order, or no model reads its kind.
            InferenceError: If the model fails.
        """
        self._gate.require_later(face.originating_ns)
        sample, calibrated = self._affect.push(face, estimate)
        self._gate.push(sample)
        return sample, calibrated

    def gaze(self, sample: GazeSample) -> None:
        """Take a gaze.

        Raises:
            InvalidInput: If it is out of order.
        """
        self._gate.push_gaze(sample)

    def calibrate(self, calibration: Calibration) -> Calibrated | None:
        """Begin a calibration of the person's neutral face, or take over one that is known."""
        return self._affect.calibrate(calibration)

    @property
    def is_waiting(self) -> bool:
        """Whether anything falls due by the passing of time alone."""
        return self.perception.is_following or self._room.deadline() is not None

    def tick(self, now_ns: int) -> tuple[list[Job], tuple[Command, ...]]:
        """Let time pass without input.

        Returns:
            Jobs; and if there are none, what fell due in the room.
        """
        lost = self.perception.advance(now_ns)
        return ([lost], ()) if lost is not None else ([], self._room.advance(now_ns))

    # ------------------------------------------------------------------ what comes of it

    def decide(
        self, pending: PendingWindow, forecast: Forecast, classification: Classification
    ) -> Result:
        """Come to a decision on a window that the models have seen."""
        window = pending.window
        due = self._room.advance(window.end_ns)
        tracking = self._tracker.push(classification, window.end_ns)
        outcome, reason, scene, command = self._answer(tracking, pending)
        index, self._next_decision = self._next_decision, self._next_decision + 1
        decision = Decision(
            id=f"{self._session}/{index}",
            index=index,
            window=window.index,
            start_ns=window.start_ns,
            end_ns=window.end_ns,
            body_id=window.body_id,
            models=dict(self.models),
            quality=window.quality,
            forecast=forecast.source,
            forecast_failure=forecast.failure,
            probabilities={
                label: round(float(p), 4)
                for label, p in zip(
                    classification.labels, classification.probabilities, strict=True
                )
            },
            gesture=tracking.gesture,
            gate=pending.gate,
            scene=scene,
            outcome=outcome,
            reason=reason,
            command=command,
            spread=classification.spread,
        )
        return Result(decision, due if command is None else (*due, command))

    def lose_body(self, lost: BodyLost) -> tuple[Command, ...]:
        """The person has left."""
        self._tracker.reset(lost.stamp_ns)
        return self._room.lose_body(lost)

    def acknowledge(self, ack: Ack) -> Acknowledgement:
        """Take the renderer's word on a command."""
        return self._room.acknowledge(ack)

    def change_object(self, event: ObjectChanged) -> tuple[Command, ...]:
        """Somebody changed an object by hand.

        Raises:
            InvalidInput: If the room has no such object or state.
        """
        return self._room.change(event)

    def set_renderer(self, attached: bool, stamp_ns: int) -> tuple[Command, ...]:
        """Say whether somebody carries out the commands."""
        if attached:
            return self._room.attach_renderer(stamp_ns)
        return self._room.detach_renderer(stamp_ns)

    def use_models(self, hashes: Mapping[str, str]) -> None:
        """Say which models decide from here on, by name and hash."""
        self.models = hashes

    def scene(self) -> SceneSnapshot:
        """The room as it is."""
        return self._room.snapshot()

    def compare(self, shown: Mapping[str, str]) -> tuple[Difference, ...]:
        """Where a renderer shows something else than the room holds; changes nothing."""
        return self._room.compare(shown)

    def take_endings(self) -> tuple[Ending, ...]:
        """The commands that have ended since this was last asked, in order."""
        return self._room.take_endings()

    def room_state(self) -> RoomState:
        """All of the room that is to be remembered over a restart."""
        return self._room.state()

    def restore(self, state: RoomState) -> None:
        """Go on with a room that has stopped, before anything else has entered."""
        self._room.restore(state)

    # ------------------------------------------------------------------ within

    def _pending(self, window: Window) -> PendingWindow:
        return PendingWindow(window, self._gate.verdict(window.end_ns))

    def _answer(
        self, tracking: Tracking, pending: PendingWindow
    ) -> tuple[Outcome, str, SceneVerdict | None, Command | None]:
        gesture = tracking.gesture
        if tracking.phase is not Phase.ACTIVE:
            outcome, reason = _QUIET[tracking.phase]
            subject = "" if tracking.phase is Phase.IDLE else f"{gesture}: "
            return outcome, subject + reason, None, None
        if self._rules.is_gated(gesture) and not pending.gate.is_open:
            return Outcome.GATED, f"{gesture}: {pending.gate.reason}", None, None
        window = pending.window
        answer = self._room.consider(gesture, window.end_ns, window.end_ns)
        if answer.command is not None:
            self._tracker.mark_handled()
        reason = f"{gesture}: {answer.verdict.reason}"
        return answer.outcome, reason, answer.verdict, answer.command
