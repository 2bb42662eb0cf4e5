"""What clients send, between the domain and the records of a recording."""

from agent_server.domain.affect import AffectSample, Calibration
from agent_server.domain.command import Ack
from agent_server.domain.face import FaceBlendshapes, FaceLandmarks, GazeSample
from agent_server.domain.inputs import RawInput, SensorInput
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.protocol import messages as m
from agent_server.protocol.convert import ack_from_message
from agent_server.protocol.inputs import input_from_message, input_to_message
from agent_server.recording import topics
from agent_server.recording.topics import Topic

_TOPICS: dict[type[SensorInput], Topic] = {
    SkeletonFrame: topics.SKELETON,
    FaceLandmarks: topics.FACE,
    FaceBlendshapes: topics.FACE,
    AffectSample: topics.AFFECT,
    GazeSample: topics.GAZE,
    Calibration: topics.CALIBRATION,
}


def to_record(value: RawInput) -> tuple[Topic, int, m.Message]:
    """The topic, the stamp and the record of what entered the core.

    The stamp is the capture time of what a sensor sent, and the arrival of anything else.
    """
    match value:
        case Ack():
            ack = m.AckMessage(value.command_id, value.status.value, value.step, value.reason)
            return topics.ACK, value.stamp_ns, ack
        case ObjectChanged():
            return topics.SCENE_EVENT, value.stamp_ns, m.SceneEvent(value.object, value.state)
        case _:
            return _TOPICS[type(value)], value.originating_ns, input_to_message(value)


def from_record(message: object, stamp_ns: int) -> RawInput:
    """What a record of a raw input was made from.

    Raises:
        InvalidInput: If it does not pass the checks that it once passed.
    """
    match message:
        case m.AckMessage():
            return ack_from_message(message, stamp_ns)
        case m.SceneEvent():
            return ObjectChanged(stamp_ns, message.object, message.state)
    value = input_from_message(message)
    if value is None:
        raise AssertionError(f"{type(message).__name__} is no raw input")
    return value
