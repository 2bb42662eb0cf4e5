"""Bodies: frames as a sensor sends them, and the nine core joints that the models see.

All positions are in the canonical camera frame, which is Kinect v2's: right-handed, metres,
y up, z from the sensor towards the person. Seen from the sensor x points left, so a person
who faces the sensor has their right hand at larger x than their left hand.
"""

from dataclasses import dataclass
from enum import IntEnum

from agent_server.domain.arrays import Float32


class CoreJoint(IntEnum):
    """Index of each core joint in every array whose joint axis has length 9."""

    HEAD = 0
    NECK = 1
    NAVEL = 2
    LEFT_SHOULDER = 3
    LEFT_ELBOW = 4
    LEFT_WRIST = 5
    RIGHT_SHOULDER = 6
    RIGHT_ELBOW = 7
    RIGHT_WRIST = 8


CORE_JOINT_NAMES: tuple[str, ...] = tuple(joint.name.lower() for joint in CoreJoint)
CORE_JOINTS = len(CoreJoint)

CORE_BONES: tuple[tuple[int, int], ...] = (
    (CoreJoint.NAVEL, CoreJoint.NECK),
    (CoreJoint.NECK, CoreJoint.HEAD),
    (CoreJoint.NECK, CoreJoint.LEFT_SHOULDER),
    (CoreJoint.LEFT_SHOULDER, CoreJoint.LEFT_ELBOW),
    (CoreJoint.LEFT_ELBOW, CoreJoint.LEFT_WRIST),
    (CoreJoint.NECK, CoreJoint.RIGHT_SHOULDER),
    (CoreJoint.RIGHT_SHOULDER, CoreJoint.RIGHT_ELBOW),
    (CoreJoint.RIGHT_ELBOW, CoreJoint.RIGHT_WRIST),
)
"""(parent, child) of the eight bones, outwards from the navel."""


@dataclass(frozen=True, slots=True)
class SkeletonFrame:
    """One body at one instant, as its sensor names the joints.

    Attributes:
        originating_ns: Capture time on the session's time line.
        body_id: The sensor's own identity of the body, stable while it is tracked.
        format: Name of the joint table, for example ``kinect_v2``.
        joints: Shape (J, 4), read-only: x, y, z in the format's unit and frame, then the
            confidence in [0, 1] (0 not tracked, 0.5 inferred, 1 tracked).
    """

    originating_ns: int
    body_id: int
    format: str
    joints: Float32


@dataclass(frozen=True, slots=True)
class CoreFrame:
    """The nine core joints of one body at one instant.

    Attributes:
        stamp_ns: Capture time on the session's time line.
        body_id: Identity of the body.
        positions: Shape (9, 3), read-only, metres in the camera frame; a joint that is not
            tracked keeps its last known position.
        confidence: Shape (9,), read-only, in [0, 1]; 0 where the position is not measured.
    """

    stamp_ns: int
    body_id: int
    positions: Float32
    confidence: Float32
