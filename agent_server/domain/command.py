"""What the agent is told to do, and what its renderer answers."""

from dataclasses import dataclass
from enum import StrEnum


@dataclass(frozen=True, slots=True)
class Step:
    """One action of a reaction.

    Attributes:
        action: What to do, for example ``close``.
        target: Object it is done to, or None.
        duration_s: How long it nominally takes, in seconds.
    """

    action: str
    target: str | None
    duration_s: float


class Motion(StrEnum):
    """How the agent moves when it carries out a command.

    Attributes:
        AUTHORED: As its renderer has it for each step.
        GENERATED: As a model makes it while it plays; where it makes nothing, as authored.
    """

    AUTHORED = "authored"
    GENERATED = "generated"


@dataclass(frozen=True, slots=True)
class Command:
    """An order to the renderer, carried out once.

    Attributes:
        id: Idempotent identity, made of the session's id and the sequence number.
        sequence: Counts the session's commands from 1.
        reaction: Name of the reaction, for example ``close_window``; ``resume_work`` sends
            the agent back to its work.
        cause: Gesture or event that caused it, for example ``cold`` or ``attention_timeout``.
        steps: What to do, in order.
        priority: Higher goes first.
        preempts: Id of the command that this one cuts short, or None.
        originating_ns: Capture time of the last frame that led to it.
        issued_ns: When it was decided, on the session's time line.
        ttl_ms: For how long it is worth starting.
        motion: How the agent moves.
    """

    id: str
    sequence: int
    reaction: str
    cause: str
    steps: tuple[Step, ...]
    priority: int
    preempts: str | None
    originating_ns: int
    issued_ns: int
    ttl_ms: int
    motion: Motion = Motion.AUTHORED

    @property
    def duration_s(self) -> float:
        """Nominal time that all steps take, in seconds."""
        return sum(step.duration_s for step in self.steps)


class AckStatus(StrEnum):
    """Life of a command at the renderer."""

    ACCEPTED = "accepted"
    STARTED = "started"
    PROGRESS = "progress"
    DONE = "done"
    FAILED = "failed"


class CommandEnd(StrEnum):
    """How a command ended.

    Attributes:
        DONE: The renderer has carried it out.
        FAILED: The renderer could not.
        EXPIRED: The renderer did not start it while it was worth starting.
        PREEMPTED: A newer one cut it short.
        TIMED_OUT: The renderer started it and then said nothing for too long.
        ASSUMED: Nobody carries commands out, and its nominal time has passed.
    """

    DONE = "done"
    FAILED = "failed"
    EXPIRED = "expired"
    PREEMPTED = "preempted"
    TIMED_OUT = "timed_out"
    ASSUMED = "assumed"


@dataclass(frozen=True, slots=True)
class Ending:
    """A command that is over.

    Attributes:
        command_id: Which one.
        end: How it ended.
    """

    command_id: str
    end: CommandEnd


@dataclass(frozen=True, slots=True)
class Ack:
    """A renderer's word on a command.

    Attributes:
        stamp_ns: When it arrived, on the session's time line.
        command_id: Which command.
        status: What became of it.
        step: Index of the step that it speaks of, or None.
        reason: Why it failed, in words, or None.
    """

    stamp_ns: int
    command_id: str
    status: AckStatus
    step: int | None = None
    reason: str | None = None
