"""The agent's room as a state machine over integer time.

It reads no clock: every event says when it happens, and everything that falls due in between
happens at its own deadline, however late the machine hears of it. So the same events give the
same commands, no matter how often :meth:`Room.advance` is called.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from agent_server.domain.command import Ack, AckStatus, Command, CommandEnd, Ending, Motion
from agent_server.domain.decision import Outcome, SceneVerdict
from agent_server.domain.motion import BodyLost
from agent_server.domain.scene import (
    AgentMode,
    Authority,
    Difference,
    ObjectChanged,
    RoomState,
    SceneSnapshot,
)
from agent_server.domain.stamp import NS_PER_MS, to_ns
from agent_server.errors import InvalidInput
from agent_server.scene.rulebook import RESUME_WORK, Reaction, Rule, Rules
from agent_server.suggest import suggest

PATIENCE = 2
"""A renderer that says nothing of a command for so many nominal durations has failed it."""

ATTENTION_TIMEOUT = "attention_timeout"
BODY_LOST = "body_lost"


@dataclass(frozen=True, slots=True)
class Consideration:
    """What the room makes of a gesture.

    Attributes:
        outcome: ``COMMAND``, ``BUSY`` or ``NOTHING_TO_DO``.
        verdict: The explanation.
        command: The command that the gesture causes, or None.
        commands: Everything to send, in order: what fell due before the gesture, then
            ``command``.
    """

    outcome: Outcome
    verdict: SceneVerdict
    command: Command | None
    commands: tuple[Command, ...]


@dataclass(frozen=True, slots=True)
class Acknowledgement:
    """What the room makes of a renderer's word.

    Attributes:
        taken: Whether it spoke of the command that is being carried out. Words on unknown,
            finished and pre-empted commands change nothing.
        commands: Everything to send, in order.
    """

    taken: bool
    commands: tuple[Command, ...]


@dataclass(slots=True)
class _Running:
    """The command that is being carried out.

    Attributes:
        command: As it was sent.
        reaction: What it carries out.
        heard_ns: When a renderer last gave a sign of life, or could first have done so.
        is_started: Whether it has begun: a renderer said so, or there was none to say it.
    """

    command: Command
    reaction: Reaction
    heard_ns: int
    is_started: bool

    @property
    def duration_ns(self) -> int:
        """Nominal time that it takes."""
        return to_ns(self.command.duration_s)

    @property
    def expires_ns(self) -> int:
        """When it is not worth starting any more."""
        return self.command.issued_ns + self.command.ttl_ms * NS_PER_MS


class Room:
    """One session's room.

    An event that is older than the newest one counts as happening at the newest one's time:
    time never goes back.

    Args:
        rules: What can happen.
        session_id: Prefix of the commands' ids.
    """

    def __init__(self, rules: Rules, session_id: str) -> None:
        self._rules = rules
        self._session_id = session_id
        self._attention_ns = to_ns(rules.attention_s)
        self._objects = {
            thing.name: thing.initial
            for thing in rules.objects.values()
            if thing.initial is not None
        }
        self._mode = AgentMode.WORKING
        self._running: _Running | None = None
        self._sequence = 0
        self._now_ns = 0
        self._gesture_ns = 0  # when the last gesture came
        self._attending_ns = 0  # when attention began
        self._lost_ns: int | None = None  # when the body left, unless a gesture came since
        self._has_renderer = False
        self._detached_ns = 0  # when a renderer last left
        self._endings: list[Ending] = []

    def snapshot(self) -> SceneSnapshot:
        """The room at the time of the newest event. Objects without states are left out."""
        command_id = self._running.command.id if self._running else None
        return SceneSnapshot(self._mode, dict(self._objects), command_id)

    def take_endings(self) -> tuple[Ending, ...]:
        """The commands that have ended since this was last asked, in order."""
        endings = tuple(self._endings)
        self._endings.clear()
        return endings

    def state(self) -> RoomState:
        """All that is to be remembered over a restart."""
        running = self._running
        return RoomState(
            mode=self._mode,
            objects=dict(self._objects),
            sequence=self._sequence,
            now_ns=self._now_ns,
            gesture_ns=self._gesture_ns,
            attending_ns=self._attending_ns,
            lost_ns=self._lost_ns,
            has_renderer=self._has_renderer,
            command=None if running is None else running.command,
            is_started=running is not None and running.is_started,
            heard_ns=0 if running is None else running.heard_ns,
        )

    def restore(self, state: RoomState) -> None:
        """Go on where a room has stopped.

        What the rules no longer know is left out: objects keep their initial state, and a command
        whose reaction is gone has failed.
        """
        for name, value in state.objects.items():
            if name in self._objects and value in self._rules.objects[name].states:
                self._objects[name] = value
        self._mode = state.mode
        self._sequence = state.sequence
        self._now_ns = state.now_ns
        self._gesture_ns = state.gesture_ns
        self._attending_ns = state.attending_ns
        self._lost_ns = state.lost_ns
        self._has_renderer = state.has_renderer
        command = state.command
        if command is None:
            return
        reaction = self._rules.reactions.get(command.reaction)
        if reaction is not None:
            self._running = _Running(command, reaction, state.heard_ns, state.is_started)
        else:
            self._endings.append(Ending(command.id, CommandEnd.FAILED))
            self._mode = AgentMode.ATTENTION

    def deadline(self) -> int | None:
        """When something happens next if no event comes before; None if nothing will."""
        running = self._running
        if running is not None:
            if self._has_renderer and not running.is_started:
                return running.expires_ns
            if self._has_renderer:
                return running.heard_ns + PATIENCE * running.duration_ns
            return max(running.command.issued_ns + running.duration_ns, self._detached_ns)
        if self._mode is AgentMode.ATTENTION:
            lost_ns = self._lost_ns
            end_ns = self._gesture_ns + self._attention_ns if lost_ns is None else lost_ns
            return max(end_ns, self._attending_ns)
        return None

    def advance(self, now_ns: int) -> tuple[Command, ...]:
        """Let time pass up to ``now_ns`` and give the commands that fell due, in order."""
        commands = []
        while (due_ns := self.deadline()) is not None and due_ns <= now_ns:
            self._now_ns = max(self._now_ns, due_ns)
            if self._running is not None:
                self._finish(self._running, self._end_of(self._running))
            else:
                cause = ATTENTION_TIMEOUT if self._lost_ns is None else BODY_LOST
                # No frame leads to the end of attention: it originates in that very moment.
                commands.append(self._start(self._rules.reactions[RESUME_WORK], cause, due_ns))
        self._now_ns = max(self._now_ns, now_ns)
        return tuple(commands)

    def consider(self, gesture: str, originating_ns: int, now_ns: int) -> Consideration:
        """React to a gesture that has passed the gate, or say why not.

        Args:
            gesture: A label other than ``idle``.
            originating_ns: Capture time of the last frame that led to it.
            now_ns: When it was decided.
        """
        due = self.advance(now_ns)
        self._gesture_ns = self._now_ns
        self._lost_ns = None
        mode = self._mode
        rules = self._rules.rules.get(gesture, ())
        rule = next((rule for rule in rules if not any(self._unmet(rule))), None)
        command = None
        if rule is None:
            outcome = Outcome.NOTHING_TO_DO
            unmet = [state for candidate in rules for state in self._unmet(candidate)]
            reason = ", ".join(dict.fromkeys(unmet)) or f"no rule for '{gesture}'"
        elif (busy_with := self._in_the_way_of(rule)) is not None:
            outcome = Outcome.BUSY
            reason = f"busy with {busy_with}"
        else:
            outcome = Outcome.COMMAND
            cut = self._running.reaction.name if self._running else None
            command = self._start(rule.reaction, gesture, originating_ns, rule.motion)
            reason = f"cuts short {cut}" if cut else "nothing in the way"
        shown = rule or next(iter(rules), None)
        verdict = SceneVerdict(
            mode=mode.value,
            rule=shown.name if shown else None,
            precondition=shown.precondition if shown else None,
            met=rule is not None,
            reason=reason,
        )
        return Consideration(outcome, verdict, command, (*due, command) if command else due)

    def acknowledge(self, ack: Ack) -> Acknowledgement:
        """Hear a renderer's word on a command."""
        due = self.advance(ack.stamp_ns)
        running = self._running
        if running is None or running.command.id != ack.command_id:
            return Acknowledgement(False, due)
        if ack.status is AckStatus.DONE:
            self._finish(running, CommandEnd.DONE)
        elif ack.status is AckStatus.FAILED:
            self._finish(running, CommandEnd.FAILED)
        else:
            running.heard_ns = self._now_ns
            running.is_started |= ack.status is not AckStatus.ACCEPTED
        return Acknowledgement(True, (*due, *self.advance(self._now_ns)))

    def change(self, changed: ObjectChanged) -> tuple[Command, ...]:
        """Take over an object's state that somebody set by hand, and give what fell due before.

        Raises:
            InvalidInput: If the object has no such state; nothing has happened then.
        """
        if changed.object not in self._objects:
            fix = suggest(changed.object, "objects with states", self._objects)
            raise InvalidInput(
                f"unknown object '{changed.object}'; {fix}", field="object", code="unknown_object"
            )
        states = self._rules.objects[changed.object].states
        if changed.state not in states:
            fix = suggest(changed.state, "states", states)
            raise InvalidInput(
                f"unknown state '{changed.state}' of '{changed.object}'; {fix}",
                field="state",
                code="unknown_state",
            )
        due = self.advance(changed.stamp_ns)
        self._objects[changed.object] = changed.state
        return due

    def compare(self, shown: Mapping[str, str]) -> tuple[Difference, ...]:
        """Where what a renderer shows is not what the room holds; changes nothing.

        The effect of the command that is being carried out is no difference: the renderer may be
        done with it and not have said so yet.
        """
        effects = self._running.reaction.effects if self._running is not None else ()
        ahead = {effect.object: effect.state for effect in effects}
        differences = []
        for name, state in shown.items():
            held = self._objects.get(name, "")
            if state in (held, ahead.get(name)):
                continue
            thing = self._rules.objects.get(name)
            is_known = thing is not None and state in thing.states
            kept = thing.authority if thing is not None and is_known else Authority.SERVER
            differences.append(Difference(name, state, held, kept))
        return tuple(differences)

    def lose_body(self, lost: BodyLost) -> tuple[Command, ...]:
        """The person has left: attention ends, at once or when the running reaction is over."""
        due = self.advance(lost.stamp_ns)
        self._lost_ns = self._now_ns
        return (*due, *self.advance(self._now_ns))

    def attach_renderer(self, now_ns: int) -> tuple[Command, ...]:
        """An acting renderer has come or taken over: what becomes of commands is its word."""
        due = self.advance(now_ns)
        self._has_renderer = True
        if self._running is not None:
            self._running.heard_ns = self._now_ns
        return due

    def detach_renderer(self, now_ns: int) -> tuple[Command, ...]:
        """The acting renderer has left: commands are done when their nominal time has passed."""
        due = self.advance(now_ns)
        self._has_renderer = False
        self._detached_ns = self._now_ns
        if self._running is not None:
            self._running.is_started = True
        return (*due, *self.advance(self._now_ns))

    def _unmet(self, rule: Rule) -> Iterator[str]:
        """The states that keep a rule from applying."""
        for condition in rule.when:
            if (state := self._objects[condition.object]) != condition.state:
                yield f"{condition.object} is {state}"

    def _in_the_way_of(self, rule: Rule) -> str | None:
        """The running reaction that a rule may not cut short; a return to work never is one."""
        if self._running is None or self._mode is AgentMode.WORKING:
            return None
        running = self._running.reaction
        if running.priority < rule.reaction.priority or running.name in rule.preempts:
            return None
        return running.name

    def _start(
        self,
        reaction: Reaction,
        cause: str,
        originating_ns: int,
        motion: Motion = Motion.AUTHORED,
    ) -> Command:
        self._sequence += 1
        command = Command(
            id=f"{self._session_id}/c{self._sequence}",
            sequence=self._sequence,
            reaction=reaction.name,
            cause=cause,
            steps=reaction.steps,
            priority=reaction.priority,
            preempts=self._running.command.id if self._running else None,
            originating_ns=originating_ns,
            issued_ns=self._now_ns,
            ttl_ms=reaction.ttl_ms,
            motion=motion,
        )
        if self._running is not None:
            self._endings.append(Ending(self._running.command.id, CommandEnd.PREEMPTED))
        self._running = _Running(command, reaction, self._now_ns, not self._has_renderer)
        is_return = reaction.name == RESUME_WORK
        self._mode = AgentMode.WORKING if is_return else AgentMode.REACTING
        return command

    def _end_of(self, running: _Running) -> CommandEnd:
        """How a command ends of which nobody says anything in time."""
        if not self._has_renderer:
            return CommandEnd.ASSUMED
        return CommandEnd.TIMED_OUT if running.is_started else CommandEnd.EXPIRED

    def _finish(self, running: _Running, end: CommandEnd) -> None:
        """End the running command; a reaction ends in attention."""
        if end in (CommandEnd.DONE, CommandEnd.ASSUMED):
            for effect in running.reaction.effects:
                self._objects[effect.object] = effect.state
        self._endings.append(Ending(running.command.id, end))
        self._running = None
        if self._mode is AgentMode.REACTING:
            self._mode = AgentMode.ATTENTION
            self._attending_ns = self._now_ns
