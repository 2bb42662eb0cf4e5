"""What a sensor sends, between the wire and the domain, whatever it is."""

from typing import assert_never

from agent_server.domain.affect import AffectSample, Calibration
from agent_server.domain.face import FaceBlendshapes, FaceLandmarks, GazeSample
from agent_server.domain.inputs import SensorInput
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.protocol import convert, faces
from agent_server.protocol import messages as m


def input_to_message(value: SensorInput) -> m.Message:
    """What a sensor sends, as a JSON-coded message."""
    match value:
        case SkeletonFrame():
            return convert.skeleton_to_message(value)
        case FaceLandmarks() | FaceBlendshapes():
            return faces.face_to_message(value)
        case AffectSample():
            return convert.affect_to_message(value)
        case GazeSample():
            return faces.gaze_to_message(value)
        case Calibration():
            return faces.calibration_to_message(value)
        case _:
            assert_never(value)


def input_from_message(message: object) -> SensorInput | None:
    """What a sensor's message says, checked, at the sender's stamp; None for any other message.

    Raises:
        InvalidInput: If it does not pass the checks.
    """
    match message:
        case m.Skeleton() | m.PackedSkeleton():
            return convert.skeleton_from_message(message)
        case m.FacePoints() | m.PackedFacePoints() | m.Blendshapes():
            return faces.face_from_message(message)
        case m.Affect():
            return convert.affect_from_message(message)
        case m.Gaze():
            return faces.gaze_from_message(message)
        case m.Calibrate():
            return faces.calibration_from_message(message)
    return None


def packed(message: m.Message) -> m.Message:
    """A JSON-coded message as a MessagePack-coded one; the two differ only where arrays are."""
    match message:
        case m.Skeleton():
            return convert.pack_skeleton(message)
        case m.FacePoints():
            return faces.pack_face(message)
    return message
