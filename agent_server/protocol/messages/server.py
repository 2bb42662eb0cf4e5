"""What the server sends to a client about its connection and what it is to do."""

from typing import Annotated

from agent_server.protocol.messages.fields import (
    COUNT,
    ONE,
    Authority,
    CommandId,
    Count,
    Epoch,
    Label,
    Level,
    Message,
    Motion,
    Name,
    Nanoseconds,
    Part,
    Point,
    Ratio,
    Role,
    Seconds,
    Sha256,
    Version,
    told,
)


class ModelInfo(Part, frozen=True):
    """A model in use."""

    name: Annotated[Name, told("Name of the bundle.")]
    task: Annotated[Label, told("What it is used for.")]
    sha256: Annotated[Sha256, told("Hash of its weights, in hexadecimal.")]


class GateLevels(Part, frozen=True):
    """Thresholds of the affect gate, so that a client can draw them."""

    mode: Annotated[Label, told("`required`, `optional`, `off`, `thesis` or `gaze`.")]
    enter_valence: Annotated[Level, told("It opens below this valence ...")]
    enter_arousal: Annotated[Level, told("... and above this size of arousal.")]
    leave_valence: Annotated[Level, told("It closes above this valence ...")]
    leave_arousal: Annotated[Level, told("... or below this size of arousal.")]


class DecideLevels(Part, frozen=True):
    """Probabilities at which gestures start and end, so that a client can draw them."""

    enter: Annotated[dict[str, Ratio], told("Where each gesture starts to count, by its label.")]
    leave: Annotated[Ratio, told("Where one that is going on ends.")]


class Limits(Part, frozen=True):
    """What the server takes from a client."""

    max_message_bytes: Annotated[Count, told("Longest message, in bytes.", "byte")]
    max_image_bytes: Annotated[Count, told("Longest image, in bytes.", "byte")]
    max_errors: Annotated[Count, told("Bad messages that may be open at once.")]


class SceneState(Message, frozen=True, tag="scene"):
    """The room."""

    mode: Annotated[Label, told("What the agent does: `working`, `attention` or `reacting`.")]
    objects: Annotated[dict[str, str], told("State of every object that has any, by its name.")]
    command_id: Annotated[CommandId, told("The command that is being carried out.")] | None = None


class Difference(Part, frozen=True):
    """An object on which renderer and server did not agree when the renderer came."""

    object: Annotated[str, told("Name of the object.")]
    renderer: Annotated[str, told("State that the renderer showed.")]
    server: Annotated[str, told("State that the server had; empty for an object it has not.")]
    kept: Annotated[Authority, told("Whose state holds now; the rule file says so.")]


class Welcome(Message, frozen=True, tag="welcome"):
    """Answers hello when the client may stay."""

    protocol: Annotated[Version, told("Version that the server speaks.")]
    server: Annotated[Name, told("What the server is called.")]
    server_version: Annotated[Label, told("Version of the server.")]
    session: Annotated[Name, told("Session of this connection.")]
    role: Annotated[Role, told("Role of this connection.")]
    epoch: Annotated[Epoch, told("Changes whenever the session is opened, after a restart too.")]
    ledger: Annotated[
        Epoch,
        told(
            "Within one ledger an id means one command for good, over restarts too. A client that "
            "knew another one forgets the commands of that one."
        ),
    ]
    resumed: Annotated[bool, told("Whether hello named this ledger.")]
    sequence: Annotated[Count, told("Sequence of the last command, 0 before the first.")]
    heartbeat_s: Annotated[
        Seconds,
        told("How often either side pings; one that hears nothing for 2.5 of these may leave."),
    ]
    labels: Annotated[list[str], told("Gestures that the classifier tells apart.")]
    gate: Annotated[GateLevels, told("Thresholds of the affect gate.")]
    decide: Annotated[DecideLevels, told("Thresholds of the decision.")]
    limits: Annotated[Limits, told("What the server takes.")]
    models: Annotated[list[ModelInfo], told("Models in use.")]
    scene: Annotated[SceneState, told("The room, after differences were settled.")]
    differences: Annotated[
        list[Difference], told("On what the renderer's `objects` and the room did not agree.")
    ] = []  # noqa: RUF012 - msgspec copies it


class ErrorMessage(Message, frozen=True, tag="error"):
    """Something that the client sent was refused, or something went wrong."""

    code: Annotated[Name, told("Name of the mistake; docs/protocol.md lists them.")]
    message: Annotated[str, told("What was expected, what was got, and what to do.")]
    field: Annotated[str, told("Path of the field, for example `joints[3][1]`.")] | None = None
    fatal: Annotated[bool, told("Whether the connection closes now.")] = False


class StepMessage(Part, frozen=True, omit_defaults=True):
    """One action of a reaction."""

    action: Annotated[Name, told("What to do, a step of the rule file.")]
    duration_s: Annotated[Seconds, told("Nominal time that it takes.")]
    target: Annotated[Name, told("Object that it is done to.")] | None = None


class CommandMessage(Message, frozen=True, tag="command"):
    """An order to the renderer, carried out once whatever happens to the connection."""

    id: Annotated[CommandId, told("Identity: the same id is carried out once.")]
    sequence: Annotated[Count, told("Counts the commands of a ledger from 1.")]
    epoch: Annotated[Epoch, told("Epoch in which it is sent.")]
    reaction: Annotated[Name, told("Name of the reaction, for example `close_window`.")]
    cause: Annotated[Name, told("Gesture or event that caused it.")]
    steps: Annotated[list[StepMessage], told("What to do, in order.")]
    priority: Annotated[int, told("Higher goes first.", ONE, ge=0, le=1000)]
    originating_ns: Annotated[Nanoseconds, told("Capture time of the last frame that led to it.")]
    issued_ns: Annotated[Nanoseconds, told("When it was issued, on the session's time line.")]
    ttl_ms: Annotated[
        int,
        told("It is not to be started later than this after it was issued.", "ms", ge=0, le=10**12),
    ]
    preempts: Annotated[CommandId, told("Command that is cut short by this one.")] | None = None
    age_ms: Annotated[
        int, told("Time since it was issued, when it is sent again.", "ms", ge=0, le=10**12)
    ] = 0
    server_ns: Annotated[
        Nanoseconds, told("The server's monotonic clock when it was decided, as in pongs.")
    ] = 0
    motion: Annotated[
        Motion,
        told(
            "`generated`: for a renderer with the capability `pose_stream` a motion follows that "
            "is made while it plays; until it comes, and after it, the steps look as authored."
        ),
    ] = "authored"


class PoseStreamMessage(Message, frozen=True, tag="pose_stream"):
    """A stretch of a generated motion for the agent to play (JSON coding).

    A renderer without the capability ``pose_stream`` never gets one. Frames of a command come in
    order and without gaps; where one is missing, nothing more is to be played. The authored motion
    stands in before the first stretch, after the last, and where none comes.
    """

    command_id: Annotated[CommandId, told("Command that the motion belongs to.")]
    first_frame: Annotated[int, told("Index of the first frame.", COUNT, ge=0, le=10**9)]
    rate_hz: Annotated[float, told("Frames a second.", "Hz", gt=0, le=240)]
    joints: Annotated[list[Name], told("Names of the joints, in order.", max_length=64)]
    positions: Annotated[
        list[list[Point]],
        told(
            "Every joint's x, y, z in each frame; right-handed, y up, z forward out of the agent, "
            "origin on the floor below its hips at the command's start.",
            max_length=250,
        ),
    ]
    is_last: Annotated[bool, told("Whether the motion ends with this stretch.")] = False
    fallback: (
        Annotated[str, told("Why nothing more of it is good: the authored motion stands in.")]
        | None
    ) = None


class PackedPoseStreamMessage(Message, frozen=True, tag="pose_stream"):
    """A stretch of a generated motion for the agent to play (MessagePack coding)."""

    command_id: Annotated[CommandId, told("Command that the motion belongs to.")]
    first_frame: Annotated[int, told("Index of the first frame.", COUNT, ge=0, le=10**9)]
    rate_hz: Annotated[float, told("Frames a second.", "Hz", gt=0, le=240)]
    joints: Annotated[list[Name], told("Names of the joints, in order.", max_length=64)]
    positions: Annotated[
        bytes,
        told(
            "Every joint's x, y, z in each frame, as in the JSON coding.",
            "m",
            packed="float32, little-endian, three a joint, joints of a frame together",
            max_length=250 * 64 * 12,
        ),
    ]
    is_last: Annotated[bool, told("Whether the motion ends with this stretch.")] = False
    fallback: (
        Annotated[str, told("Why nothing more of it is good: the authored motion stands in.")]
        | None
    ) = None


class Missed(Message, frozen=True, tag="missed"):
    """Telemetry that this client was too slow for since the last message of this kind."""

    topics: Annotated[
        dict[str, Count], told("How many messages of each kind were replaced by newer ones.")
    ]
