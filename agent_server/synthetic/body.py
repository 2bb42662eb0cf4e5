"""Forward geometry of a body: where all landmarks are when hands and trunk are told where to be.

Body frames have x to the person's right, y up and z to the back: for somebody who faces the
sensor they are the camera frame. Points beside an arm or a leg are written outwards, up and
back, so that one number serves both sides.
"""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.synthetic.limbs import (
    elbow_direction,
    pushed_out,
    rotation,
    smooth_step,
    turn,
    two_bone,
    unit,
    unturn,
)
from agent_server.synthetic.person import Person, Placement


class BodyJoint(IntEnum):
    """Index of each landmark in the joint axis of :class:`BodyMotion`."""

    PELVIS = 0
    NAVEL = 1
    NECK_BASE = 2
    NECK = 3
    HEAD = 4
    LEFT_SHOULDER = 5
    LEFT_ELBOW = 6
    LEFT_WRIST = 7
    LEFT_HAND = 8
    LEFT_TIP = 9
    LEFT_THUMB = 10
    RIGHT_SHOULDER = 11
    RIGHT_ELBOW = 12
    RIGHT_WRIST = 13
    RIGHT_HAND = 14
    RIGHT_TIP = 15
    RIGHT_THUMB = 16
    LEFT_HIP = 17
    LEFT_KNEE = 18
    LEFT_ANKLE = 19
    LEFT_FOOT = 20
    RIGHT_HIP = 21
    RIGHT_KNEE = 22
    RIGHT_ANKLE = 23
    RIGHT_FOOT = 24


SIDE_SIGNS: tuple[float, float] = (-1.0, 1.0)
"""Sign of x on the left and on the right side."""
HEAD_RADII_M = (0.095, 0.140, 0.115)
"""Half axes of what a wrist cannot enter at the head of a reference person."""
TRUNK_RADII_M = (0.185, 0.135)
"""Half width and half depth of what a wrist cannot enter at the trunk."""


@dataclass(frozen=True, slots=True)
class Controls:
    """What drives a body, over time.

    Attributes:
        pelvis: Shape (T, 3), metres right, up and back of where the pelvis rests.
        trunk: Shape (T, 3), pitch (forward), roll (to the left) and yaw (to the left).
        head: Shape (T, 3), the same angles of the head against the chest.
        chest_points: Shape (2, T, 3), part of each wrist's place that is tied to the chest.
        upright_points: Shape (2, T, 3), part tied to the neck's base and the vertical.
        head_points: Shape (2, T, 3), part tied to the head.
        pelvis_points: Shape (2, T, 3), part tied to the pelvis.
        weights: Shape (2, T, 4), share of the four; each row sums to 1.
        swivels: Shape (2, T), radians, see :func:`elbow_direction`.
        hands: Shape (2, T, 3), where the fingers point beside the forearm's direction.
        feet: Shape (2, T, 3), metres outwards, up and back of where each foot rests.
    """

    pelvis: Float64
    trunk: Float64
    head: Float64
    chest_points: Float64
    upright_points: Float64
    head_points: Float64
    pelvis_points: Float64
    weights: Float64
    swivels: Float64
    hands: Float64
    feet: Float64


@dataclass(frozen=True, slots=True)
class BodyMotion:
    """Clean motion of a body in the camera frame.

    Attributes:
        times_s: Shape (T,).
        joints: Shape (T, 25, 3), metres, in the order of :class:`BodyJoint`.
        chest: Shape (T, 3, 3), columns are the chest's right, up and back.
        head: Shape (T, 3, 3), the same of the head.
    """

    times_s: Float64
    joints: Float64
    chest: Float64
    head: Float64


def _clear_of_body(
    wrist: Float64,
    centre: tuple[Float64, Float64],
    frames: tuple[Float64, Float64],
    person: Person,
) -> Float64:
    """Keeps a wrist out of the head and out of the trunk below the shoulders."""
    scale = person.scale
    (head, base), (head_frame, chest_frame) = centre, frames
    local = unturn(head_frame, wrist - head)
    wrist = head + turn(head_frame, pushed_out(local, tuple(r * scale for r in HEAD_RADII_M), 1.0))
    local = unturn(chest_frame, wrist - base)
    below = np.clip((-local[:, 1] / scale - 0.02) / 0.12, 0.0, 1.0)
    above = np.clip((local[:, 1] / scale + 0.62) / 0.12, 0.0, 1.0)
    share = below * below * (3 - 2 * below) * above * above * (3 - 2 * above)
    flat = pushed_out(local[:, ::2], tuple(r * scale for r in TRUNK_RADII_M), share)
    local = np.stack([flat[:, 0], local[:, 1], flat[:, 1]], axis=1)
    return base + turn(chest_frame, local)


def move_body(
    person: Person, placement: Placement, controls: Controls, times_s: Float64
) -> BodyMotion:
    """Computes all landmarks in the camera frame."""
    n, scale = len(times_s), person.scale
    joints = np.empty((n, len(BodyJoint), 3))
    at_rest = np.array([placement.slouch_rad, placement.list_rad, placement.heading_rad])
    pitch, roll, yaw = (controls.trunk + at_rest).T
    ground = rotation(np.zeros(n), np.zeros(n), np.full(n, placement.heading_rad))
    low = rotation(0.45 * pitch, 0.5 * roll, placement.heading_rad + 0.25 * controls.trunk[:, 2])
    chest = rotation(pitch, roll, yaw)
    head_pitch, head_roll, head_yaw = controls.head.T
    level = 0.7 * placement.slouch_rad
    head = chest @ rotation(head_pitch - level, head_roll, head_yaw)

    standing = 0.993 * (person.thigh_m + person.shank_m) + 0.045 * scale
    rest_height = placement.seat_m if placement.seated else standing
    pelvis = np.array([placement.lateral_m, rest_height, placement.distance_m]) + turn(
        ground, controls.pelvis
    )
    navel = pelvis + turn(low, np.array([0.0, person.lower_spine_m, 0.0]))
    base = navel + turn(chest, np.array([0.0, person.upper_spine_m, 0.0]))
    forward = 0.12 * person.head_m
    to_head = np.array([0.0, np.sqrt(person.head_m**2 - forward**2), -forward])
    centre = base + turn(head, to_head)
    joints[:, BodyJoint.PELVIS] = pelvis
    joints[:, BodyJoint.NAVEL] = navel
    joints[:, BodyJoint.NECK_BASE] = base
    joints[:, BodyJoint.NECK] = base + turn(head, 0.45 * to_head)
    joints[:, BodyJoint.HEAD] = centre

    upright = rotation(np.zeros(n), np.zeros(n), yaw)
    for side, sign in enumerate(SIDE_SIGNS):
        mirror = np.array([sign, 1.0, 1.0])
        weight = controls.weights[side]
        wrist = (
            weight[:, :1] * base
            + turn(chest, controls.chest_points[side] * mirror * scale)
            + weight[:, 1:2] * base
            + turn(upright, controls.upright_points[side] * mirror * scale)
            + weight[:, 2:3] * centre
            + turn(head, controls.head_points[side] * mirror * scale)
            + weight[:, 3:] * pelvis
            + turn(ground, controls.pelvis_points[side] * mirror * scale)
        )
        wrist = _clear_of_body(wrist, (centre, base), (head, chest), person)
        shoulder = base + turn(chest, _shoulder(person, sign, unturn(chest, wrist - base)))
        line = unturn(chest, wrist - shoulder) * mirror
        pole = turn(chest, elbow_direction(line, controls.swivels[side]) * mirror)
        elbow, wrist = two_bone(shoulder, wrist, pole, person.upper_arm_m, person.forearm_m)
        first = BodyJoint.RIGHT_SHOULDER if side else BodyJoint.LEFT_SHOULDER
        joints[:, first], joints[:, first + 1], joints[:, first + 2] = shoulder, elbow, wrist
        _fill_hand(joints, first, person, turn(chest, controls.hands[side] * mirror))
        _fill_leg(joints, side, person, placement, controls.feet[side], ground)

    joints[..., 1] -= placement.sensor_height_m
    tilt = rotation(*(np.array([v]) for v in (placement.sensor_tilt_rad, 0.0, 0.0)))[0]
    return BodyMotion(times_s, joints @ tilt.T, tilt @ chest, tilt @ head)


def _shoulder(person: Person, sign: float, wrist: Float64) -> Float64:
    """The shoulder joint in the chest frame: the girdle follows a raised or stretched arm.

    Elevation reaches about 20 degrees overhead (Inman et al. 1944: the clavicle rises by 30
    to 36 degrees at full elevation, most of it above shoulder height).
    """
    arm = person.upper_arm_m + person.forearm_m
    up = np.clip((wrist[:, 1] + person.shoulder_drop_m) / arm, -1.0, 1.0)
    forward = np.clip(-wrist[:, 2] / arm, -0.3, 1.0)
    inward = np.clip(-sign * wrist[:, 0] / arm, -1.0, 1.0)
    lift = 0.36 * smooth_step((up + 0.25) / 1.25)
    swing = 0.22 * forward + 0.14 * inward
    base = np.arctan2(person.shoulder_drop_m, person.shoulder_half_m)
    length = np.hypot(person.shoulder_drop_m, person.shoulder_half_m)
    across = length * np.cos(lift - base)
    return np.stack(
        [sign * across * np.cos(swing), length * np.sin(lift - base), -across * np.sin(swing)],
        axis=1,
    )


def _fill_hand(joints: Float64, first: int, person: Person, fingers: Float64) -> None:
    """Hand, fingertip and thumb, which bend by at most some 60 degrees from the forearm."""
    elbow, wrist = joints[:, first + 1], joints[:, first + 2]
    fore = (wrist - elbow) / person.forearm_m
    direction = unit(fore + fingers)
    inward = unit(joints[:, BodyJoint.NECK_BASE] - wrist + 1e-3)
    thumb = unit(inward - (inward * direction).sum(axis=1, keepdims=True) * direction)
    joints[:, first + 3] = wrist + 0.42 * person.hand_m * direction
    joints[:, first + 4] = wrist + person.hand_m * direction
    joints[:, first + 5] = wrist + person.hand_m * (0.38 * direction + 0.34 * thumb)


def _fill_leg(
    joints: Float64,
    side: int,
    person: Person,
    placement: Placement,
    foot: Float64,
    ground: Float64,
) -> None:
    """A leg between the pelvis and a foot on the floor."""
    sign, scale = SIDE_SIGNS[side], person.scale
    first = BodyJoint.RIGHT_HIP if side else BodyJoint.LEFT_HIP
    pelvis = joints[:, BodyJoint.PELVIS]
    hip = pelvis + turn(ground, np.array([sign * person.hip_half_m, 0.0, 0.0]))
    forward = person.thigh_m + 0.02 if placement.seated else 0.0
    rest = np.array([1.15 * person.hip_half_m, 0.05 * scale, -forward])
    place = np.array([placement.lateral_m, 0.0, placement.distance_m])
    ankle = place + turn(ground, (rest + foot) * (sign, 1.0, 1.0))
    ahead = turn(ground, np.array([0.12 * sign, 0.25, -1.0]))
    knee, ankle = two_bone(hip, ankle, ahead, person.thigh_m, person.shank_m)
    toes = turn(ground, np.array([0.2 * sign, -0.25, -0.95]))
    joints[:, first], joints[:, first + 1], joints[:, first + 2] = hip, knee, ankle
    joints[:, first + 3] = ankle + person.foot_m * unit(toes)
