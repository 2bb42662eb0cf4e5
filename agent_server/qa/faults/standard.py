"""The faults of the robustness table, from harmless to hard."""

from agent_server.domain.skeleton import CoreJoint
from agent_server.qa.faults.base import Fault, NoFault
from agent_server.qa.faults.clocks import ClockDrift, ClockJump
from agent_server.qa.faults.sensors import FaceLoss, FrameRate, Noise, Occlusion, SecondBody
from agent_server.qa.faults.transport import Delay, Drop, Duplicate, Jitter, Reorder

FAULTS: tuple[Fault, ...] = (
    NoFault(),
    Drop(0.1),
    Drop(0.4),
    Delay(200),
    Jitter(50),
    Reorder(0.1),
    Duplicate(0.2),
    ClockDrift(2000),
    ClockJump(+2000),
    ClockJump(-500),
    Noise(10),
    Noise(30),
    Occlusion(CoreJoint.RIGHT_WRIST),
    Occlusion(CoreJoint.RIGHT_WRIST, hidden_s=2.0),
    FrameRate(15),
    FrameRate(10),
    FaceLoss(),
    SecondBody(),
)
