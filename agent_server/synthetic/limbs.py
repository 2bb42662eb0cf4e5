"""Rotations and limbs: two-bone inverse kinematics, elbow directions, soft limits."""

import numpy as np

from agent_server.domain.arrays import Float64

MAX_FLEXION_RAD = np.radians(150.0)
"""Largest flexion of elbow and knee (AAOS norms: 150 and 135 degrees)."""


def rotation(pitch: Float64, roll: Float64, yaw: Float64) -> Float64:
    """Rotation matrices of shape (T, 3, 3): yaw about y, then pitch forward, then roll."""
    cp, sp, cr, sr = np.cos(pitch), np.sin(pitch), np.cos(roll), np.sin(roll)
    cy, sy = np.cos(yaw), np.sin(yaw)
    out = np.empty((len(cp), 3, 3))
    out[:, 0, 0] = cy * cr - sy * sp * sr
    out[:, 0, 1] = -cy * sr - sy * sp * cr
    out[:, 0, 2] = sy * cp
    out[:, 1, 0] = cp * sr
    out[:, 1, 1] = cp * cr
    out[:, 1, 2] = sp
    out[:, 2, 0] = -sy * cr - cy * sp * sr
    out[:, 2, 1] = sy * sr - cy * sp * cr
    out[:, 2, 2] = cy * cp
    return out


def turn(frames: Float64, points: Float64) -> Float64:
    """``frames`` (T, 3, 3) applied to ``points`` (T, 3) or (3,): shape (T, 3)."""
    if points.ndim == 1:
        return np.asarray(frames @ points)
    return np.asarray((frames @ points[:, :, None])[:, :, 0])


def unturn(frames: Float64, vectors: Float64) -> Float64:
    """The inverse of :func:`turn` for vectors of shape (T, 3)."""
    return np.asarray((vectors[:, None, :] @ frames)[:, 0, :])


def unit(vectors: Float64) -> Float64:
    """Vectors (T, 3) at length 1; zero stays zero."""
    length = np.sqrt((vectors * vectors).sum(axis=1, keepdims=True))
    return np.asarray(vectors / np.maximum(length, 1e-9))


_AHEAD = np.array([0.30, -0.10, -0.95]) / np.linalg.norm([0.30, -0.10, -0.95])
_DOWNWARDS = np.array([0.0, _AHEAD[2], -_AHEAD[1]]) / np.hypot(_AHEAD[1], _AHEAD[2])
_OUTWARDS = np.cross(_DOWNWARDS, _AHEAD)


def elbow_direction(line: Float64, swivel_rad: Float64) -> Float64:
    """Where the elbow points, at right angles to the line from shoulder to wrist.

    The direction is fixed for an arm that points ahead and carried to every other direction by
    the smallest rotation. Such a field has one singular direction only, which is put where no
    arm can reach: behind the shoulder and inwards. (A constant pole vector has two, within reach.)

    Args:
        line: Shape (T, 3), outwards, up and back, of any length.
        swivel_rad: Shape (T,), 0 hangs down, a quarter turn points outwards.

    Returns:
        Shape (T, 3), outwards, up and back, unit length.
    """
    along = unit(line)
    ahead = np.cos(swivel_rad)[:, None] * _DOWNWARDS + np.sin(swivel_rad)[:, None] * _OUTWARDS
    lift = (along * ahead).sum(axis=1) / np.maximum(1.0 + along @ _AHEAD, 0.02)
    return unit(ahead - lift[:, None] * (_AHEAD + along))


def two_bone(
    root: Float64, target: Float64, pole: Float64, upper: float, lower: float
) -> tuple[Float64, Float64]:
    """Where the middle and the end of a two-bone chain come to lie.

    Args:
        root: Shape (T, 3), shoulder or hip.
        target: Shape (T, 3), where the end should be.
        pole: Shape (T, 3), direction into which the middle joint points.
        upper: Length of the first bone.
        lower: Length of the second bone.

    Returns:
        The middle and the end joint, shape (T, 3) each; the end falls short of a target that
        the chain cannot reach within its flexion limits.
    """
    reach = target - root
    distance = np.sqrt((reach * reach).sum(axis=1))
    along = reach / np.maximum(distance, 1e-9)[:, None]
    bent = upper * upper + lower * lower + 2 * upper * lower * np.cos(MAX_FLEXION_RAD)
    distance = _limited(distance, float(np.sqrt(bent)), 0.997 * (upper + lower))
    middle = (upper * upper - lower * lower + distance * distance) / (2 * distance)
    height = np.sqrt(np.maximum(upper * upper - middle * middle, 0.0))
    aside = unit(pole - (pole * along).sum(axis=1, keepdims=True) * along)
    return (
        root + middle[:, None] * along + height[:, None] * aside,
        root + distance[:, None] * along,
    )


def _limited(distance: Float64, low: float, high: float) -> Float64:
    soft = 0.006
    raised = low + soft * np.logaddexp(0.0, (distance - low) / soft)
    lowered = high - soft * np.logaddexp(0.0, (high - raised) / soft)
    return np.asarray(np.clip(lowered, low, high))


def pushed_out(local: Float64, radii: tuple[float, ...], share: Float64 | float) -> Float64:
    """Points of shape (T, K) pushed out of an ellipsoid; ``share`` fades the push."""
    relative = np.sqrt(((local / np.asarray(radii)) ** 2).sum(axis=1))
    out = relative + 0.06 * np.logaddexp(0.0, (1.0 - relative) / 0.06)
    factor = 1.0 + share * (out / np.maximum(relative, 0.05) - 1.0)
    return np.asarray(local * factor[:, None])


def smooth_step(values: Float64) -> Float64:
    """0 below 0, 1 above 1, smooth between."""
    x = np.clip(values, 0.0, 1.0)
    return np.asarray(x * x * (3 - 2 * x))
