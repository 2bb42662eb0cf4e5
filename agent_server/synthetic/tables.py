"""Where each sensor puts its joints in a body, and the order in which it names them.

Skeletons of different sensors differ by constant offsets: Kinect v1 puts the shoulders some
6 cm below the joint's centre and the wrist short of it, Kinect v2's SpineShoulder lies below
v1's ShoulderCenter and its SpineMid well above v1's Spine. The offsets of v1 were
measured on recordings of 20 people (medians), those of v2 follow the SDK's sample skeletons.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.synthetic.body import SIDE_SIGNS, BodyJoint, BodyMotion, turn

Places = Literal["marker", "kinect_v1", "kinect_v2", "webcam"]


@dataclass(frozen=True, slots=True)
class Offsets:
    """Where the core joints lie against the landmarks of the body, in metres.

    Attributes:
        head: Right, up and back in the head's frame, from the middle of the head.
        neck: In the chest's frame, from the neck's base.
        navel: In the chest's frame, from the navel.
        shoulder: Outwards, up and back in the chest's frame, from the shoulder joint.
        upper_arm: Length of the upper arm as the sensor believes it, against the true one; its
            elbow is drawn most of the way to where that puts it.
        forearm: The same for the forearm; the wrist gives way less.
    """

    head: tuple[float, float, float] = (0.0, 0.0, 0.0)
    neck: tuple[float, float, float] = (0.0, 0.0, 0.0)
    navel: tuple[float, float, float] = (0.0, 0.0, 0.0)
    shoulder: tuple[float, float, float] = (0.0, 0.0, 0.0)
    upper_arm: float = 1.0
    forearm: float = 1.0


CORE_PLACES: Mapping[Places, Offsets] = MappingProxyType(
    {
        "marker": Offsets(),
        "kinect_v1": Offsets(
            head=(0.0, 0.012, -0.010),
            navel=(0.0, 0.025, 0.0),
            shoulder=(-0.022, -0.062, 0.0),
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
        "webcam": Offsets(head=(0.0, -0.01, 0.0), neck=(0.0, -0.045, 0.0)),
    }
)


@dataclass(frozen=True, slots=True)
class Table:
    """A sensor's own joints.

    Attributes:
        names: In the sensor's order.
        body: Landmark that each joint is placed at, unless it is a core joint.
        core: Index of each of the nine core joints in the table.
        follows: Core joint whose errors and confidence each joint shares.
        feet: Indices of ankles and feet.
    """

    names: tuple[str, ...]
    body: list[int]
    core: list[int]
    follows: list[int]
    feet: list[int]


def _table(rows: list[tuple[str, BodyJoint, int, bool]]) -> Table:
    core = [0] * 9
    for index, (_, _, joint, is_core) in enumerate(rows):
        if is_core:
            core[joint] = index
    return Table(
        names=tuple(row[0] for row in rows),
        body=[int(row[1]) for row in rows],
        core=core,
        follows=[row[2] for row in rows],
        feet=[i for i, row in enumerate(rows) if "Ankle" in row[0] or "Foot" in row[0]],
    )


_B = BodyJoint
TABLES: Mapping[str, Table] = MappingProxyType(
    {
        "kinect_v2": _table(
            [
                ("SpineBase", _B.PELVIS, 2, False), ("SpineMid", _B.NAVEL, 2, True),
                ("Neck", _B.NECK, 1, False), ("Head", _B.HEAD, 0, True),
                ("ShoulderLeft", _B.LEFT_SHOULDER, 3, True),
                ("ElbowLeft", _B.LEFT_ELBOW, 4, True),
                ("WristLeft", _B.LEFT_WRIST, 5, True), ("HandLeft", _B.LEFT_HAND, 5, False),
                ("ShoulderRight", _B.RIGHT_SHOULDER, 6, True),
                ("ElbowRight", _B.RIGHT_ELBOW, 7, True),
                ("WristRight", _B.RIGHT_WRIST, 8, True), ("HandRight", _B.RIGHT_HAND, 8, False),
                ("HipLeft", _B.LEFT_HIP, 2, False), ("KneeLeft", _B.LEFT_KNEE, 2, False),
                ("AnkleLeft", _B.LEFT_ANKLE, 2, False), ("FootLeft", _B.LEFT_FOOT, 2, False),
                ("HipRight", _B.RIGHT_HIP, 2, False), ("KneeRight", _B.RIGHT_KNEE, 2, False),
                ("AnkleRight", _B.RIGHT_ANKLE, 2, False), ("FootRight", _B.RIGHT_FOOT, 2, False),
                ("SpineShoulder", _B.NECK_BASE, 1, True),
                ("HandTipLeft", _B.LEFT_TIP, 5, False), ("ThumbLeft", _B.LEFT_THUMB, 5, False),
                ("HandTipRight", _B.RIGHT_TIP, 8, False),
                ("ThumbRight", _B.RIGHT_THUMB, 8, False),
            ]
        ),
        "kinect_v1": _table(
            [
                ("HipCenter", _B.PELVIS, 2, False), ("Spine", _B.NAVEL, 2, True),
                ("ShoulderCenter", _B.NECK_BASE, 1, True), ("Head", _B.HEAD, 0, True),
                ("ShoulderLeft", _B.LEFT_SHOULDER, 3, True),
                ("ElbowLeft", _B.LEFT_ELBOW, 4, True),
                ("WristLeft", _B.LEFT_WRIST, 5, True), ("HandLeft", _B.LEFT_HAND, 5, False),
                ("ShoulderRight", _B.RIGHT_SHOULDER, 6, True),
                ("ElbowRight", _B.RIGHT_ELBOW, 7, True),
                ("WristRight", _B.RIGHT_WRIST, 8, True), ("HandRight", _B.RIGHT_HAND, 8, False),
                ("HipLeft", _B.LEFT_HIP, 2, False), ("KneeLeft", _B.LEFT_KNEE, 2, False),
                ("AnkleLeft", _B.LEFT_ANKLE, 2, False), ("FootLeft", _B.LEFT_FOOT, 2, False),
                ("HipRight", _B.RIGHT_HIP, 2, False), ("KneeRight", _B.RIGHT_KNEE, 2, False),
                ("AnkleRight", _B.RIGHT_ANKLE, 2, False), ("FootRight", _B.RIGHT_FOOT, 2, False),
            ]
        ),
    }
)  # fmt: skip


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


def place_table(body: BodyMotion, places: Places) -> Float64:
    """All joints of a sensor's own table without errors: shape (T, J, 3)."""
    table = TABLES[places]
    out = body.joints[:, table.body].copy()
    out[:, table.core] = place_core(body, places)
    return out
