"""Who sends what: the messages that a client of each role may send, and those that it may get."""

from agent_server.protocol import messages as m

CLIENT_SENDS: dict[m.Role, tuple[type[m.Message], ...]] = {
    "sensor": (
        m.Skeleton,
        m.PackedSkeleton,
        m.FacePoints,
        m.PackedFacePoints,
        m.Blendshapes,
        m.Image,
        m.Affect,
        m.Gaze,
        m.Calibrate,
    ),
    "renderer": (m.AckMessage, m.SceneEvent),
    "monitor": (),
}
"""Beside hello, ping and pong."""

SERVER_SENDS: dict[m.Role, tuple[type[m.Message], ...]] = {
    "sensor": (m.CalibrationState,),
    "renderer": (
        m.CommandMessage,
        m.SceneState,
        m.PoseStreamMessage,
        m.PackedPoseStreamMessage,
    ),
    "monitor": (
        m.PoseMessage,
        m.ForecastMessage,
        m.AffectTelemetry,
        m.CalibrationState,
        m.DecisionMessage,
        m.CommandMessage,
        m.AckTelemetry,
        m.SceneState,
        m.StatsMessage,
        m.Missed,
    ),
}
"""Beside welcome, error, ping and pong."""

CLIENT_ALWAYS: tuple[type[m.Message], ...] = (m.Hello, m.Ping, m.Pong)
SERVER_ALWAYS: tuple[type[m.Message], ...] = (m.Welcome, m.ErrorMessage, m.Ping, m.Pong)
