"""Every format against one golden pose: a T-pose with the right hand up.

The pose is written in terms of the person (to their right, upwards, away from the sensor), and
each sensor's way of writing that down is spelled out here a second time, from its own
documentation, so that a wrong axis or a swapped side in the table shows.
"""

import numpy as np
import pytest

from agent_server.domain.skeleton import CoreJoint, SkeletonFrame
from agent_server.errors import InvalidInput
from agent_server.skeleton.formats import FORMATS, get_format
from agent_server.skeleton.retarget import Retargeter, navel_distance

# Core joint -> metres to the person's right, up from the sensor, away from it. The person faces
# the sensor; the left arm is stretched sideways, the right hand is over the head.
GOLDEN = {
    CoreJoint.HEAD: (0.10, 0.60, 2.00),
    CoreJoint.NECK: (0.10, 0.40, 2.00),
    CoreJoint.NAVEL: (0.10, 0.00, 2.00),
    CoreJoint.LEFT_SHOULDER: (-0.08, 0.36, 2.00),
    CoreJoint.LEFT_ELBOW: (-0.36, 0.36, 2.00),
    CoreJoint.LEFT_WRIST: (-0.62, 0.36, 2.00),
    CoreJoint.RIGHT_SHOULDER: (0.28, 0.36, 2.00),
    CoreJoint.RIGHT_ELBOW: (0.50, 0.52, 1.95),
    CoreJoint.RIGHT_WRIST: (0.48, 0.80, 1.90),
}

# Format -> what its documentation calls the core joints, in the order of CoreJoint.
NATIVE_NAMES = {
    "kinect_v2": "head spine_shoulder spine_mid shoulder_left elbow_left wrist_left "
    "shoulder_right elbow_right wrist_right",
    "ntu": "head spine_shoulder spine_mid shoulder_left elbow_left wrist_left "
    "shoulder_right elbow_right wrist_right",
    "kinect_v1": "head shoulder_center spine shoulder_left elbow_left wrist_left "
    "shoulder_right elbow_right wrist_right",
    "utd_mhad": "head shoulder_center spine shoulder_left elbow_left wrist_left "
    "shoulder_right elbow_right wrist_right",
    "azure_kinect": "head neck spine_navel shoulder_left elbow_left wrist_left "
    "shoulder_right elbow_right wrist_right",
    "core9": "head neck navel left_shoulder left_elbow left_wrist "
    "right_shoulder right_elbow right_wrist",
}


def kinect(right: float, up: float, away: float) -> tuple[float, float, float]:
    """A Kinect's x grows to its own left, which is the person's right."""
    return right, up, away


def azure(right: float, up: float, away: float) -> tuple[float, float, float]:
    """Millimetres, x to the right of the depth image, y down."""
    return -1000 * right, -1000 * up, 1000 * away


def write_down(name: str) -> SkeletonFrame:
    table = FORMATS[name]
    write = azure if name == "azure_kinect" else kinect
    joints = np.zeros((len(table.names), 4), np.float32)
    for joint, native in zip(CoreJoint, NATIVE_NAMES[name].split(), strict=True):
        joints[table.names.index(native)] = *write(*GOLDEN[joint]), 0.25
    return SkeletonFrame(40_000_000, 5, name, joints)


@pytest.mark.parametrize("name", NATIVE_NAMES)
def test_golden_pose_arrives_in_the_camera_frame(name: str) -> None:
    frame = write_down(name)
    core = Retargeter().push(frame)
    assert core is not None
    assert (core.stamp_ns, core.body_id) == (40_000_000, 5)
    np.testing.assert_allclose(core.positions, list(GOLDEN.values()), atol=1e-6)
    np.testing.assert_array_equal(core.confidence, np.full(9, 0.25))
    assert navel_distance(frame) == pytest.approx(2.0)


def test_blazepose_world_landmarks_become_a_body_around_its_hips() -> None:
    # x to the right of the image, y down, z away from the camera, origin between the hips; each
    # landmark is (to the person's right, up, away) of the middle of the hips.
    body = {
        "left_ear": (-0.08, 0.72, 0.0),
        "right_ear": (0.08, 0.72, 0.0),
        "left_shoulder": (-0.18, 0.46, 0.0),
        "right_shoulder": (0.18, 0.46, 0.0),
        "left_elbow": (-0.46, 0.46, 0.0),
        "right_elbow": (0.40, 0.62, -0.05),
        "left_wrist": (-0.72, 0.46, 0.0),
        "right_wrist": (0.38, 0.90, -0.10),
        "left_hip": (-0.1, 0.0, 0.0),
        "right_hip": (0.1, 0.0, 0.0),
    }
    table = FORMATS["blazepose"]
    joints = np.ones((33, 4), np.float32)
    for name, (right, up, away) in body.items():
        joints[table.names.index(name)] = -right, -up, away, 0.9
    joints[table.names.index("right_ear"), 3] = 0.4
    core = Retargeter().push(SkeletonFrame(0, 1, "blazepose", joints))
    assert core is not None
    np.testing.assert_allclose(
        core.positions,
        [
            (0.0, 0.72, 0.0),
            (0.0, 0.46 + 0.2 * (0.72 - 0.46), 0.0),
            (0.0, 0.23, 0.0),
            *((-0.18, 0.46, 0.0), (-0.46, 0.46, 0.0), (-0.72, 0.46, 0.0)),
            *((0.18, 0.46, 0.0), (0.40, 0.62, -0.05), (0.38, 0.90, -0.10)),
        ],
        atol=1e-6,
    )
    # The head and the neck are no more certain than the ear that is hardly seen.
    np.testing.assert_allclose(core.confidence, [0.4, 0.4, *[0.9] * 7], atol=1e-6)
    assert navel_distance(SkeletonFrame(0, 1, "blazepose", joints)) == pytest.approx(0.0)


# Spot checks against the enumerations of each SDK; the count is the format's own.
@pytest.mark.parametrize(
    ("name", "count", "known"),
    [
        ("kinect_v2", 25, {0: "spine_base", 3: "head", 8: "shoulder_right", 20: "spine_shoulder"}),
        ("kinect_v2", 25, {12: "hip_left", 21: "hand_tip_left", 24: "thumb_right"}),
        ("ntu", 25, {1: "spine_mid", 20: "spine_shoulder"}),
        (
            "kinect_v1",
            20,
            {0: "hip_center", 1: "spine", 3: "head", 6: "wrist_left", 11: "hand_right"},
        ),
        ("azure_kinect", 32, {1: "spine_navel", 3: "neck", 7: "wrist_left", 12: "shoulder_right"}),
        ("azure_kinect", 32, {18: "hip_left", 26: "head", 27: "nose", 31: "ear_right"}),
        ("blazepose", 33, {0: "nose", 7: "left_ear", 12: "right_shoulder", 15: "left_wrist"}),
        ("blazepose", 33, {23: "left_hip", 28: "right_ankle", 32: "right_foot_index"}),
        ("utd_mhad", 20, {0: "head", 1: "shoulder_center", 2: "spine", 3: "hip_center"}),
        ("utd_mhad", 20, {4: "shoulder_left", 10: "wrist_right", 19: "foot_right"}),
        ("core9", 9, {0: "head", 2: "navel", 8: "right_wrist"}),
    ],
)
def test_joint_order(name: str, count: int, known: dict[int, str]) -> None:
    names = get_format(name).names
    assert len(names) == len(set(names)) == count
    assert {index: names[index] for index in known} == known


@pytest.mark.parametrize("name", FORMATS)
def test_table_is_consistent(name: str) -> None:
    table = FORMATS[name]
    assert table.name == name
    for parent, child in table.bones:
        assert 0 <= parent < len(table.names)
        assert 0 <= child < len(table.names)
        assert parent != child
    assert len(set(map(frozenset, table.bones))) == len(table.bones)
    assert len(table.core) == 9
    for shares in table.core:
        assert {joint for joint, _ in shares} <= set(table.names)
        assert sum(weight for _, weight in shares) == pytest.approx(1.0)


@pytest.mark.parametrize("name", ["kinect_v2", "kinect_v1", "azure_kinect", "utd_mhad", "core9"])
def test_bones_form_one_tree(name: str) -> None:
    table = FORMATS[name]
    assert len(table.bones) == len(table.names) - 1
    assert len({child for _, child in table.bones}) == len(table.bones)


def test_unknown_format_is_refused_with_the_known_ones() -> None:
    with pytest.raises(InvalidInput, match=r"'kinect_v3' is not known.*kinect_v2.*core9") as caught:
        get_format("kinect_v3")
    assert (caught.value.field, caught.value.code) == ("format", "unknown_format")
