"""From the nine core joints to the local rotations of a humanoid avatar's bones.

The avatar is Unity's humanoid: left-handed axes in metres, y up. At rest it stands in a T-pose and
faces +z, its right hand at +x, and all its bones have the identity rotation. Rotations are unit
quaternions x, y, z, w, relative to the parent bone.

What nine joints leave open is settled thus:

- The hips take the turn about the vertical alone, so that legs that nobody sees stay upright. What
  the upper body leans and twists besides is shared evenly by spine and chest.
- The neck points to the head by the smallest rotation, without twist, and the head follows it.
- The shoulders stay at rest; the arms begin at the chest.
- The elbow is a hinge: an upper arm is twisted about itself so that the forearm bends towards its
  own z axis, as in a T-pose with the palms down. The straighter an arm, the less its bend says, and
  the more the twist is that of the smallest rotation from rest. A forearm is not twisted.
"""

from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike

from agent_server.domain.arrays import Float32, Float64
from agent_server.domain.skeleton import CoreJoint


class HumanBone(IntEnum):
    """Index of each bone in every array whose bone axis has length 11; a parent comes first."""

    HIPS = 0
    SPINE = 1
    CHEST = 2
    NECK = 3
    HEAD = 4
    LEFT_SHOULDER = 5
    LEFT_UPPER_ARM = 6
    LEFT_LOWER_ARM = 7
    RIGHT_SHOULDER = 8
    RIGHT_UPPER_ARM = 9
    RIGHT_LOWER_ARM = 10


HUMAN_BONE_NAMES: tuple[str, ...] = tuple(bone.name.title().replace("_", "") for bone in HumanBone)
"""As Unity's ``HumanBodyBones`` has them, for example ``LeftUpperArm``."""

HUMAN_BONE_PARENTS: tuple[HumanBone | None, ...] = (
    None,
    HumanBone.HIPS,
    HumanBone.SPINE,
    HumanBone.CHEST,
    HumanBone.NECK,
    HumanBone.CHEST,
    HumanBone.LEFT_SHOULDER,
    HumanBone.LEFT_UPPER_ARM,
    HumanBone.CHEST,
    HumanBone.RIGHT_SHOULDER,
    HumanBone.RIGHT_UPPER_ARM,
)


def _constant(values: ArrayLike) -> Float64:
    array = np.array(values, dtype=np.float64)
    array.flags.writeable = False
    return array


REST_ROTATIONS = _constant([(0.0, 0.0, 0.0, 1.0)] * len(HumanBone))
"""Shape (11, 4), read-only: the T-pose."""

REST_OFFSETS = _constant(
    [
        *((0.0, 0.92, 0.0), (0.0, 0.10, 0.0), (0.0, 0.13, 0.0), (0.0, 0.28, 0.0), (0.0, 0.09, 0.0)),
        *((-0.03, 0.24, 0.0), (-0.15, 0.0, 0.0), (-0.316, 0.0, 0.0)),
        *((0.03, 0.24, 0.0), (0.15, 0.0, 0.0), (0.316, 0.0, 0.0)),
    ]
)
"""Shape (11, 3), read-only: where each bone begins, from its parent's beginning (the hips: from
the floor), metres in Unity's axes. An adult of 1.70 m; shoulders and arms after Drillis and
Contini 1966, what lies within the trunk is only plausible."""

_X, _Y, _Z = (_constant(axis) for axis in np.eye(3))

_TINY = 1e-3
"""Joints nearer than this, in metres, give no direction."""

_STRAIGHT = 0.2
"""Sine of the bend at which the elbow's hinge and the smallest rotation have equal weight."""

_ARMS = (
    (-_X, HumanBone.LEFT_UPPER_ARM, HumanBone.LEFT_LOWER_ARM, CoreJoint.LEFT_SHOULDER),
    (_X, HumanBone.RIGHT_UPPER_ARM, HumanBone.RIGHT_LOWER_ARM, CoreJoint.RIGHT_SHOULDER),
)
"""Direction at rest, upper and lower arm, and the shoulder, which elbow and wrist follow."""


def to_unity(points: Float32) -> Float64:
    """Points or directions of the camera frame in Unity's left-handed axes.

    x and y stay and z is negated, which is negating x, as is usual for Unity, and half a turn
    about the vertical. Somebody who faces the sensor then is an avatar that faces +z, which is
    where an avatar at rest looks and where programs have their camera; the person's right hand
    is the avatar's right hand.

    Args:
        points: Shape (..., 3), in the camera frame.

    Returns:
        Shape (..., 3), in the same unit.
    """
    return np.asarray(points, dtype=np.float64) * (1.0, 1.0, -1.0)


def human_rotations(positions: Float32, previous: Float64 = REST_ROTATIONS) -> Float64:
    """Local rotations of the bones in which the avatar's joints lie in the body's directions.

    Args:
        positions: Shape (9, 3), the core joints in metres in the camera frame.
        previous: Shape (11, 4), the rotations of the frame before. A bone whose joints coincide,
            or are not finite, keeps its rotation from there.

    Returns:
        Shape (11, 4), read-only: unit quaternions x, y, z, w, relative to the parent. None turns
        by more than half a turn (w >= 0, to rounding), so none changes its sign between frames.
    """
    joints = to_unity(positions)
    joints[~np.isfinite(joints)] = np.nan  # as infinite ones would warn when subtracted
    rotations = previous.copy()
    _turn_torso(joints, rotations)
    to_chest = _inverse(
        _multiply(
            _multiply(rotations[HumanBone.HIPS], rotations[HumanBone.SPINE]),
            rotations[HumanBone.CHEST],
        )
    )
    head = _unit(_rotate(to_chest, joints[CoreJoint.HEAD] - joints[CoreJoint.NECK]))
    if head is not None:
        rotations[HumanBone.NECK] = _swing(_Y, head, _X)
    for rest, upper, lower, shoulder in _ARMS:
        arm = _unit(_rotate(to_chest, joints[shoulder + 1] - joints[shoulder]))
        forearm = _unit(_rotate(to_chest, joints[shoulder + 2] - joints[shoulder + 1]))
        if arm is not None:
            rotations[upper] = _turn_upper_arm(rest, arm, forearm)
        if forearm is not None:
            in_arm = _rotate(_inverse(rotations[upper]), forearm)
            rotations[lower] = _swing(rest, in_arm, _Y)
    rotations.flags.writeable = False
    return rotations


def _turn_torso(joints: Float64, rotations: Float64) -> None:
    """Set hips, spine and chest, unless shoulders and spine give no frame."""
    up = _unit(joints[CoreJoint.NECK] - joints[CoreJoint.NAVEL])
    if up is None:
        return
    across = joints[CoreJoint.RIGHT_SHOULDER] - joints[CoreJoint.LEFT_SHOULDER]
    right = _unit(across - (across @ up) * up)
    if right is None:
        return
    raised = _swing(_Y, up, _X)
    torso = _multiply(_swing(_rotate(raised, _X), right, up), raised)
    # The part of a rotation that turns about y; upside down there is none.
    turn = torso * (0.0, 1.0, 0.0, 1.0)
    size = np.linalg.norm(turn)
    if size > _TINY:
        rotations[HumanBone.HIPS] = turn / size
    bend = _multiply(_inverse(rotations[HumanBone.HIPS]), torso)
    half = bend + REST_ROTATIONS[0]
    rotations[[HumanBone.SPINE, HumanBone.CHEST]] = half / np.linalg.norm(half)


def _turn_upper_arm(rest: Float64, arm: Float64, forearm: Float64 | None) -> Float64:
    """Rotation of an upper arm by its direction and its forearm's, both in the chest's axes."""
    turn = _swing(rest, arm, _Y)
    if forearm is None:
        return turn
    front = _rotate(turn, _Z)
    hinge = _unit(forearm - (forearm @ arm) * arm + _STRAIGHT * front)
    return turn if hinge is None else _multiply(_swing(front, hinge, arm), turn)


def _unit(vector: Float64) -> Float64 | None:
    """The direction of a vector (3,), or None where it has none."""
    length = float(np.linalg.norm(vector))
    return vector / length if _TINY < length < np.inf else None


def _swing(start: Float64, end: Float64, spare: Float64) -> Float64:
    """The smallest rotation from one direction to another; about ``spare`` if they are opposite."""
    half = np.append(_cross(start, end), 1.0 + start @ end)
    size = np.linalg.norm(half)
    return half / size if size > 1e-9 else np.append(spare, 0.0)


def _multiply(a: Float64, b: Float64) -> Float64:
    """The rotation ``b``, then ``a``."""
    vector = a[3] * b[:3] + b[3] * a[:3] + _cross(a[:3], b[:3])
    return np.append(vector, a[3] * b[3] - a[:3] @ b[:3])


def _inverse(rotation: Float64) -> Float64:
    return np.append(-rotation[:3], rotation[3])


def _rotate(rotation: Float64, vector: Float64) -> Float64:
    axis = rotation[:3]
    twice = 2.0 * _cross(axis, vector)
    turned: Float64 = vector + rotation[3] * twice + _cross(axis, twice)
    return turned


def _cross(a: Float64, b: Float64) -> Float64:
    ax, ay, az = a.tolist()  # on three numbers far faster than numpy.cross
    bx, by, bz = b.tolist()
    return np.array((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx))
