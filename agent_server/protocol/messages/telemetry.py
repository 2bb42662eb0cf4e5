"""What the server tells monitors. It may be lost: of each kind only the latest message waits."""

from typing import Annotated

from msgspec import Meta

from agent_server.protocol.messages.fields import (
    ONE,
    UNIT,
    CommandId,
    Count,
    Deviation,
    Identity,
    JointSample,
    Label,
    Level,
    Message,
    Milliseconds,
    Motion,
    Name,
    Nanoseconds,
    Part,
    Point,
    Ratio,
    Role,
    told,
)
from agent_server.protocol.messages.server import StepMessage

SignedMilliseconds = Annotated[float, Meta(ge=-1e13, le=1e13, extra_json_schema={UNIT: "ms"})]
Degrees = Annotated[float, Meta(ge=0, le=180, extra_json_schema={UNIT: "deg"})]


class PoseMessage(Message, frozen=True, tag="pose"):
    """The nine core joints as observed, at 25 Hz."""

    originating_ns: Annotated[Nanoseconds, told("Capture time.")]
    body_id: Annotated[Identity, told("Whose body it is.")]
    joints: Annotated[
        list[JointSample], told("x, y, z and confidence of each core joint, in the camera frame.")
    ]


class FutureBody(Part, frozen=True):
    """One of several futures that are drawn beside the forecast."""

    quality: Annotated[Ratio, told("How probably it is a real motion.")]
    positions: Annotated[
        list[list[Point]],
        told(
            "10 frames at 5 Hz of the nine core joints' x, y, z, in the camera frame; the first "
            "is 0.2 s after the window."
        ),
    ]


class ForecastMessage(Message, frozen=True, tag="forecast"):
    """The motion that is expected after a window."""

    window: Annotated[Count, told("Index of the window.")]
    originating_ns: Annotated[Nanoseconds, told("Capture time of the window's last frame.")]
    source: Annotated[Label, told("Bundle that made it, or `last_frame` where it failed.")]
    positions: Annotated[
        list[list[Point]],
        told("50 frames at 25 Hz of the nine core joints' x, y, z, in the camera frame."),
    ]
    futures: Annotated[
        list[FutureBody],
        told("What else may follow, where several futures are drawn; none of low quality."),
    ] = []  # noqa: RUF012 - msgspec copies it


class AffectTelemetry(Message, frozen=True, tag="affect_state"):
    """The affect that the gate goes by."""

    originating_ns: Annotated[Nanoseconds, told("Capture time of the face.")]
    valence: Annotated[Level, told("From unpleasant to pleasant.")]
    arousal: Annotated[Level, told("From calm to excited.")]
    valence_sd: Annotated[Deviation, told("Standard deviation of an estimate.")] | None = None
    arousal_sd: Annotated[Deviation, told("Standard deviation of an estimate.")] | None = None
    source: Annotated[
        Label,
        told(
            "`client` for affect that came in as such, else what it was estimated from: `mesh`, "
            "`points68` or `blendshapes`."
        ),
    ] = "client"
    delay_ms: Annotated[Milliseconds, told("How far an average lags behind the face.")] | None = (
        None
    )


class CalibrationState(Message, frozen=True, tag="calibration_state"):
    """What the person's neutral face is held to be; also the answer to ``calibrate``."""

    valence: Annotated[Level, told("Valence of the neutral face.")]
    arousal: Annotated[Level, told("Arousal of the neutral face.")]
    faces: Annotated[Count, told("Faces that were seen for it.")]
    is_done: Annotated[
        bool, told("False when too few faces were seen; what was in force still is.")
    ]


class AckTelemetry(Message, frozen=True, tag="ack_state"):
    """What became of a command.

    Besides the renderer's own words the server says how a command ended: ``expired``,
    ``preempted``, ``timed_out`` (the renderer fell silent) or ``assumed`` (done by its nominal
    time, since nobody carried it out).
    """

    command_id: Annotated[CommandId, told("Which command.")]
    status: Annotated[Name, told("A status of `ack`, or how the server ended it.")]
    step: Annotated[int, told("Index of the step that has ended.", ONE, ge=0, le=1000)] | None = (
        None
    )
    reason: Annotated[str, told("Why it failed.")] | None = None


class QualityBody(Part, frozen=True):
    """How far the window could be trusted."""

    measured: Annotated[Ratio, told("Share of joint samples that were tracked.")]
    filled: Annotated[Ratio, told("Share of joint samples that repeat a last known position.")]
    bone_deviation: Annotated[
        float, told("Largest relative deviation of a bone's length.", ONE, ge=0, le=1e6)
    ]
    warnings: Annotated[list[str], told("Names of what looks wrong.")]


class GateBody(Part, frozen=True, omit_defaults=True):
    """What the affect gate said; numbers are null without a usable face, or gaze."""

    mode: Annotated[Label, told("`required`, `optional`, `off`, `thesis` or `gaze`.")]
    is_open: Annotated[bool, told("Whether a discomfort may pass.")]
    reason: Annotated[str, told("Why, in a few words.")]
    valence: Annotated[Level, told("Of the face that was used.")] | None
    arousal: Annotated[Level, told("Of the face that was used.")] | None
    age_ms: (
        Annotated[
            SignedMilliseconds,
            told("Time from the face, or gaze, to the end of the window; negative if newer."),
        ]
        | None
    )
    face: (
        Annotated[Label, told("`paired`, `skewed`, `stale`, `missing` or `not_needed`.")] | None
    ) = None
    source: Annotated[Label, told("What valence and arousal come from.")] | None = None
    gaze_deg: Annotated[Degrees, told("Angle from the gaze to the agent.")] | None = None


class SceneBody(Part, frozen=True):
    """What the room said to the gesture."""

    mode: Annotated[Label, told("What the agent was doing.")]
    rule: Annotated[str, told("The rule, for example `cold -> close_window`.")] | None
    precondition: Annotated[str, told("What must hold for it.")] | None
    met: Annotated[bool, told("Whether it held.")]
    reason: Annotated[str, told("Why, in a few words.")]


class CommandBody(Part, frozen=True, omit_defaults=True):
    """The command in a decision, without what only its delivery knows."""

    id: Annotated[CommandId, told("Identity.")]
    sequence: Annotated[Count, told("Counts the commands of a ledger from 1.")]
    reaction: Annotated[Name, told("Name of the reaction.")]
    cause: Annotated[Name, told("Gesture or event that caused it.")]
    steps: Annotated[list[StepMessage], told("What to do, in order.")]
    priority: Annotated[int, told("Higher goes first.", ONE, ge=0, le=1000)]
    preempts: Annotated[CommandId, told("Command that is cut short by this one.")] | None
    originating_ns: Annotated[Nanoseconds, told("Capture time of the last frame that led to it.")]
    issued_ns: Annotated[Nanoseconds, told("When it was issued, on the session's time line.")]
    ttl_ms: Annotated[
        int,
        told("It is not to be started later than this after it was issued.", "ms", ge=0, le=10**12),
    ]
    motion: Annotated[Motion, told("How the agent moves: as authored, or generated.")] = "authored"


class FuturesBody(Part, frozen=True):
    """How far several futures of the window disagree."""

    classified: Annotated[Count, told("Futures that were classified, the forecast among them.")]
    left_out: Annotated[Count, told("Drawn futures that were left out for their quality.")]
    spread: Annotated[
        dict[str, Ratio],
        told("Standard deviation of each gesture's probability over the futures."),
    ]


class DecisionBody(Part, frozen=True, omit_defaults=True):
    """A decision with its reasons. Deterministic: the line of a decision log."""

    id: Annotated[CommandId, told("Identity: session and index.")]
    index: Annotated[Count, told("Counts the session's decisions from 0.")]
    window: Annotated[Count, told("Index of the window.")]
    start_ns: Annotated[Nanoseconds, told("Capture time of the window's first frame.")]
    end_ns: Annotated[Nanoseconds, told("Capture time of the window's last frame.")]
    body_id: Annotated[Identity, told("Whose motion it is.")]
    models: Annotated[dict[str, str], told("Hash of each model that took part, by its name.")]
    quality: Annotated[QualityBody, told("How far the window could be trusted.")]
    forecast: Annotated[Label, told("Bundle that made the forecast, or `last_frame`.")]
    forecast_failure: Annotated[str, told("Why the predictor could not be used.")] | None
    probabilities: Annotated[
        dict[str, Ratio], told("Probability of each gesture, over several futures their mean.")
    ]
    gesture: Annotated[Name, told("What is held to be going on.")]
    gate: Annotated[GateBody, told("What the affect gate said.")]
    scene: Annotated[SceneBody, told("What the room said, if it was asked.")] | None
    outcome: Annotated[
        Label,
        told(
            "`command`, `idle`, `unsure`, `cooling_down`, `handled`, `gated`, `busy` or "
            "`nothing_to_do`."
        ),
    ]
    reason: Annotated[str, told("Why, in a sentence.")]
    command: Annotated[CommandBody, told("The command that follows.")] | None
    futures: (
        Annotated[FuturesBody, told("How far several futures disagree; absent for one.")] | None
    ) = None


class Timing(Part, frozen=True):
    """Where the time of one decision went, and when it was made."""

    wall: Annotated[Label, told("Wall time in ISO 8601.")]
    wait_ms: Annotated[Milliseconds, told("From the last frame's arrival to the models' start.")]
    predict_ms: Annotated[Milliseconds, told("The predictor.")]
    classify_ms: Annotated[Milliseconds, told("The classifier.")]
    decide_ms: Annotated[Milliseconds, told("Gate, decision and room.")]
    total_ms: Annotated[Milliseconds, told("From the last frame's arrival to the decision.")]


class DecisionMessage(Message, frozen=True, tag="decision"):
    """One decision and its timing."""

    decision: Annotated[DecisionBody, told("The decision with its reasons.")]
    timing: Annotated[Timing, told("Where its time went.")]


class ClientStats(Part, frozen=True):
    """One connection of the session."""

    role: Annotated[Role, told("What it came as.")]
    client: Annotated[Name, told("What it calls itself.")]
    round_trip_ms: (
        Annotated[Milliseconds, told("Round trip of its pings, smoothed; null before the first.")]
        | None
    )
    offset_ms: (
        Annotated[
            SignedMilliseconds,
            told("Its clock less the server's, smoothed; null before the first ping."),
        ]
        | None
    )
    missed: Annotated[Count, told("Telemetry that it was too slow for.")]


class ForecastScoreBody(Part, frozen=True):
    """How good the forecasts were whose two seconds have come within the last minute."""

    error_mm: Annotated[float, told("Mean distance of the joints.", "mm", ge=0, le=1e6)]
    zero_velocity_mm: Annotated[
        float, told("The same for a body that stands still from then on.", "mm", ge=0, le=1e6)
    ]
    forecasts: Annotated[Count, told("How many were scored.")]


class StatsMessage(Message, frozen=True, tag="stats"):
    """The session's counters since its start."""

    frames: Annotated[Count, told("Skeleton frames taken.")]
    windows: Annotated[Count, told("Windows made of them.")]
    decisions: Annotated[Count, told("Decisions made.")]
    commands: Annotated[Count, told("Commands issued.")]
    skipped_windows: Annotated[Count, told("Windows whose place a newer one took.")]
    predictor_failures: Annotated[Count, told("Windows whose forecast failed.")]
    rejected_messages: Annotated[Count, told("Messages that were refused.")]
    missed_telemetry: Annotated[Count, told("Telemetry that monitors were too slow for.")]
    counters: Annotated[dict[str, Count], told("Everything else that is counted, by its name.")]
    clients: Annotated[list[ClientStats], told("The session's connections.")] = []  # noqa: RUF012
    forecast_score: (
        Annotated[ForecastScoreBody, told("How good the forecasts of the last minute were.")] | None
    ) = None
