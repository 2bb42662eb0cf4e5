"""AMASS-style motion: ``.npz`` files with SMPL, SMPL-H or SMPL-X pose parameters.

No body model is at hand, so the rotations drive one fixed skeleton of average proportions.
Body shape (``betas``, ``gender``) is not applied: everybody gets the same bones.
"""

import zipfile
from pathlib import Path

import numpy as np
import torch
from numpy.lib.npyio import NpzFile

from agent_server.domain.arrays import Float64
from agent_server.domain.motion import MotionSequence
from agent_server.domain.skeleton import CoreJoint
from agent_server.errors import InvalidInput
from models.data.capture import facing_sensor
from models.data.kinematics import forward_kinematics, rotation_matrices

SOURCE = "amass"
BODY_JOINTS = 22
POSE_WIDTHS = {72: "SMPL", 156: "SMPL-H", 165: "SMPL-X"}
"""Numbers a frame of each model; all three begin with the same 22 body joints."""
RATE_FIELDS = ("mocap_framerate", "mocap_frame_rate")

SKELETON: tuple[tuple[str, int, tuple[float, float, float]], ...] = (
    ("pelvis", -1, (0.0, 0.0, 0.0)),
    ("left hip", 0, (0.085, -0.06, 0.0)),
    ("right hip", 0, (-0.085, -0.06, 0.0)),
    ("spine 1", 0, (0.0, 0.10, 0.0)),
    ("left knee", 1, (0.0, -0.4165, 0.0)),  # 0.245 H
    ("right knee", 2, (0.0, -0.4165, 0.0)),
    ("spine 2", 3, (0.0, 0.12, 0.0)),
    ("left ankle", 4, (0.0, -0.418, 0.0)),  # 0.246 H
    ("right ankle", 5, (0.0, -0.418, 0.0)),
    ("spine 3", 6, (0.0, 0.06, 0.0)),
    ("left foot", 7, (0.0, -0.05, 0.13)),
    ("right foot", 8, (0.0, -0.05, 0.13)),
    ("neck", 9, (0.0, 0.19, 0.0)),
    ("left collar", 9, (0.08, 0.11, 0.0)),
    ("right collar", 9, (-0.08, 0.11, 0.0)),
    ("head", 12, (0.0, 0.09, 0.02)),
    ("left shoulder", 13, (0.11, 0.04, 0.0)),  # (0.818 - 0.530) H above the hips
    ("right shoulder", 14, (-0.11, 0.04, 0.0)),
    ("left elbow", 16, (0.316, 0.0, 0.0)),  # 0.186 H
    ("right elbow", 17, (-0.316, 0.0, 0.0)),
    ("left wrist", 18, (0.248, 0.0, 0.0)),  # 0.146 H
    ("right wrist", 19, (-0.248, 0.0, 0.0)),
    ("centre of the head", 15, (0.0, 0.07, 0.02)),  # half of the head's 0.130 H under the top
)
"""Name, parent (-1 for none) and offset from it in metres, in SMPL's order and its rest pose: arms
out, x to the body's left, y up, z forwards. Lengths are shares of a stature H of 1.70 m from
Drillis and Contini (1966) where a comment says so. How the trunk is shared among its joints, and
how far inside the body the hips and shoulders lie, are our choice. The last row is no joint
of SMPL: sensors give the middle of the head, and SMPL's head joint is where it nods."""

CORE_INDEX: dict[CoreJoint, int] = {
    CoreJoint.HEAD: 22,
    CoreJoint.NECK: 12,
    CoreJoint.NAVEL: 6,
    CoreJoint.LEFT_SHOULDER: 16,
    CoreJoint.LEFT_ELBOW: 18,
    CoreJoint.LEFT_WRIST: 20,
    CoreJoint.RIGHT_SHOULDER: 17,
    CoreJoint.RIGHT_ELBOW: 19,
    CoreJoint.RIGHT_WRIST: 21,
}
"""Core joint -> row of the skeleton. Spine 2 lies 25 cm below the neck, where Kinect has
SpineMid."""


def positions_of(poses: torch.Tensor) -> torch.Tensor:
    """Joint positions of the average body; the root's orientation is taken as zero.

    Args:
        poses: Shape (T, 22, 3), axis times angle in radians.

    Returns:
        Shape (T, 23, 3), metres from the pelvis, rows as in ``SKELETON``.
    """
    maps = torch.zeros(len(poses), len(SKELETON), 3, dtype=poses.dtype)
    maps[:, 1:BODY_JOINTS] = poses[:, 1:]
    parents = [parent for _, parent, _ in SKELETON]
    offsets = torch.tensor([offset for _, _, offset in SKELETON], dtype=poses.dtype)
    return forward_kinematics(rotation_matrices(maps), parents, offsets)


def read_amass(path: Path) -> MotionSequence:
    """Read one recording as 25 Hz core joints in the camera frame, facing the sensor.

    As with the other captures, the root's translation (``trans``) and orientation are dropped.
    The subject is the name of the file's folder, the label that of the file.

    Args:
        path: Holds ``poses``, shape (T, 72), (T, 156) or (T, 165), axis-angle in radians, and
            ``mocap_framerate`` or ``mocap_frame_rate``, frames a second.

    Raises:
        InvalidInput: If it is no such file; names the field, what it has, and what to do.
    """
    poses, rate_hz = _read_fields(path)
    maps = torch.from_numpy(poses[:, : 3 * BODY_JOINTS].reshape(-1, BODY_JOINTS, 3))
    core = positions_of(maps)[:, [CORE_INDEX[joint] for joint in CoreJoint]]
    return facing_sensor(
        core.numpy(), rate_hz, subject=path.parent.name, label=path.stem, source=SOURCE
    )


def _read_fields(path: Path) -> tuple[Float64, float]:
    """Poses (T, 72, 156 or 165) and frames a second."""
    try:
        archive = np.load(path, allow_pickle=False)
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        raise InvalidInput(
            f"{path} cannot be read as .npz ({error}): fetch it again", code="unreadable"
        ) from error
    if not isinstance(archive, NpzFile):
        raise InvalidInput(f"{path} is a single array: give an .npz with poses", code="malformed")
    with archive:
        rate_field = next((name for name in RATE_FIELDS if name in archive.files), None)
        if rate_field is None:
            raise InvalidInput(
                f"{path} has neither {' nor '.join(RATE_FIELDS)}, only "
                f"{', '.join(archive.files)}: add its frames a second",
                field=RATE_FIELDS[0],
                code="missing",
            )
        rate = _numbers(path, archive, rate_field)
        poses = _numbers(path, archive, "poses")
    if rate.size != 1:
        raise InvalidInput(
            f"{path}, {rate_field}: shape {rate.shape}, expected one number", field=rate_field
        )
    if poses.ndim != 2 or poses.shape[1] not in POSE_WIDTHS or not len(poses):
        widths = ", ".join(f"(T, {width}) for {model}" for width, model in POSE_WIDTHS.items())
        raise InvalidInput(
            f"{path}, poses: shape {poses.shape}, expected {widths}: give the whole pose",
            field="poses",
            code="wrong_shape",
        )
    return poses, float(rate.reshape(()))


def _numbers(path: Path, archive: NpzFile, field: str) -> Float64:
    """A field of finite numbers."""
    if field not in archive.files:
        raise InvalidInput(
            f"{path} has no {field}, only {', '.join(archive.files)}: give a file of motion, not "
            "of shape",
            field=field,
            code="missing",
        )
    try:
        values = np.asarray(archive[field], dtype=np.float64)
    except (ValueError, zipfile.BadZipFile) as error:
        raise InvalidInput(
            f"{path}, {field}: no array of numbers ({error}): save it as floats",
            field=field,
            code="malformed",
        ) from error
    fine = np.isfinite(values)
    if not fine.all():
        place = [int(index) for index in np.argwhere(~fine)[0]]
        raise InvalidInput(
            f"{path}, {field}{place} is {values[tuple(place)]}: cut the recording there",
            field=field,
            code="not_finite",
        )
    return values
