"""The nine core joints of a BVH file, by the names of its joints."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.domain.motion import MotionSequence
from agent_server.domain.skeleton import CoreJoint
from agent_server.errors import InvalidInput
from models.data.bvh import parse_bvh
from models.data.capture import facing_sensor

SOURCE = "bvh"
TRUNK_M = (0.1, 0.6)
"""Between these lengths, navel to neck, a body can be a person's."""

CoreNames = Mapping[CoreJoint, tuple[str, ...]]
"""For each core joint the joints of the file whose mean it is."""

_ARMS: CoreNames = {
    CoreJoint.LEFT_SHOULDER: ("LeftArm",),
    CoreJoint.LEFT_ELBOW: ("LeftForeArm",),
    CoreJoint.LEFT_WRIST: ("LeftHand",),
    CoreJoint.RIGHT_SHOULDER: ("RightArm",),
    CoreJoint.RIGHT_ELBOW: ("RightForeArm",),
    CoreJoint.RIGHT_WRIST: ("RightHand",),
}

NAMES: Mapping[str, CoreNames] = {
    "CMU": {
        CoreJoint.HEAD: ("Head_end",),
        CoreJoint.NECK: ("Neck1",),
        CoreJoint.NAVEL: ("Spine",),
        **_ARMS,
    },
    "Mixamo": {
        CoreJoint.HEAD: ("Head", "HeadTop_End"),
        CoreJoint.NECK: ("Neck",),
        CoreJoint.NAVEL: ("Spine1",),
        **_ARMS,
    },
}
"""The joints of the two wide-spread kinds of files, tried in this order; what stands before a
colon (``mixamorig:Head``) does not count. CMU's are those that ``models.data.cmu`` takes. Mixamo's
head joint is at the base of the skull, so the middle of the head is between it and the top."""


def read_bvh_motion(path: Path, *, scale: float, names: CoreNames | None = None) -> MotionSequence:
    """Read one recording as 25 Hz core joints in the camera frame, facing the sensor.

    As with the other captures, the root's translation and rotation are dropped. The subject is
    the name of the file's folder, the label that of the file.

    Args:
        path: A file whose body, without the root's rotation, stands along y and looks along z.
        scale: Metres a unit of the file: 0.01 for centimetres, 0.0254 / 0.45 for CMU's files.
        names: Joints of the file for each core joint, where ``NAMES`` does not fit.

    Raises:
        InvalidInput: If the file does not fit the format, a joint is not there, or what comes out
            is no body of a person's size that looks along z.
    """
    bvh = parse_bvh(path)
    at = {name.rpartition(":")[2]: index for index, name in enumerate(bvh.names)}
    table = _table(path, at, NAMES if names is None else {"names": _complete(names)})
    positions = bvh.positions(still_root=True) * scale
    core = np.stack(
        [positions[:, [at[name] for name in table[joint]]].mean(axis=1) for joint in CoreJoint],
        axis=1,
    )
    _check_body(path, core, scale)
    return facing_sensor(
        core, bvh.rate_hz, subject=path.parent.name, label=path.stem, source=SOURCE
    )


def _complete(names: CoreNames) -> CoreNames:
    """The same names, if there are some for every core joint."""
    for joint in CoreJoint:
        if not names.get(joint):
            raise InvalidInput(
                f"names has nothing for {joint.name}: give the joints whose mean it is",
                field="names",
                code="missing",
            )
    return names


def _table(path: Path, at: Mapping[str, int], tables: Mapping[str, CoreNames]) -> CoreNames:
    """The first table of which the file has all joints."""
    complaints = []
    for kind, table in tables.items():
        missing = [name for joint in CoreJoint for name in table[joint] if name not in at]
        if not missing:
            return table
        complaints.append(f"{', '.join(missing)} of {kind}")
    raise InvalidInput(
        f"{path} has the joints {', '.join(at)}, and lacks {'; '.join(complaints)}: give names, "
        "the joints of the file for each core joint",
        field="names",
        code="unknown_joints",
    )


def _check_body(path: Path, core: Float64, scale: float) -> None:
    """Refuse a wrong scale, and a file with other axes."""
    mean = core.mean(axis=0)
    trunk = float(np.linalg.norm(core[:, CoreJoint.NECK] - core[:, CoreJoint.NAVEL], axis=1).mean())
    if not TRUNK_M[0] <= trunk <= TRUNK_M[1]:
        raise InvalidInput(
            f"{path}: with scale {scale:g} the navel is {trunk:.3g} m from the neck, expected "
            f"{TRUNK_M[0]} to {TRUNK_M[1]} m: give the metres that a unit of the file has",
            field="scale",
            code="scale",
        )
    upright = mean[CoreJoint.NECK, 1] > mean[CoreJoint.NAVEL, 1]
    forwards = mean[CoreJoint.LEFT_SHOULDER, 0] > mean[CoreJoint.RIGHT_SHOULDER, 0]
    if not (upright and forwards):
        raise InvalidInput(
            f"{path}: without the root's rotation the body does not stand along y and look along "
            "z: export the file with y up and z forwards",
            field="axes",
            code="axes",
        )
