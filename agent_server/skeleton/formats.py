"""The joint table of every body format that a sensor may speak.

A table says what the joints are called, which of them are joined (for drawing), and how they
become the nine core joints in the canonical camera frame (:mod:`agent_server.domain.skeleton`):
metres, x to the person's right when they face the sensor, y up, z from the sensor to the
person. "Left" and "right" are the person's own in every format.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from types import MappingProxyType

from agent_server.domain.skeleton import CORE_BONES, CORE_JOINT_NAMES
from agent_server.errors import InvalidInput

Share = tuple[str, float]
"""A joint's name and its weight in a mean; the weights of a core joint sum to 1."""


@dataclass(frozen=True, slots=True)
class JointFormat:
    """How one kind of sensor describes a body.

    Attributes:
        name: What skeleton messages call it.
        names: The joints in the order in which they are sent.
        bones: (parent, child) indices into ``names``, outwards from the trunk.
        unit_m: Length of one unit of the coordinates, in metres.
        axes: Sign of each coordinate on its way to the canonical x, y and z.
        core: For each of the nine core joints the joints whose weighted mean it is.
        relative: Whether the origin moves with the body, so that its distance from the sensor
            is unknown.
    """

    name: str
    names: tuple[str, ...]
    bones: tuple[tuple[int, int], ...]
    unit_m: float
    axes: tuple[float, float, float]
    core: tuple[tuple[Share, ...], ...]
    relative: bool = False


def get_format(name: str) -> JointFormat:
    """The joint table called ``name``.

    Raises:
        InvalidInput: If there is none.
    """
    try:
        return FORMATS[name]
    except KeyError:
        raise InvalidInput(
            f"format {name!r} is not known: send one of {', '.join(FORMATS)}",
            field="format",
            code="unknown_format",
        ) from None


_CAMERA = (1.0, 1.0, 1.0)
_IMAGE = (-1.0, -1.0, 1.0)
"""x to the right of the image, y down, z away from the camera."""


def _one_each(*joints: str) -> tuple[tuple[Share, ...], ...]:
    return tuple(((joint, 1.0),) for joint in joints)


def _chains(names: tuple[str, ...], *chains: str) -> tuple[tuple[int, int], ...]:
    """Bones along chains of joint names that are written as ``"a b c"``."""
    at = {name: index for index, name in enumerate(names)}
    return tuple(
        (at[parent], at[child])
        for chain in map(str.split, chains)
        for parent, child in pairwise(chain)
    )


# Kinect for Windows SDK 2, enumeration JointType.
_V2_NAMES = (
    *("spine_base", "spine_mid", "neck", "head"),
    *("shoulder_left", "elbow_left", "wrist_left", "hand_left"),
    *("shoulder_right", "elbow_right", "wrist_right", "hand_right"),
    *("hip_left", "knee_left", "ankle_left", "foot_left"),
    *("hip_right", "knee_right", "ankle_right", "foot_right"),
    *("spine_shoulder", "hand_tip_left", "thumb_left", "hand_tip_right", "thumb_right"),
)
_V2_BONES = _chains(
    _V2_NAMES,
    "spine_base spine_mid spine_shoulder neck head",
    "spine_shoulder shoulder_left elbow_left wrist_left hand_left hand_tip_left",
    "wrist_left thumb_left",
    "spine_shoulder shoulder_right elbow_right wrist_right hand_right hand_tip_right",
    "wrist_right thumb_right",
    "spine_base hip_left knee_left ankle_left foot_left",
    "spine_base hip_right knee_right ankle_right foot_right",
)
_V2_CORE = _one_each(
    *("head", "spine_shoulder", "spine_mid"),
    *("shoulder_left", "elbow_left", "wrist_left"),
    *("shoulder_right", "elbow_right", "wrist_right"),
)

# Kinect for Windows SDK 1, enumeration JointType.
_V1_NAMES = (
    *("hip_center", "spine", "shoulder_center", "head"),
    *("shoulder_left", "elbow_left", "wrist_left", "hand_left"),
    *("shoulder_right", "elbow_right", "wrist_right", "hand_right"),
    *("hip_left", "knee_left", "ankle_left", "foot_left"),
    *("hip_right", "knee_right", "ankle_right", "foot_right"),
)
# UTD-MHAD holds the same joints from the head downwards.
_UTD_NAMES = (*reversed(_V1_NAMES[:4]), *_V1_NAMES[4:])
_V1_CHAINS = (
    "hip_center spine shoulder_center head",
    "shoulder_center shoulder_left elbow_left wrist_left hand_left",
    "shoulder_center shoulder_right elbow_right wrist_right hand_right",
    "hip_center hip_left knee_left ankle_left foot_left",
    "hip_center hip_right knee_right ankle_right foot_right",
)
_V1_CORE = _one_each(
    *("head", "shoulder_center", "spine"),
    *("shoulder_left", "elbow_left", "wrist_left"),
    *("shoulder_right", "elbow_right", "wrist_right"),
)

# Azure Kinect Body Tracking SDK, enumeration k4abt_joint_id_t.
_AZURE_NAMES = (
    *("pelvis", "spine_navel", "spine_chest", "neck"),
    *("clavicle_left", "shoulder_left", "elbow_left", "wrist_left"),
    *("hand_left", "handtip_left", "thumb_left"),
    *("clavicle_right", "shoulder_right", "elbow_right", "wrist_right"),
    *("hand_right", "handtip_right", "thumb_right"),
    *("hip_left", "knee_left", "ankle_left", "foot_left"),
    *("hip_right", "knee_right", "ankle_right", "foot_right"),
    *("head", "nose", "eye_left", "ear_left", "eye_right", "ear_right"),
)
_AZURE_BONES = _chains(
    _AZURE_NAMES,
    "pelvis spine_navel spine_chest neck head nose",
    "spine_chest clavicle_left shoulder_left elbow_left wrist_left hand_left handtip_left",
    "wrist_left thumb_left",
    "spine_chest clavicle_right shoulder_right elbow_right wrist_right hand_right handtip_right",
    "wrist_right thumb_right",
    "pelvis hip_left knee_left ankle_left foot_left",
    "pelvis hip_right knee_right ankle_right foot_right",
    "head eye_left",
    "head ear_left",
    "head eye_right",
    "head ear_right",
)
_AZURE_CORE = _one_each(
    *("head", "neck", "spine_navel"),
    *("shoulder_left", "elbow_left", "wrist_left"),
    *("shoulder_right", "elbow_right", "wrist_right"),
)

# MediaPipe Pose, world landmarks: metres, origin midway between the hips, x right in the
# image, y down, z away from the camera. Image landmarks, which are in pixels, do not fit.
_BLAZE_NAMES = (
    "nose",
    *("left_eye_inner", "left_eye", "left_eye_outer"),
    *("right_eye_inner", "right_eye", "right_eye_outer"),
    *("left_ear", "right_ear", "mouth_left", "mouth_right"),
    *("left_shoulder", "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist"),
    *("left_pinky", "right_pinky", "left_index", "right_index", "left_thumb", "right_thumb"),
    *("left_hip", "right_hip", "left_knee", "right_knee", "left_ankle", "right_ankle"),
    *("left_heel", "right_heel", "left_foot_index", "right_foot_index"),
)
_BLAZE_BONES = _chains(
    _BLAZE_NAMES,
    "nose left_eye_inner left_eye left_eye_outer left_ear",
    "nose right_eye_inner right_eye right_eye_outer right_ear",
    "mouth_left mouth_right",
    "left_shoulder right_shoulder",
    "left_shoulder left_elbow left_wrist left_pinky left_index",
    "left_wrist left_index",
    "left_wrist left_thumb",
    "right_shoulder right_elbow right_wrist right_pinky right_index",
    "right_wrist right_index",
    "right_wrist right_thumb",
    "left_shoulder left_hip right_hip",
    "right_shoulder right_hip",
    "left_hip left_knee left_ankle left_heel left_foot_index",
    "left_ankle left_foot_index",
    "right_hip right_knee right_ankle right_heel right_foot_index",
    "right_ankle right_foot_index",
)
# It has no joint on the spine. A Kinect's base of the neck lies 5 to 8 cm above the middle of
# the shoulders, about a fifth of the way to the ears.
_BLAZE_CORE = (
    (("left_ear", 0.5), ("right_ear", 0.5)),
    (("left_shoulder", 0.4), ("right_shoulder", 0.4), ("left_ear", 0.1), ("right_ear", 0.1)),
    (
        *(("left_shoulder", 0.25), ("right_shoulder", 0.25)),
        *(("left_hip", 0.25), ("right_hip", 0.25)),
    ),
    *_one_each("left_shoulder", "left_elbow", "left_wrist"),
    *_one_each("right_shoulder", "right_elbow", "right_wrist"),
)

FORMATS: Mapping[str, JointFormat] = MappingProxyType(
    {
        table.name: table
        for table in (
            JointFormat("kinect_v2", _V2_NAMES, _V2_BONES, 1.0, _CAMERA, _V2_CORE),
            JointFormat(
                "kinect_v1", _V1_NAMES, _chains(_V1_NAMES, *_V1_CHAINS), 1.0, _CAMERA, _V1_CORE
            ),
            JointFormat("azure_kinect", _AZURE_NAMES, _AZURE_BONES, 0.001, _IMAGE, _AZURE_CORE),
            JointFormat(
                "blazepose", _BLAZE_NAMES, _BLAZE_BONES, 1.0, _IMAGE, _BLAZE_CORE, relative=True
            ),
            # NTU RGB+D recorded Kinect v2 bodies as they came.
            JointFormat("ntu", _V2_NAMES, _V2_BONES, 1.0, _CAMERA, _V2_CORE),
            JointFormat(
                "utd_mhad", _UTD_NAMES, _chains(_UTD_NAMES, *_V1_CHAINS), 1.0, _CAMERA, _V1_CORE
            ),
            JointFormat(
                "core9",
                CORE_JOINT_NAMES,
                tuple((int(parent), int(child)) for parent, child in CORE_BONES),
                1.0,
                _CAMERA,
                _one_each(*CORE_JOINT_NAMES),
            ),
        )
    }
)
"""Every format by name."""
