"""What a rule file says, once it has been checked."""

from collections.abc import Mapping
from dataclasses import dataclass

from agent_server.domain.command import Motion, Step
from agent_server.domain.scene import AgentMode, Authority

RESUME_WORK = "resume_work"
"""The reaction that every rule file must have: it is sent when attention ends."""


@dataclass(frozen=True, slots=True)
class SceneObject:
    """A thing in the room.

    Attributes:
        name: For example ``window``.
        states: States that it may be in; empty for a thing that never changes.
        initial: State at the start of a session, or None for a thing that never changes.
        authority: Whose word holds when a renderer comes that shows another state.
    """

    name: str
    states: tuple[str, ...]
    initial: str | None
    authority: Authority = Authority.SERVER


@dataclass(frozen=True, slots=True)
class StepKind:
    """A word of the vocabulary that reactions are written in.

    Attributes:
        name: For example ``walk_to``.
        duration_s: Nominal time that it takes, in seconds.
        has_target: Whether it is done to an object.
    """

    name: str
    duration_s: float
    has_target: bool


@dataclass(frozen=True, slots=True)
class Condition:
    """A state that an object must be in."""

    object: str
    state: str

    def __str__(self) -> str:
        return f"{self.object} = {self.state}"


@dataclass(frozen=True, slots=True)
class Reaction:
    """Something that the agent can do.

    Attributes:
        name: For example ``close_window``.
        steps: What it does, in order; never empty.
        effects: States that hold once it is done.
        priority: A reaction cuts short a running one of lower priority.
        ttl_ms: For how long its command is worth starting.
    """

    name: str
    steps: tuple[Step, ...]
    effects: tuple[Condition, ...]
    priority: int
    ttl_ms: int


@dataclass(frozen=True, slots=True)
class Rule:
    """When a gesture makes the agent react, and how.

    Attributes:
        gesture: The gesture that asks for it.
        when: States that must all hold; empty if it always applies.
        reaction: What follows.
        preempts: Names of running reactions that it cuts short whatever their priority.
        motion: How the agent moves in it.
    """

    gesture: str
    when: tuple[Condition, ...]
    reaction: Reaction
    preempts: frozenset[str]
    motion: Motion = Motion.AUTHORED

    @property
    def name(self) -> str:
        """For explanations, for example ``cold -> close_window``."""
        return f"{self.gesture} -> {self.reaction.name}"

    @property
    def precondition(self) -> str | None:
        """For explanations, for example ``window = open``; None if the rule always applies."""
        return " and ".join(map(str, self.when)) or None


@dataclass(frozen=True, slots=True)
class IdleBehaviour:
    """Something that the agent does of its own accord; a renderer plays it, no command is sent.

    Attributes:
        step: What it does; the duration is nominal.
        weight: How often, relative to the mode's other behaviours.
    """

    step: Step
    weight: float


@dataclass(frozen=True, slots=True)
class Rules:
    """A whole rule file.

    Attributes:
        attention_s: Time from the last gesture to the end of attention, in seconds.
        ungated: Gestures that need no uncomfortable face.
        objects: Everything in the room, by name.
        reactions: Everything that the agent can do, by name.
        rules: The rules of each gesture in the order of the file; the first that holds applies.
        idle: What the agent does unasked while it works and while it attends.
    """

    attention_s: float
    ungated: frozenset[str]
    objects: Mapping[str, SceneObject]
    reactions: Mapping[str, Reaction]
    rules: Mapping[str, tuple[Rule, ...]]
    idle: Mapping[AgentMode, tuple[IdleBehaviour, ...]]

    def is_gated(self, gesture: str) -> bool:
        """Whether the affect gate must be open for this gesture."""
        return gesture not in self.ungated
