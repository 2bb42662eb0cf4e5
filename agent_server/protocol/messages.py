"""Every message of protocol 1, as msgspec types.

A message is a map with a ``type`` tag. Unknown fields are ignored, so that a minor version
may add some. Time stamps are integer nanoseconds; positions are metres in the camera frame
unless a skeleton's format says otherwise; valence and arousal lie in [-10, 10].
"""

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from agent_server.domain.affect import AFFECT_LIMIT
from agent_server.domain.stamp import MAX_STAMP_NS

PROTOCOL = "1.0"
PROTOCOL_MAJOR = 1
SUBPROTOCOL_JSON = "agent-server.v1.json"
SUBPROTOCOL_MSGPACK = "agent-server.v1.msgpack"

Role = Literal["sensor", "renderer", "monitor"]
Face = Literal["expected", "none", "gaze"]
FaceFormat = Literal["mesh478", "mesh468", "dlib68"]
Topic = Literal[
    "pose",
    "forecast",
    "affect",
    "calibration",
    "decision",
    "command",
    "ack",
    "scene",
    "stats",
    "error",
]
Nanoseconds = Annotated[int, Meta(ge=0, le=MAX_STAMP_NS)]
Level = Annotated[float, Meta(ge=-AFFECT_LIMIT, le=AFFECT_LIMIT)]
Name = Annotated[str, Meta(min_length=1, max_length=64)]
Text = Annotated[str, Meta(max_length=500)]
Point = tuple[float, float, float]
JointSample = tuple[float, float, float, float]


class Message(msgspec.Struct, frozen=True, omit_defaults=True, tag_field="type"):
    """Base of all messages."""


# --------------------------------------------------------------------------- both ways


class Ping(Message, frozen=True, tag="ping"):
    """Asks for a pong with the same ``sent_ns``."""

    sent_ns: Nanoseconds


class Pong(Message, frozen=True, tag="pong"):
    """Answers a ping. ``time_ns`` is the answering side's own monotonic clock."""

    sent_ns: Nanoseconds
    time_ns: Nanoseconds


# --------------------------------------------------------------------------- client to server


class Hello(Message, frozen=True, tag="hello"):
    """First message on every connection.

    ``face`` is what a sensor knows of the face: ``expected`` when a face or affect follows,
    ``none`` for a headset that hides it, ``gaze`` for one that tells where the person looks.
    ``topics`` are the kinds of telemetry that a monitor wants, all if null. ``time`` is wall
    time in ISO 8601, for people.
    """

    protocol: Annotated[str, Meta(pattern=r"^[0-9]{1,4}\.[0-9]{1,4}$")]
    client: Name
    client_version: Annotated[str, Meta(max_length=64)] = ""
    token: Annotated[str, Meta(max_length=4096)] | None = None
    face: Face = "expected"
    mirror: bool = False
    take_over: bool = False
    topics: Annotated[list[Topic], Meta(max_length=16)] | None = None
    time: Annotated[str, Meta(max_length=64)] | None = None


class Skeleton(Message, frozen=True, tag="skeleton"):
    """One body at one instant (JSON coding)."""

    originating_ns: Nanoseconds
    body_id: Annotated[int, Meta(ge=0, le=MAX_STAMP_NS)]
    format: Name
    joints: Annotated[list[JointSample], Meta(max_length=64)]


class PackedSkeleton(Message, frozen=True, tag="skeleton"):
    """One body at one instant (MessagePack coding).

    ``joints`` holds x, y, z, confidence of every joint as little-endian float32.
    """

    originating_ns: Nanoseconds
    body_id: Annotated[int, Meta(ge=0, le=MAX_STAMP_NS)]
    format: Name
    joints: Annotated[bytes, Meta(max_length=64 * 16)]


class Affect(Message, frozen=True, tag="affect"):
    """One estimate of the person's affect."""

    originating_ns: Nanoseconds
    valence: Level
    arousal: Level


class FacePoints(Message, frozen=True, tag="face"):
    """The landmarks of one face at one instant (JSON coding).

    Each point is x, y in pixels of the image, x to the right and y down; a mesh has the depth
    too, in the same unit, smaller towards the camera. ``dlib68`` is the order of dlib and iBUG.
    """

    originating_ns: Nanoseconds
    format: FaceFormat
    width: Annotated[int, Meta(ge=16, le=8192)]
    height: Annotated[int, Meta(ge=16, le=8192)]
    points: Annotated[list[list[float]], Meta(max_length=478)]


class PackedFacePoints(Message, frozen=True, tag="face"):
    """The landmarks of one face at one instant (MessagePack coding).

    ``points`` holds x, y and, of a mesh, z of every point as little-endian float32.
    """

    originating_ns: Nanoseconds
    format: FaceFormat
    width: Annotated[int, Meta(ge=16, le=8192)]
    height: Annotated[int, Meta(ge=16, le=8192)]
    points: Annotated[bytes, Meta(max_length=478 * 12)]


class Blendshapes(Message, frozen=True, tag="blendshapes"):
    """The expression of one face at one instant, by ARKit's names, each in [0, 1]."""

    originating_ns: Nanoseconds
    values: Annotated[dict[str, float], Meta(max_length=80)]


class Image(Message, frozen=True, tag="image"):
    """One frame of a camera that sees the face, as JPEG.

    In the JSON coding it is a binary frame: the four bytes ``AFJ1``, four bytes of flags (0),
    ``originating_ns`` in eight, both little-endian, and the JPEG.
    """

    originating_ns: Nanoseconds
    jpeg: bytes


class Gaze(Message, frozen=True, tag="gaze"):
    """Where the person looks: a ray in metres, in the frame of the skeletons."""

    originating_ns: Nanoseconds
    origin: Point
    direction: Point


class Calibrate(Message, frozen=True, tag="calibrate"):
    """Makes the person's neutral face the zero of valence and arousal.

    Either the face is neutral for the next ``seconds``, or ``valence`` and ``arousal`` are
    what an earlier calibration of this person found.
    """

    originating_ns: Nanoseconds
    seconds: Annotated[float, Meta(gt=0, le=30)] | None = None
    valence: Level | None = None
    arousal: Level | None = None


class AckMessage(Message, frozen=True, tag="ack"):
    """A renderer's word on a command."""

    command_id: Annotated[str, Meta(min_length=1, max_length=160)]
    status: Literal["accepted", "started", "progress", "done", "failed"]
    step: Annotated[int, Meta(ge=0, le=1000)] | None = None
    reason: Text | None = None


class SceneEvent(Message, frozen=True, tag="scene_event"):
    """Somebody changed an object of the room by hand."""

    object: Name
    state: Name


# --------------------------------------------------------------------------- server to client


class ModelInfo(msgspec.Struct, frozen=True):
    """A model in use."""

    name: str
    task: str
    sha256: str


class GateLevels(msgspec.Struct, frozen=True):
    """Thresholds of the affect gate, so that a client can draw them."""

    mode: str
    enter_valence: float
    enter_arousal: float
    leave_valence: float
    leave_arousal: float


class DecideLevels(msgspec.Struct, frozen=True):
    """Probabilities at which gestures start, by label, and end, so that a client can draw them."""

    enter: dict[str, float]
    leave: float


class Limits(msgspec.Struct, frozen=True):
    """What the server takes from a client."""

    max_message_bytes: int
    max_image_bytes: int
    max_errors: int


class SceneState(Message, frozen=True, tag="scene"):
    """The room: the agent's mode, each object's state, the command being carried out."""

    mode: str
    objects: dict[str, str]
    command_id: str | None = None


class Welcome(Message, frozen=True, tag="welcome"):
    """Answers hello when the client may stay."""

    protocol: str
    server: str
    server_version: str
    session: str
    role: Role
    epoch: str
    sequence: int
    heartbeat_s: float
    labels: list[str]
    gate: GateLevels
    decide: DecideLevels
    limits: Limits
    models: list[ModelInfo]
    scene: SceneState


class ErrorMessage(Message, frozen=True, tag="error"):
    """Something the client sent was refused. ``fatal`` announces that the connection closes."""

    code: str
    message: str
    field: str | None = None
    fatal: bool = False


class StepMessage(msgspec.Struct, frozen=True, omit_defaults=True):
    """One action of a reaction; ``duration_s`` is nominal."""

    action: str
    duration_s: float
    target: str | None = None


class CommandMessage(Message, frozen=True, tag="command"):
    """An order to the renderer. The same ``id`` is carried out once."""

    id: str
    sequence: int
    epoch: str
    reaction: str
    cause: str
    steps: list[StepMessage]
    priority: int
    originating_ns: int
    issued_ns: int
    ttl_ms: int
    preempts: str | None = None


class PoseMessage(Message, frozen=True, tag="pose"):
    """Telemetry: the nine core joints as observed, at 25 Hz; each is x, y, z, confidence."""

    originating_ns: int
    body_id: int
    joints: list[JointSample]


class ForecastMessage(Message, frozen=True, tag="forecast"):
    """Telemetry: the expected motion after a window, 50 frames of nine points at 25 Hz."""

    window: int
    originating_ns: int
    source: str
    positions: list[list[Point]]


class AffectTelemetry(Message, frozen=True, tag="affect_state"):
    """Telemetry: the affect that the gate goes by.

    ``source`` is ``client`` for affect that came in as such, else what it was estimated from:
    ``mesh``, ``points68`` or ``blendshapes``; an estimate has standard deviations, and an
    average over the last second lags behind the face by ``delay_ms``.
    """

    originating_ns: int
    valence: float
    arousal: float
    valence_sd: float | None = None
    arousal_sd: float | None = None
    source: str = "client"
    delay_ms: float | None = None


class CalibrationState(Message, frozen=True, tag="calibration_state"):
    """Telemetry, and the answer to ``calibrate``: what the person's neutral face is held to be.

    ``is_done`` is false when too few faces were seen; what was in force is in force still.
    """

    valence: float
    arousal: float
    faces: int
    is_done: bool


class AckTelemetry(Message, frozen=True, tag="ack_state"):
    """Telemetry: what the renderer said of a command."""

    command_id: str
    status: str
    step: int | None = None
    reason: str | None = None


class QualityBody(msgspec.Struct, frozen=True):
    """How far the window could be trusted."""

    measured: float
    filled: float
    bone_deviation: float
    warnings: list[str]


class GateBody(msgspec.Struct, frozen=True, omit_defaults=True):
    """What the affect gate said; numbers are null without a usable face, or gaze.

    ``face`` is ``paired``, ``skewed``, ``stale``, ``missing`` or ``not_needed``.
    """

    mode: str
    is_open: bool
    reason: str
    valence: float | None
    arousal: float | None
    age_ms: float | None
    face: str | None = None
    source: str | None = None
    gaze_deg: float | None = None


class SceneBody(msgspec.Struct, frozen=True):
    """What the room said to the gesture."""

    mode: str
    rule: str | None
    precondition: str | None
    met: bool
    reason: str


class CommandBody(msgspec.Struct, frozen=True):
    """The command in a decision, without what only its delivery knows."""

    id: str
    sequence: int
    reaction: str
    cause: str
    steps: list[StepMessage]
    priority: int
    preempts: str | None
    originating_ns: int
    issued_ns: int
    ttl_ms: int


class DecisionBody(msgspec.Struct, frozen=True):
    """A decision with its reasons. Deterministic: the line of a decision log."""

    id: str
    index: int
    window: int
    start_ns: int
    end_ns: int
    body_id: int
    models: dict[str, str]
    quality: QualityBody
    forecast: str
    forecast_failure: str | None
    probabilities: dict[str, float]
    gesture: str
    gate: GateBody
    scene: SceneBody | None
    outcome: str
    reason: str
    command: CommandBody | None


class Timing(msgspec.Struct, frozen=True):
    """Where the time of one decision went, in milliseconds, and when it was made."""

    wall: str
    wait_ms: float
    predict_ms: float
    classify_ms: float
    decide_ms: float
    total_ms: float


class DecisionMessage(Message, frozen=True, tag="decision"):
    """Telemetry: one decision and its timing."""

    decision: DecisionBody
    timing: Timing


class StatsMessage(Message, frozen=True, tag="stats"):
    """Telemetry: the session's counters since its start."""

    frames: int
    windows: int
    decisions: int
    commands: int
    skipped_windows: int
    predictor_failures: int
    rejected_messages: int
    missed_telemetry: int
    counters: dict[str, int]


_Common = Hello | Ping | Pong | Affect | Blendshapes | Gaze | Calibrate | AckMessage | SceneEvent
ClientMessage = _Common | Skeleton | FacePoints
PackedClientMessage = _Common | PackedSkeleton | PackedFacePoints | Image
ServerMessage = (
    Welcome
    | ErrorMessage
    | Ping
    | Pong
    | CommandMessage
    | SceneState
    | PoseMessage
    | ForecastMessage
    | AffectTelemetry
    | CalibrationState
    | AckTelemetry
    | DecisionMessage
    | StatsMessage
)
