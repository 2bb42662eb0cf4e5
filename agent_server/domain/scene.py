"""The agent's room: what state it is in and what happens to it."""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from agent_server.domain.command import Command


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


@dataclass(frozen=True, slots=True)
class RoomState:
    """All that a room remembers, so that it can go on after a restart; times in nanoseconds.

    Attributes:
        mode: What the agent is doing.
        objects: State of every object that has any.
        sequence: Sequence of the last command.
        now_ns: Time of the newest event.
        gesture_ns: When the last gesture came.
        attending_ns: When attention began.
        lost_ns: When the body left, unless a gesture came since; else None.
        has_renderer: Whether somebody carries out the commands.
        command: The command that is being carried out, or None.
        is_started: Whether it was started.
        heard_ns: When a renderer last spoke of it, or could first have done so.
    """

    mode: AgentMode
    objects: Mapping[str, str]
    sequence: int
    now_ns: int
    gesture_ns: int
    attending_ns: int
    lost_ns: int | None = None
    has_renderer: bool = False
    command: Command | None = None
    is_started: bool = False
    heard_ns: int = 0


class Authority(StrEnum):
    """Whose word on an object holds when renderer and room do not agree."""

    SERVER = "server"
    RENDERER = "renderer"


@dataclass(frozen=True, slots=True)
class Difference:
    """An object on which the renderer and the room do not agree.

    Attributes:
        object: Its name.
        renderer: State that the renderer shows.
        server: State that the room has; empty for an object that it has not.
        kept: Whose state holds.
    """

    object: str
    renderer: str
    server: str
    kept: Authority
