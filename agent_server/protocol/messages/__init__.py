"""Every message of protocol 1, as msgspec types: the one source of all that is generated.

A message is a map with a ``type`` tag. Unknown fields are ignored, so that a minor version
may add some. Time stamps are integer nanoseconds; positions are metres in the camera frame
unless a skeleton's format says otherwise; valence and arousal lie in [-10, 10].
"""

from agent_server.protocol.messages.client import (
    AckMessage,
    Affect,
    Blendshapes,
    Calibrate,
    FacePoints,
    Gaze,
    Hello,
    Image,
    PackedFacePoints,
    PackedSkeleton,
    SceneEvent,
    Skeleton,
)
from agent_server.protocol.messages.common import Ping, Pong
from agent_server.protocol.messages.fields import (
    AckStatus,
    CommandEnd,
    FaceFormat,
    FaceKind,
    JointSample,
    Message,
    Nanoseconds,
    Point,
    Role,
    Topic,
)
from agent_server.protocol.messages.server import (
    CommandMessage,
    DecideLevels,
    Difference,
    ErrorMessage,
    GateLevels,
    Limits,
    Missed,
    ModelInfo,
    PackedPoseStreamMessage,
    PoseStreamMessage,
    SceneState,
    StepMessage,
    Welcome,
)
from agent_server.protocol.messages.telemetry import (
    AckTelemetry,
    AffectTelemetry,
    CalibrationState,
    ClientStats,
    CommandBody,
    DecisionBody,
    DecisionMessage,
    ForecastMessage,
    ForecastScoreBody,
    FutureBody,
    FuturesBody,
    GateBody,
    PoseMessage,
    QualityBody,
    SceneBody,
    StatsMessage,
    Timing,
)

PROTOCOL = "1.0"
PROTOCOL_MAJOR = 1
SUBPROTOCOL_JSON = "agent-server.v1.json"
SUBPROTOCOL_MSGPACK = "agent-server.v1.msgpack"

_FromClient = (
    Hello | Ping | Pong | Affect | Blendshapes | Gaze | Calibrate | AckMessage | SceneEvent
)
ClientMessage = _FromClient | Skeleton | FacePoints
"""What a client sends in the JSON coding, where an image is a binary frame."""
PackedClientMessage = _FromClient | PackedSkeleton | PackedFacePoints | Image
"""What a client sends in the MessagePack coding."""

_FromServer = (
    Welcome
    | ErrorMessage
    | Ping
    | Pong
    | CommandMessage
    | SceneState
    | Missed
    | PoseMessage
    | ForecastMessage
    | AffectTelemetry
    | CalibrationState
    | AckTelemetry
    | DecisionMessage
    | StatsMessage
)
ServerMessage = _FromServer | PoseStreamMessage
"""What a server sends in the JSON coding."""
PackedServerMessage = _FromServer | PackedPoseStreamMessage
"""What a server sends in the MessagePack coding."""

__all__ = [
    "PROTOCOL",
    "PROTOCOL_MAJOR",
    "SUBPROTOCOL_JSON",
    "SUBPROTOCOL_MSGPACK",
    "AckMessage",
    "AckStatus",
    "AckTelemetry",
    "Affect",
    "AffectTelemetry",
    "Blendshapes",
    "Calibrate",
    "CalibrationState",
    "ClientMessage",
    "ClientStats",
    "CommandBody",
    "CommandEnd",
    "CommandMessage",
    "DecideLevels",
    "DecisionBody",
    "DecisionMessage",
    "Difference",
    "ErrorMessage",
    "FaceFormat",
    "FaceKind",
    "FacePoints",
    "ForecastMessage",
    "ForecastScoreBody",
    "FutureBody",
    "FuturesBody",
    "GateBody",
    "GateLevels",
    "Gaze",
    "Hello",
    "Image",
    "JointSample",
    "Limits",
    "Message",
    "Missed",
    "ModelInfo",
    "Nanoseconds",
    "PackedClientMessage",
    "PackedFacePoints",
    "PackedPoseStreamMessage",
    "PackedServerMessage",
    "PackedSkeleton",
    "Ping",
    "Point",
    "Pong",
    "PoseMessage",
    "PoseStreamMessage",
    "QualityBody",
    "Role",
    "SceneBody",
    "SceneEvent",
    "SceneState",
    "ServerMessage",
    "Skeleton",
    "StatsMessage",
    "StepMessage",
    "Timing",
    "Topic",
    "Welcome",
]
