"""What is asked of a person whose gesture is recorded, and what is said to them meanwhile."""

import re
from dataclasses import dataclass
from enum import Enum, auto

from agent_server.domain.gesture import GESTURES, IDLE
from agent_server.domain.label import Label
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import InvalidInput

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,39}")
_SUBJECT = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,39}")
_CAUSES = ("attention_timeout", "body_lost")
"""What causes a command beside a gesture; a gesture of that name could not be told from it."""

MIN_IDLE_NS = 3 * NS_PER_S
"""A shorter stretch of idle motion fills no window of the classifier."""


@dataclass(frozen=True, slots=True)
class TakePlan:
    """What is to be recorded.

    Attributes:
        gesture: Its name; ``idle`` is one stretch as long as all repetitions would take.
        subject: Who moves.
        repetitions: How often.
        window_ns: Time for one repetition, from "go" to rest.
        rest_ns: Rest after it.

    Raises:
        InvalidInput: If a name is refused or a number is out of range.
    """

    gesture: str
    subject: str
    repetitions: int
    window_ns: int
    rest_ns: int

    def __post_init__(self) -> None:
        _check_gesture(self.gesture)
        if not _SUBJECT.fullmatch(self.subject):
            raise InvalidInput(
                f"subject is {self.subject!r}: use 1 to 40 letters, digits, '_' and '-', the same "
                "name for the same person in every recording",
                field="subject",
            )
        if self.repetitions < 1 or self.window_ns < NS_PER_S or self.rest_ns < 0:
            raise InvalidInput(
                f"{self.repetitions} repetitions of {self.window_ns / NS_PER_S:g} s with "
                f"{self.rest_ns / NS_PER_S:g} s of rest: record at least one, of at least 1 s",
                field="repetitions",
            )
        if self.is_idle and self.idle_ns < MIN_IDLE_NS:
            raise InvalidInput(
                f"{self.idle_ns / NS_PER_S:g} s of idle motion fill no window: record at least "
                f"{MIN_IDLE_NS / NS_PER_S:g} s",
                field="repetitions",
            )

    @property
    def is_idle(self) -> bool:
        """Whether everything but gestures is recorded."""
        return self.gesture == IDLE

    @property
    def idle_ns(self) -> int:
        """Length of idle motion: as long as all repetitions with their rests."""
        return self.repetitions * (self.window_ns + self.rest_ns)


def _check_gesture(name: str) -> None:
    if not _NAME.fullmatch(name):
        raise InvalidInput(
            f"the gesture is called {name!r}: use 1 to 40 letters, digits, '_' and '-', a letter "
            "first",
            field="gesture",
        )
    if name in _CAUSES:
        raise InvalidInput(
            f"{name!r} already is a cause of commands: choose another name", field="gesture"
        )
    if name not in GESTURES and name.lower() in GESTURES:
        raise InvalidInput(
            f"{name!r} differs from the built-in {name.lower()!r} only in its capitals: write "
            f"{name.lower()!r} to teach that one anew, or choose another name",
            field="gesture",
        )


class Spoilt(Enum):
    """Why a repetition does not count."""

    STILL = auto()
    """Nothing moved."""
    HIDDEN = auto()
    """The sensor mostly guessed where the hands are."""
    LOST = auto()
    """The body went, or its frames stopped."""


@dataclass(frozen=True, slots=True)
class Seen:
    """Somebody is there; the first count comes in a moment."""


@dataclass(frozen=True, slots=True)
class Gone:
    """Nobody is there any more."""


@dataclass(frozen=True, slots=True)
class Count:
    """``left`` seconds until repetition ``repetition``, which counts from 1."""

    repetition: int
    left: int


@dataclass(frozen=True, slots=True)
class Go:
    """The repetition begins and may take ``for_ns``."""

    repetition: int
    for_ns: int


@dataclass(frozen=True, slots=True)
class Left:
    """``left_ns`` of a long stretch are left."""

    left_ns: int


@dataclass(frozen=True, slots=True)
class Taken:
    """A repetition counts.

    Attributes:
        repetition: Which one.
        label: Where it lies.
        is_cut: Whether the arms were not back at rest when its time was over.
    """

    repetition: int
    label: Label
    is_cut: bool


@dataclass(frozen=True, slots=True)
class Again:
    """A repetition does not count and comes again."""

    repetition: int
    reason: Spoilt


@dataclass(frozen=True, slots=True)
class Done:
    """Everything is recorded."""


Cue = Seen | Gone | Count | Go | Left | Taken | Again | Done
