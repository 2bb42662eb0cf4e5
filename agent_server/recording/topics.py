"""The topics of a recording and the type of the records on each."""

from dataclasses import dataclass
from typing import Any

from agent_server.protocol import messages as m
from agent_server.recording.records import (
    CompressedImage,
    CoreEntry,
    InputTimes,
    LabelRecord,
)


@dataclass(frozen=True, slots=True)
class Topic:
    """One stream of records.

    Attributes:
        name: For example ``/skeleton``.
        schema: Name of its schema.
        record: Type of its records, or a union of types.
    """

    name: str
    schema: str
    record: Any


SKELETON = Topic("/skeleton", "agent_server.Skeleton", m.Skeleton)
AFFECT = Topic("/affect", "agent_server.Affect", m.Affect)
FACE = Topic("/face", "agent_server.Face", m.FacePoints | m.Blendshapes)
GAZE = Topic("/gaze", "agent_server.Gaze", m.Gaze)
CALIBRATION = Topic("/calibration", "agent_server.Calibrate", m.Calibrate)
IMAGE = Topic("/image", "foxglove.CompressedImage", CompressedImage)
ACK = Topic("/ack", "agent_server.Ack", m.AckMessage)
SCENE_EVENT = Topic("/scene_event", "agent_server.SceneEvent", m.SceneEvent)
SCENE = Topic("/scene", "agent_server.SceneState", m.SceneState)
DECISION = Topic("/decision", "agent_server.Decision", m.DecisionMessage)
COMMAND = Topic("/command", "agent_server.Command", m.CommandMessage)
MOTION = Topic("/motion", "agent_server.PoseStream", m.PoseStreamMessage)
LABEL = Topic("/label", "agent_server.Label", LabelRecord)
TIMES = Topic("/times", "agent_server.InputTimes", InputTimes)
CORE = Topic("/core", "agent_server.Core", CoreEntry)

RAW_INPUTS: tuple[Topic, ...] = (SKELETON, FACE, AFFECT, GAZE, CALIBRATION, ACK, SCENE_EVENT)
"""What clients sent in, as it entered the core."""

TOPICS: dict[str, Topic] = {
    topic.name: topic
    for topic in (*RAW_INPUTS, IMAGE, SCENE, DECISION, COMMAND, MOTION, LABEL, TIMES, CORE)
}
"""Every topic by its name."""
