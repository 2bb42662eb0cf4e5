"""Paths of hands: how far elbows turn out, and ways around the body."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.synthetic.performance import Frame
from agent_server.synthetic.trajectory import ORIGIN, Vector

_FRAME_ORIGINS: Mapping[Frame, Vector] = MappingProxyType(
    {
        "chest": ORIGIN,
        "upright": ORIGIN,
        "head": (0.0, 0.17, -0.02),
        "pelvis": (0.0, -0.54, 0.0),
    }
)
_SHOULDER = np.array([0.19, -0.05, 0.0])
_CLEARANCE_M = 0.22


def natural_swivel(frame: Frame, point: Vector) -> float:
    """By how many degrees an elbow turns out of its own accord with the wrist at ``point``.

    More for hands across the body and high up, less for hands far out: medians of Kinect
    recordings of free movement.
    """
    outwards, up, _ = from_neck(frame, point)
    aside = float(np.clip(outwards - 0.19, -0.25, 0.35))
    return 27.0 - 45.0 * aside + 55.0 * float(np.clip(up - 0.05, 0.0, 0.45))


def detour(start: Float64, end: Float64, bow: Vector) -> Vector:
    """Widens the bow of a path so that it leads around the trunk and clear of the shoulder.

    A wrist that passes close to its own shoulder would whirl the elbow about.

    Args:
        start: Where the wrist is, in the chest frame, outwards, up and back.
        end: Where it goes.
        bow: How far the path would swing out in its middle.
    """
    x, y, z = bow
    if (start[2] > 0.06) != (end[2] > 0.06) and min(start[1], end[1]) < -0.2:
        # To the back, or away from it, around the hip.
        x += 0.8 * max(0.0, 0.3 - 0.5 * float(start[0] + end[0]))
    if min(start[2], end[2]) > 0.06:
        z = abs(z)  # a hand that stays behind the back has the trunk before it
    share = np.linspace(0.1, 0.9, 9)[:, None]
    straight = start + share * (end - start)
    path = straight + 4 * share * (1 - share) * (x, y, z)
    nearest = int(np.argmin(np.linalg.norm(path - _SHOULDER, axis=1)))
    gap = float(np.linalg.norm(path[nearest] - _SHOULDER))
    if gap < _CLEARANCE_M:
        strength = 4 * float(share[nearest, 0] * (1 - share[nearest, 0]))
        z -= (_CLEARANCE_M - gap + 0.04) / max(strength, 0.5)
    return x, y, z


def from_neck(frame: Frame, point: Vector) -> Float64:
    """About where a place of any frame lies in the chest frame of somebody upright."""
    return np.asarray(np.add(point, _FRAME_ORIGINS[frame]))
