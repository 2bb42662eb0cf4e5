"""CMU motion capture in the eight-action motion-prediction layout.

``cmu_mocap/{train,test}/ACTION/NAME_N.txt``: comma-separated rows of 39 triples, the root's
translation and then 38 joints as exponential maps in radians, at 50 rows a second.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Literal

import msgspec
import numpy as np
import torch
from kornia.geometry.conversions import axis_angle_to_rotation_matrix

from agent_server.domain.arrays import frozen
from agent_server.domain.motion import RATE_HZ, MotionSequence
from agent_server.domain.skeleton import CORE_JOINTS, CoreJoint
from agent_server.errors import InvalidInput

JOINTS = 38
COLUMNS = 3 * (1 + JOINTS)
ROWS_PER_FRAME = 2
SOURCE = "cmu_mocap"
LICENCE = "free for all uses"
DISTANCE_M = 2.5
"""Where the hips are put in front of the sensor; the recordings' own translation is dropped."""

CORE_INDEX: dict[CoreJoint, int] = {
    CoreJoint.HEAD: 19,
    CoreJoint.NECK: 17,
    CoreJoint.NAVEL: 14,
    CoreJoint.LEFT_SHOULDER: 21,
    CoreJoint.LEFT_ELBOW: 22,
    CoreJoint.LEFT_WRIST: 23,
    CoreJoint.RIGHT_SHOULDER: 30,
    CoreJoint.RIGHT_ELBOW: 31,
    CoreJoint.RIGHT_WRIST: 32,
}
"""Core joint -> index among the 38 joints. Neck 17 lies 5 cm above the shoulder line, where
Kinect has SpineShoulder; navel 14 lies 25 cm below it, where Kinect has SpineMid."""

IDLE_ACTIONS = frozenset(
    {"basketball", "jumping", "running", "soccer", "walking", "walking_extra", "washwindow"}
)
"""Actions that hold none of the seven gestures. ``directing_traffic`` and
``basketball_signal`` wave and raise the arms, so they say nothing about ``idle``."""


class Skeleton(msgspec.Struct, frozen=True):
    """The content of ``skeleton.json``: a parent (-1 for none) and an offset in mm a joint."""

    unit: str
    parents: list[int]
    offsets: list[list[float]]


def read_skeleton(data: Path) -> Skeleton:
    """Read ``cmu_mocap/skeleton.json`` in the folder of the data sets.

    Raises:
        InvalidInput: If it is missing or has not 38 joints.
    """
    path = data / SOURCE / "skeleton.json"
    if not path.is_file():
        raise InvalidInput(f"{path} is missing: give the folder that holds {SOURCE}/ as --data")
    skeleton = msgspec.json.decode(path.read_bytes(), type=Skeleton)
    if len(skeleton.parents) != JOINTS or len(skeleton.offsets) != JOINTS:
        raise InvalidInput(f"{path} has {len(skeleton.parents)} joints, expected {JOINTS}")
    return skeleton


def forward_kinematics(exponential_maps: torch.Tensor, skeleton: Skeleton) -> torch.Tensor:
    """Joint positions from rotations; the root's orientation is taken as zero.

    Args:
        exponential_maps: Shape (T, 38, 3), radians.
        skeleton: Parents and offsets in mm.

    Returns:
        Shape (T, 38, 3), mm, in the capture's frame: x to the body's left, y up, z forwards.
    """
    frames = exponential_maps.shape[0]
    maps = exponential_maps.clone()
    maps[:, 0] = 0.0
    local = axis_angle_to_rotation_matrix(maps.reshape(-1, 3)).reshape(frames, JOINTS, 3, 3)
    offsets = torch.tensor(skeleton.offsets, dtype=maps.dtype)
    rotations: list[torch.Tensor] = []
    positions: list[torch.Tensor] = []
    for joint, parent in enumerate(skeleton.parents):
        if parent < 0:
            rotations.append(local[:, joint])
            positions.append(offsets[joint].expand(frames, 3))
        else:
            # Row vectors: R_global(i) = R(i) R_global(parent), and offsets multiply from the left.
            rotations.append(local[:, joint] @ rotations[parent])
            positions.append(offsets[joint] @ rotations[parent] + positions[parent])
    return torch.stack(positions, dim=1)


def read_file(path: Path, skeleton: Skeleton) -> MotionSequence:
    """Read one recording as 25 Hz core joints in the camera frame, facing the sensor.

    Raises:
        InvalidInput: If the rows have not 117 columns.
    """
    rows = np.loadtxt(path, delimiter=",", dtype=np.float64, ndmin=2)
    if rows.shape[1] != COLUMNS:
        raise InvalidInput(f"{path} has {rows.shape[1]} columns, expected {COLUMNS}")
    maps = torch.from_numpy(rows[::ROWS_PER_FRAME, 3:].reshape(-1, JOINTS, 3))
    core = forward_kinematics(maps, skeleton)[:, [CORE_INDEX[joint] for joint in CoreJoint]]
    # Half a turn about y makes the body face the sensor: its right hand comes to larger x.
    positions = core.numpy() * np.array([-1.0, 1.0, -1.0]) / 1000.0 + [0.0, 0.0, DISTANCE_M]
    return MotionSequence(
        positions=frozen(positions, (None, CORE_JOINTS, 3)),
        confidence=frozen(np.ones(positions.shape[:2]), (None, CORE_JOINTS)),
        rate_hz=RATE_HZ,
        subject=path.stem,
        label=path.parent.name,
        source=SOURCE,
    )


def read_cmu(data: Path, split: Literal["train", "test"]) -> Iterator[MotionSequence]:
    """All recordings of a split, in the order of their names; the label is the action.

    Args:
        data: Folder that holds ``cmu_mocap/``.
        split: ``train`` or ``test``, as published.

    Raises:
        InvalidInput: If the folder is not there or a file does not fit the layout.
    """
    skeleton = read_skeleton(data)
    for path in sorted((data / SOURCE / split).glob("*/*.txt")):
        yield read_file(path, skeleton)
