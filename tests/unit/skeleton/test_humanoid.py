"""Bone rotations against an independent forward kinematics by matrices."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agent_server.domain.skeleton import CoreJoint as J
from agent_server.skeleton.humanoid import (
    HUMAN_BONE_NAMES,
    HUMAN_BONE_PARENTS,
    REST_OFFSETS,
    REST_ROTATIONS,
    human_rotations,
    to_unity,
)
from agent_server.skeleton.humanoid import HumanBone as B
from tests.support.bodies import CORE_POSE

law = settings(derandomize=True, deadline=None, max_examples=150)

# Faces the sensor, arms straight out; the person's right is +x in the camera frame.
T_POSE = np.array(
    [
        *((0.0, 0.60, 2.0), (0.0, 0.40, 2.0), (0.0, 0.0, 2.0)),
        *((-0.18, 0.35, 2.0), (-0.48, 0.35, 2.0), (-0.73, 0.35, 2.0)),
        *((0.18, 0.35, 2.0), (0.48, 0.35, 2.0), (0.73, 0.35, 2.0)),
    ],
    np.float32,
)
STANDING = np.float32(list(CORE_POSE.values()))
RIGHT, UP, FORWARD = np.eye(3)
S = np.sqrt(0.5)

# Bone, direction at rest in Unity's axes, and the core joints between which it lies.
DIRECTIONS = [
    (B.CHEST, UP, J.NAVEL, J.NECK),
    (B.NECK, UP, J.NECK, J.HEAD),
    (B.LEFT_UPPER_ARM, -RIGHT, J.LEFT_SHOULDER, J.LEFT_ELBOW),
    (B.LEFT_LOWER_ARM, -RIGHT, J.LEFT_ELBOW, J.LEFT_WRIST),
    (B.RIGHT_UPPER_ARM, RIGHT, J.RIGHT_SHOULDER, J.RIGHT_ELBOW),
    (B.RIGHT_LOWER_ARM, RIGHT, J.RIGHT_ELBOW, J.RIGHT_WRIST),
]


def matrix(q):
    """Rotation matrix of a quaternion x, y, z, w, which is the same in either handedness."""
    x, y, z, w = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def forward(rotations):
    """Global orientation of every bone, shape (11, 3, 3)."""
    found = []
    for q, parent in zip(rotations, HUMAN_BONE_PARENTS, strict=True):
        found.append(matrix(q) if parent is None else found[parent] @ matrix(q))
    return np.stack(found)


def direction(pose, start, end):
    """From one joint to another, in Unity's axes."""
    bone = to_unity(pose[end] - pose[start])
    return bone / np.linalg.norm(bone)


def turn(axis, angle):
    """Matrix of a rotation of the camera frame."""
    return matrix((*(np.sin(angle / 2) * np.asarray(axis)), np.cos(angle / 2)))


def moved(**joints):
    """The T-pose with some joints elsewhere."""
    pose = T_POSE.copy()
    for name, position in joints.items():
        pose[J[name.upper()]] = position
    return pose


@st.composite
def poses(draw):
    """Any nine joints that are well apart and whose trunk is no line."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    pose = (T_POSE + rng.normal(size=(9, 3)) * draw(st.floats(0.02, 0.3))).astype(np.float32)
    bones = [pose[end] - pose[start] for _, _, start, end in DIRECTIONS]
    up = direction(pose, J.NAVEL, J.NECK)
    across = direction(pose, J.LEFT_SHOULDER, J.RIGHT_SHOULDER)
    if np.linalg.norm(bones, axis=1).min() < 0.02 or np.linalg.norm(np.cross(up, across)) < 0.1:
        return draw(st.just(T_POSE))
    return pose


def test_names_are_unitys():
    assert HUMAN_BONE_NAMES[B.HIPS] == "Hips"
    assert HUMAN_BONE_NAMES[B.RIGHT_LOWER_ARM] == "RightLowerArm"


def test_a_person_who_faces_the_sensor_is_an_avatar_that_faces_forward():
    towards_sensor = np.float32([0, 0, -1])
    to_their_right = T_POSE[J.RIGHT_WRIST] - T_POSE[J.LEFT_WRIST]
    assert to_unity(towards_sensor).tolist() == FORWARD.tolist()
    assert to_unity(to_their_right) @ RIGHT > 0
    # Unity is left-handed: right x up is forward in its axes, and backward in a camera's.
    frame = to_unity(np.eye(3, dtype=np.float32))
    assert np.linalg.det(frame) == -1


def test_rest_is_a_symmetric_t_pose_of_a_plausible_adult():
    at = []
    for offset, parent in zip(REST_OFFSETS, HUMAN_BONE_PARENTS, strict=True):
        at.append(offset if parent is None else at[parent] + offset)
    assert at[B.LEFT_LOWER_ARM] == pytest.approx(at[B.RIGHT_LOWER_ARM] * (-1, 1, 1))
    assert at[B.RIGHT_LOWER_ARM][0] > at[B.RIGHT_UPPER_ARM][0] > at[B.RIGHT_SHOULDER][0] > 0
    assert 0.8 < at[B.HIPS][1] < at[B.SPINE][1] < at[B.NECK][1] < at[B.HEAD][1] < 1.7


def test_the_t_pose_is_identity():
    assert human_rotations(T_POSE) == pytest.approx(REST_ROTATIONS, abs=1e-6)


@pytest.mark.parametrize(
    ("pose", "bone", "expected"),
    [
        # A turn about z takes the right arm from +x to +y.
        (
            moved(right_elbow=(0.18, 0.65, 2.0), right_wrist=(0.18, 0.9, 2.0)),
            B.RIGHT_UPPER_ARM,
            (0, 0, S, S),
        ),
        (
            moved(left_elbow=(-0.18, 0.65, 2.0), left_wrist=(-0.18, 0.9, 2.0)),
            B.LEFT_UPPER_ARM,
            (0, 0, -S, S),
        ),
        # The right forearm bends to the front about -y, the upper arm stays.
        (moved(right_wrist=(0.48, 0.35, 1.75)), B.RIGHT_LOWER_ARM, (0, -S, 0, S)),
        (moved(right_wrist=(0.48, 0.35, 1.75)), B.RIGHT_UPPER_ARM, (0, 0, 0, 1)),
        (moved(left_wrist=(-0.48, 0.35, 1.75)), B.LEFT_LOWER_ARM, (0, S, 0, S)),
        # The head sinks onto the chest: +y goes to +z about +x.
        (moved(head=(0.0, 0.40, 1.8)), B.NECK, (S, 0, 0, S)),
    ],
)
def test_rotation_by_hand(pose, bone, expected):
    assert human_rotations(pose)[bone] == pytest.approx(expected, abs=1e-6)


def test_the_elbow_is_a_hinge():
    # Upper arms out, forearms up: the upper arms roll backwards, the forearms bend about y.
    rotations = human_rotations(moved(right_wrist=(0.48, 0.6, 2.0), left_wrist=(-0.48, 0.6, 2.0)))
    # Not the whole quarter turn: a fifth of the smallest rotation's front is left in the hinge.
    roll, rest = np.arctan2(1.0, 0.2), np.arctan2(0.2, 1.0)
    rolled = (-np.sin(roll / 2), 0, 0, np.cos(roll / 2))
    assert rotations[B.RIGHT_UPPER_ARM] == pytest.approx(rolled, abs=1e-6)
    assert rotations[B.LEFT_UPPER_ARM] == pytest.approx(rolled, abs=1e-6)
    bent = np.array((0, -S * np.cos(rest), S * np.sin(rest), S))
    assert rotations[B.RIGHT_LOWER_ARM] == pytest.approx(bent, abs=1e-6)
    assert rotations[B.LEFT_LOWER_ARM] == pytest.approx(bent * (1, -1, -1, 1), abs=1e-6)


def test_somebody_with_their_back_to_the_sensor_turns_the_hips_only():
    rotations = human_rotations(T_POSE * np.float32([-1, 1, -1]) + np.float32([0, 0, 4]))
    assert np.abs(rotations[B.HIPS]) == pytest.approx((0, 1, 0, 0), abs=1e-6)
    assert rotations[1:] == pytest.approx(REST_ROTATIONS[1:], abs=1e-6)


def test_leaning_leaves_the_hips_upright():
    lean = (T_POSE - T_POSE[J.NAVEL]) @ turn((1, 0, 0), -0.6).T.astype(np.float32)
    rotations = human_rotations(lean)
    forwards = (np.sin(0.15), 0, 0, np.cos(0.15))
    assert rotations[B.HIPS] == pytest.approx((0, 0, 0, 1), abs=1e-6)
    assert rotations[B.SPINE] == pytest.approx(forwards, abs=1e-6)
    assert rotations[B.CHEST] == pytest.approx(forwards, abs=1e-6)
    assert direction(lean, J.NAVEL, J.NECK)[2] > 0.5, "that was forwards"


@law
@given(poses())
def test_forward_kinematics_gives_the_joints_back(pose):
    rotations = human_rotations(pose)
    assert np.linalg.norm(rotations, axis=1) == pytest.approx(np.ones(len(B)), abs=1e-12)
    assert (rotations[:, 3] >= -1e-9).all()
    orientation = forward(rotations)
    for bone, rest, start, end in DIRECTIONS:
        wanted = direction(pose, start, end)
        assert orientation[bone] @ rest == pytest.approx(wanted, abs=1e-6), bone.name
    across = direction(pose, J.LEFT_SHOULDER, J.RIGHT_SHOULDER)
    right, _, front = orientation[B.CHEST].T
    assert across @ front == pytest.approx(0, abs=1e-6)
    assert across @ right > 0


@law
@given(poses(), st.floats(0.3, 3.0), st.tuples(*[st.floats(-3, 3)] * 3))
def test_size_and_place_change_nothing(pose, scale, shift):
    elsewhere = pose.astype(np.float64) * scale + shift
    assert human_rotations(elsewhere) == pytest.approx(human_rotations(pose), abs=1e-6)


@law
@given(poses(), st.floats(-np.pi, np.pi))
def test_a_turn_about_the_vertical_turns_the_hips_and_nothing_else(pose, angle):
    rotated = pose.astype(np.float64) @ turn((0, 1, 0), angle).T
    before, after = human_rotations(pose), human_rotations(rotated)
    # Mirrored axes turn the other way round.
    assert matrix(after[B.HIPS]) == pytest.approx(
        turn((0, 1, 0), -angle) @ matrix(before[B.HIPS]), abs=1e-5
    )
    for bone in B:
        if bone is not B.HIPS:
            assert matrix(after[bone]) == pytest.approx(matrix(before[bone]), abs=1e-5)


@law
@given(poses(), st.tuples(*[st.floats(-1, 1)] * 3), st.floats(-np.pi, np.pi))
def test_neck_and_arms_do_not_see_how_the_body_is_turned(pose, axis, angle):
    axis = np.array(axis) if np.linalg.norm(axis) > 0.1 else UP
    rotated = pose.astype(np.float64) @ turn(axis / np.linalg.norm(axis), angle).T
    before, after = human_rotations(pose), human_rotations(rotated)
    for bone in list(B)[B.NECK :]:
        assert matrix(after[bone]) == pytest.approx(matrix(before[bone]), abs=1e-5)


@law
@given(poses())
def test_a_mirrored_person_is_a_mirrored_avatar(pose):
    sides = [J.HEAD, J.NECK, J.NAVEL, *range(6, 9), *range(3, 6)]
    bones = [*range(5), *range(8, 11), *range(5, 8)]
    mirrored = pose[sides] * np.float32([-1, 1, 1])
    # A reflection in x keeps the x part of a turn and reverses y and z.
    assert human_rotations(mirrored) == pytest.approx(
        human_rotations(pose)[bones] * (1, -1, -1, 1), abs=1e-5
    )


def test_standing_with_hanging_arms_bends_elbows_forwards():
    rotations = human_rotations(STANDING)
    assert rotations[B.RIGHT_LOWER_ARM][1] < 0 < rotations[B.LEFT_LOWER_ARM][1]


@pytest.mark.parametrize("bad", ["coincide", "nan", "inf"])
@pytest.mark.parametrize(
    ("joints", "anchor", "kept"),
    [
        ([J.HEAD], J.NECK, [B.NECK]),
        ([J.RIGHT_WRIST], J.RIGHT_ELBOW, [B.RIGHT_LOWER_ARM]),
        ([J.LEFT_ELBOW, J.LEFT_WRIST], J.LEFT_SHOULDER, [B.LEFT_UPPER_ARM, B.LEFT_LOWER_ARM]),
        (list(J), J.NAVEL, list(B)),
    ],
)
def test_what_gives_no_direction_keeps_its_rotation(bad, joints, anchor, kept):
    before = human_rotations(STANDING)
    pose = T_POSE.copy()
    pose[joints] = T_POSE[anchor] if bad == "coincide" else np.float32(bad)
    after = human_rotations(pose, before)
    assert after[kept].tolist() == before[kept].tolist()
    assert np.isfinite(after).all()


def test_a_trunk_without_width_keeps_hips_spine_and_chest():
    before = human_rotations(T_POSE[:, [2, 1, 0]] * np.float32([1, 1, -1]))
    after = human_rotations(moved(left_shoulder=(0.18, 0.35, 2.0)), before)
    assert after[: B.NECK].tolist() == before[: B.NECK].tolist()


@pytest.mark.parametrize(
    "pose",
    [
        moved(head=(0.0, 0.1, 2.0)),
        moved(right_elbow=(-0.2, 0.35, 2.0), right_wrist=(-0.4, 0.35, 2.0)),
        moved(right_wrist=(0.2, 0.35, 2.0), left_wrist=(-0.2, 0.35, 2.0)),
        T_POSE * np.float32([1, -1, 1]),
        T_POSE * np.float32([-1, -1, 1]),
    ],
    ids=["head down", "arm across", "folded arms", "upside down", "on the head"],
)
def test_opposite_directions_are_still_rotations(pose):
    orientation = forward(human_rotations(pose))
    for bone, rest, start, end in DIRECTIONS:
        assert orientation[bone] @ rest == pytest.approx(direction(pose, start, end), abs=1e-6)
