"""Where each sensor puts its joints in a body.

Skeletons of different sensors differ by constant offsets: Kinect v1 puts the shoulders some
6 cm below the joint's centre and the wrist short of it, Kinect v2's SpineShoulder lies below
v1's ShoulderCenter and its SpineMid well above v1's Spine. The offsets of v1 were
measured on recordings of 20 people (medians), those of v2 and of
the webcam are estimates, those of markers were set to CMU's skeletons.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Literal

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.domain.skeleton import CoreJoint
from agent_server.skeleton.formats import get_format
from agent_server.synthetic.body import SIDE_SIGNS, BodyJoint, BodyMotion
from agent_server.synthetic.limbs import turn

Places = Literal["marker", "kinect_v1", "kinect_v2", "webcam"]


@dataclass(frozen=True, slots=True)
class Offsets:
    """Where the core joints lie against the landmarks of the body, in metres.

    Attributes:
        head: Right, up and back in the head's frame, from the middle of the head.
        neck: In the chest's frame, from the neck's base.
        navel: In the chest's frame, from the navel.
        shoulder: Outwards, up and back in the chest's frame, from the shoulder joint.
        hips: In the chest's frame, from the hips and the middle between them.
        upper_arm: Length of the upper arm as the sensor believes it, against the true one; its
            elbow is drawn most of the way to where that puts it.
        forearm: The same for the forearm; the wrist gives way less.
    """

    head: tuple[float, float, float] = (0.0, 0.0, 0.0)
    neck: tuple[float, float, float] = (0.0, 0.0, 0.0)
    navel: tuple[float, float, float] = (0.0, 0.0, 0.0)
    shoulder: tuple[float, float, float] = (0.0, 0.0, 0.0)
    hips: tuple[float, float, float] = (0.0, 0.0, 0.0)
    upper_arm: float = 1.0
    forearm: float = 1.0


CORE_PLACES: Mapping[Places, Offsets] = MappingProxyType(
    {
        "marker": Offsets(
            head=(0.0, 0.012, 0.0),
            neck=(0.0, -0.030, 0.0),
            navel=(0.0, 0.100, 0.0),
            shoulder=(0.050, -0.030, 0.0),
            upper_arm=1.10,
            forearm=0.92,
        ),
        "kinect_v1": Offsets(
            head=(0.0, 0.012, -0.010),
            navel=(0.0, 0.025, 0.0),
            shoulder=(-0.022, -0.062, 0.0),
            hips=(0.0, 0.09, 0.0),
            upper_arm=0.79,
            forearm=0.91,
        ),
        "kinect_v2": Offsets(
            neck=(0.0, -0.050, 0.0),
            navel=(0.0, 0.105, 0.0),
            shoulder=(-0.014, -0.040, 0.0),
            upper_arm=0.89,
            forearm=0.96,
        ),
        "webcam": Offsets(
            head=(0.0, -0.010, 0.0), neck=(0.0, -0.010, 0.0), navel=(0.0, 0.080, 0.0)
        ),
    }
)


@dataclass(frozen=True, slots=True)
class NativeTable:
    """A sensor's own joints, in the order of its format.

    Attributes:
        landmarks: Landmark that each joint is placed at, unless it is a core joint.
        core: Index of each of the nine core joints in the table.
        follows: Core joint whose errors and confidence each joint shares.
        feet: Indices of ankles and feet.
        hips: Indices of the hips and the joint between them.
    """

    landmarks: list[int]
    core: list[int]
    follows: list[int]
    feet: list[int]
    hips: list[int]


_TRUNK: Mapping[str, tuple[int, int]] = MappingProxyType(
    {
        "spine_base": (BodyJoint.PELVIS, CoreJoint.NAVEL),
        "hip_center": (BodyJoint.PELVIS, CoreJoint.NAVEL),
        "spine_mid": (BodyJoint.NAVEL, CoreJoint.NAVEL),
        "spine": (BodyJoint.NAVEL, CoreJoint.NAVEL),
        "spine_shoulder": (BodyJoint.NECK_BASE, CoreJoint.NECK),
        "shoulder_center": (BodyJoint.NECK_BASE, CoreJoint.NECK),
        "neck": (BodyJoint.NECK, CoreJoint.NECK),
        "head": (BodyJoint.HEAD, CoreJoint.HEAD),
    }
)
_LEFT_ARM: Mapping[str, tuple[int, int]] = MappingProxyType(
    {
        "shoulder": (BodyJoint.LEFT_SHOULDER, CoreJoint.LEFT_SHOULDER),
        "elbow": (BodyJoint.LEFT_ELBOW, CoreJoint.LEFT_ELBOW),
        "wrist": (BodyJoint.LEFT_WRIST, CoreJoint.LEFT_WRIST),
        "hand": (BodyJoint.LEFT_HAND, CoreJoint.LEFT_WRIST),
        "hand_tip": (BodyJoint.LEFT_TIP, CoreJoint.LEFT_WRIST),
        "thumb": (BodyJoint.LEFT_THUMB, CoreJoint.LEFT_WRIST),
    }
)
_LEFT_LEG: Mapping[str, int] = MappingProxyType(
    {
        "hip": BodyJoint.LEFT_HIP,
        "knee": BodyJoint.LEFT_KNEE,
        "ankle": BodyJoint.LEFT_ANKLE,
        "foot": BodyJoint.LEFT_FOOT,
    }
)


def _joint(name: str) -> tuple[int, int]:
    """Landmark of a native joint, and the core joint whose errors it shares."""
    if name in _TRUNK:
        return _TRUNK[name]
    limb, _, side = name.rpartition("_")
    right = side == "right"
    if limb in _LEFT_LEG:
        to_right = BodyJoint.RIGHT_HIP - BodyJoint.LEFT_HIP
        return _LEFT_LEG[limb] + to_right * right, CoreJoint.NAVEL
    landmark, core = _LEFT_ARM[limb]
    to_right = BodyJoint.RIGHT_SHOULDER - BodyJoint.LEFT_SHOULDER
    return landmark + to_right * right, core + 3 * right


@cache
def native_table(name: str) -> NativeTable:
    """The joints of ``kinect_v1`` or ``kinect_v2`` in the body."""
    joint_format = get_format(name)
    names = joint_format.names
    pairs = [_joint(joint) for joint in names]
    return NativeTable(
        landmarks=[int(landmark) for landmark, _ in pairs],
        core=[names.index(shares[0][0]) for shares in joint_format.core],
        follows=[int(core) for _, core in pairs],
        feet=[i for i, joint in enumerate(names) if joint.startswith(("ankle", "foot"))],
        hips=[i for i, joint in enumerate(names) if joint.startswith(("hip", "spine_base"))],
    )


def place_core(body: BodyMotion, places: Places) -> Float64:
    """The nine core joints where a sensor of this kind puts them: shape (T, 9, 3)."""
    offsets, joints = CORE_PLACES[places], body.joints
    out = np.empty((len(joints), 9, 3))
    out[:, 0] = joints[:, BodyJoint.HEAD] + turn(body.head, np.array(offsets.head))
    out[:, 1] = joints[:, BodyJoint.NECK_BASE] + turn(body.chest, np.array(offsets.neck))
    out[:, 2] = joints[:, BodyJoint.NAVEL] + turn(body.chest, np.array(offsets.navel))
    for side, sign in enumerate(SIDE_SIGNS):
        first = BodyJoint.RIGHT_SHOULDER if side else BodyJoint.LEFT_SHOULDER
        shift = np.array(offsets.shoulder) * (sign, 1.0, 1.0)
        shoulder, elbow, wrist = (joints[:, first + k] for k in range(3))
        seen = shoulder + turn(body.chest, shift)
        out[:, 3 + 3 * side] = seen
        out[:, 4 + 3 * side] = _drawn(seen, elbow, offsets.upper_arm, shoulder, 0.8)
        out[:, 5 + 3 * side] = _drawn(out[:, 4 + 3 * side], wrist, offsets.forearm, elbow, 0.5)
    return out


def place_table(body: BodyMotion, name: str, places: Places) -> Float64:
    """All joints of a native table without errors: shape (T, J, 3)."""
    table = native_table(name)
    out = body.joints[:, table.landmarks].copy()
    out[:, table.hips] += turn(body.chest, np.array(CORE_PLACES[places].hips))[:, None]
    out[:, table.core] = place_core(body, places)
    return out


def _drawn(
    root: Float64, end: Float64, share: float, true_root: Float64, stiffness: float
) -> Float64:
    """The end of a bone whose length the sensor believes to be ``share`` of the true one."""
    if share == 1.0:
        return end
    bone = end - root
    length = np.linalg.norm(bone, axis=1)
    believed = share * np.linalg.norm(end - true_root, axis=1)
    return np.asarray(root + bone * ((believed / length) ** stiffness)[:, None])
