"""CMU motion capture in the eight-action motion-prediction layout.

``cmu_mocap/{train,test}/ACTION/NAME_N.txt``: comma-separated rows of 39 triples, the root's
translation and then 38 joints as exponential maps in radians, at 50 rows a second.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Literal

import msgspec
import torch

from agent_server.domain.arrays import Float32, Float64, frozen
from agent_server.domain.motion import RATE_HZ, MotionSequence
from agent_server.domain.skeleton import CoreJoint
from agent_server.errors import InvalidInput
from models.data import kinematics
from models.data.capture import facing_sensor
from models.data.h36m import Split
from models.data.tables import read_rows

JOINTS = 38
COLUMNS = 3 * (1 + JOINTS)
ROWS_PER_FRAME = 2
SOURCE = "cmu_mocap"
LICENCE = "free for all uses"
VALIDATION_EVERY, VALIDATION_FIRST = 7, 3
"""Every seventh training file, from the fourth on, is held out for validation."""

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
    offsets: list[tuple[float, float, float]]


def read_skeleton(data: Path) -> Skeleton:
    """Read ``cmu_mocap/skeleton.json`` in the folder of the data sets.

    Raises:
        InvalidInput: If it is missing, is no skeleton, has not 38 joints, or names a parent
            after its child.
    """
    path = data / SOURCE / "skeleton.json"
    if not path.is_file():
        raise InvalidInput(f"{path} is missing: give the folder that holds {SOURCE}/ as --data")
    try:
        skeleton = msgspec.json.decode(path.read_bytes(), type=Skeleton)
    except msgspec.DecodeError as error:
        raise InvalidInput(f"{path} is no skeleton ({error}): fetch it again") from error
    if len(skeleton.parents) != JOINTS or len(skeleton.offsets) != JOINTS:
        raise InvalidInput(f"{path} has {len(skeleton.parents)} joints, expected {JOINTS}")
    for joint, parent in enumerate(skeleton.parents):
        if not -1 <= parent < joint:
            raise InvalidInput(
                f"{path}: parents[{joint}] is {parent}, expected -1 or an earlier joint"
            )
    return skeleton


def forward_kinematics(exponential_maps: torch.Tensor, skeleton: Skeleton) -> torch.Tensor:
    """Joint positions from rotations; the root's orientation is taken as zero.

    Args:
        exponential_maps: Shape (T, 38, 3), radians.
        skeleton: Parents and offsets in mm.

    Returns:
        Shape (T, 38, 3), mm, in the capture's frame: x to the body's left, y up, z forwards.
    """
    maps = exponential_maps.clone()
    maps[:, 0] = 0.0
    # The set is written for row vectors, hence the transpose.
    rotations = kinematics.rotation_matrices(maps).transpose(-1, -2)
    offsets = torch.tensor(skeleton.offsets, dtype=maps.dtype)
    return kinematics.forward_kinematics(rotations, skeleton.parents, offsets)


def read_positions(path: Path, skeleton: Skeleton) -> Float64:
    """All joints of one recording at 25 Hz, the root's translation and orientation dropped.

    Returns:
        Shape (T, 38, 3), mm, in the capture's frame.

    Raises:
        InvalidInput: If the rows have not 117 finite columns.
    """
    rows = read_rows(path, COLUMNS)[::ROWS_PER_FRAME, 3:]
    maps = torch.from_numpy(rows.reshape(-1, JOINTS, 3))
    positions: Float64 = forward_kinematics(maps, skeleton).numpy()
    return positions


def read_file(path: Path, skeleton: Skeleton) -> MotionSequence:
    """Read one recording as 25 Hz core joints in the camera frame, facing the sensor.

    Raises:
        InvalidInput: If the rows have not 117 finite columns.
    """
    core = read_positions(path, skeleton)[:, [CORE_INDEX[joint] for joint in CoreJoint]]
    return facing_sensor(
        core / 1000.0, RATE_HZ, subject=path.stem, label=path.parent.name, source=SOURCE
    )


def held_out(place: int) -> bool:
    """Whether a published training file, by its place in the order of names, validates."""
    return place % VALIDATION_EVERY == VALIDATION_FIRST


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


def read_cmu_positions(data: Path, split: Split) -> dict[str, Float32]:
    """Recordings for the literature's protocol, in the order of their names.

    Args:
        data: Folder that holds ``cmu_mocap/``.
        split: ``test`` are the published test files; ``validation`` is every seventh of the
            published training files, ``train`` the others.

    Returns:
        ``ACTION/NAME_N`` -> positions of all 38 joints at 25 Hz, shape (T, 38, 3), read-only, mm,
        in the capture's frame, the root's translation and orientation dropped.

    Raises:
        InvalidInput: If the folder is not there or a file does not fit the layout.
    """
    skeleton = read_skeleton(data)
    folder = data / SOURCE / ("test" if split == "test" else "train")
    paths = sorted(folder.glob("*/*.txt"))
    if not paths:
        raise InvalidInput(f"{folder} holds no ACTION/NAME_N.txt: fetch the set again")
    if split != "test":
        held = split == "validation"
        paths = [path for place, path in enumerate(paths) if held_out(place) == held]
    return {
        f"{path.parent.name}/{path.stem}": frozen(read_positions(path, skeleton), (None, JOINTS, 3))
        for path in paths
    }
