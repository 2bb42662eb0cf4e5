"""The explanation of one decision, those that did nothing too.

The body is deterministic: it holds nothing that a clock or a random source gave, so that a
replay of the same input writes the same bytes.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

from agent_server.domain.command import Command
from agent_server.domain.gesture import Spread
from agent_server.domain.motion import Quality


class Outcome(StrEnum):
    """What a decision came to."""

    COMMAND = "command"
    IDLE = "idle"
    UNSURE = "unsure"
    COOLING_DOWN = "cooling_down"
    HANDLED = "handled"
    GATED = "gated"
    BUSY = "busy"
    NOTHING_TO_DO = "nothing_to_do"


class FacePairing(StrEnum):
    """How the face goes with the window, by the time of its capture."""

    PAIRED = "paired"
    SKEWED = "skewed"
    STALE = "stale"
    MISSING = "missing"
    NOT_NEEDED = "not_needed"


@dataclass(frozen=True, slots=True)
class GateVerdict:
    """What the affect gate said.

    Attributes:
        mode: ``required``, ``optional``, ``off``, ``thesis`` or ``gaze``.
        is_open: Whether a discomfort gesture may pass.
        reason: Why, in a few words.
        face: How the face goes with the window.
        valence: In [-10, 10], or None without a usable face.
        arousal: In [-10, 10], or None without a usable face.
        age_ms: Time from the face, or gaze, to the end of the window, negative for a newer one;
            None where there is none.
        source: What valence and arousal come from, or None without a usable face.
        gaze_deg: Angle between the gaze and the way to the agent, or None without a usable gaze.
    """

    mode: str
    is_open: bool
    reason: str
    face: FacePairing
    valence: float | None = None
    arousal: float | None = None
    age_ms: float | None = None
    source: str | None = None
    gaze_deg: float | None = None


@dataclass(frozen=True, slots=True)
class SceneVerdict:
    """What the room had to say to a gesture.

    Attributes:
        mode: What the agent was doing.
        rule: Name of the rule that matched, or None.
        precondition: The rule's precondition, for example ``window = open``, or None.
        met: Whether it held.
        reason: Why, in a few words.
    """

    mode: str
    rule: str | None
    precondition: str | None
    met: bool
    reason: str


@dataclass(frozen=True, slots=True)
class Decision:
    """One decision and everything that led to it.

    Attributes:
        id: Session id and counter.
        index: Counts the session's decisions from 0.
        window: Index of the window.
        start_ns: Capture time of the window's first frame.
        end_ns: Capture time of the window's last frame.
        body_id: Whose motion it was.
        models: Bundle name -> first 12 hexadecimal digits of its hash.
        quality: How far the window could be trusted.
        forecast: Name of the predictor, or ``last_frame``.
        forecast_failure: Why the predictor was not used, or None.
        probabilities: Label -> probability.
        gesture: The gesture that is held to be going on, ``idle`` if none.
        gate: What the affect gate said.
        scene: What the room said, or None when it was not asked.
        outcome: What it came to.
        reason: One sentence for people.
        command: The command, or None.
        spread: How far several futures disagree, or None where there is the forecast alone.
    """

    id: str
    index: int
    window: int
    start_ns: int
    end_ns: int
    body_id: int
    models: Mapping[str, str]
    quality: Quality
    forecast: str
    forecast_failure: str | None
    probabilities: Mapping[str, float]
    gesture: str
    gate: GateVerdict
    scene: SceneVerdict | None
    outcome: Outcome
    reason: str
    command: Command | None
    spread: Spread | None = None
