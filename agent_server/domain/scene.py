"""The agent's room: what state it is in and what happens to it."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum


class AgentMode(StrEnum):
    """What the agent is doing."""

    WORKING = "working"
    ATTENTION = "attention"
    REACTING = "reacting"


@dataclass(frozen=True, slots=True)
class SceneSnapshot:
    """The room at one instant.

    Attributes:
        mode: What the agent is doing.
        objects: State of every object, for example ``{"window": "open"}``.
        command_id: The command that is being carried out, or None.
    """

    mode: AgentMode
    objects: Mapping[str, str]
    command_id: str | None = None


@dataclass(frozen=True, slots=True)
class ObjectChanged:
    """Somebody changed an object by hand.

    Attributes:
        stamp_ns: When, on the session's time line.
        object: Name of the object, for example ``window``.
        state: Its new state, for example ``open``.
    """

    stamp_ns: int
    object: str
    state: str
