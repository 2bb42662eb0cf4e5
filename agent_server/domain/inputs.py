"""Everything that clients send into a session, as the core gets it."""

from agent_server.domain.affect import AffectSample, Calibration
from agent_server.domain.command import Ack
from agent_server.domain.face import FaceBlendshapes, FaceLandmarks, GazeSample
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.skeleton import SkeletonFrame

SensorInput = (
    SkeletonFrame | AffectSample | FaceLandmarks | FaceBlendshapes | GazeSample | Calibration
)
"""What a sensor sends; each has the ``originating_ns`` of its capture."""

RawInput = SensorInput | Ack | ObjectChanged
"""What any client sends."""
