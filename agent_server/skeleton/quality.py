"""How far a window of frames can be trusted."""

import math

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import Quality
from agent_server.domain.skeleton import CORE_BONES, CORE_JOINTS, CoreJoint

_TRACKED = 0.5
"""A joint of more than this confidence is tracked; a Kinect gives 0.5 to what it infers."""

_LEAST_TRACKED = 0.8
"""Two of nine joints that are hidden throughout are below this share."""

_MOST_DEVIATION = 0.7
"""A Kinect v1's bones change by more than this in one window of a hundred."""

_PARENTS, _CHILDREN = np.array(CORE_BONES, dtype=np.intp).T

_BONE_M = (0.03, 0.8)
"""A core bone of any person, with room for a sensor's error; a wrong unit is far outside."""

_UPSIDE_DOWN = -0.5
"""Cosine between the line from navel to head and upwards; a deep bow stays above."""


def assess(positions: Float32, confidence: Float32, *, mirrored: bool = False) -> Quality:
    """Judge one window.

    Bone lengths count only where both ends are measured: a joint that keeps its last known
    position stretches its bone, and ``filled`` says so already.

    Args:
        positions: Shape (T, 9, 3), metres in the camera frame, T >= 1.
        confidence: Shape (T, 9), in [0, 1]; 0 where a position is filled in.
        mirrored: What a :class:`~agent_server.skeleton.mirror.MirrorDetector` makes of the
            stream, because one window cannot tell.

    Returns:
        The shares, the bones' deviation and the warnings ``mirrored``, ``upside_down`` (the
        head is below the navel), ``bone_length`` (a length jumps, or is no person's)
        and ``occluded`` (more than a fifth of the joint samples is not tracked).
    """
    frames = len(positions)
    samples = frames * CORE_JOINTS
    measured = np.count_nonzero(confidence > _TRACKED) / samples
    filled = 1.0 - np.count_nonzero(confidence) / samples
    lengths = _bone_lengths(positions, confidence if filled > 0.0 else None)
    # A millimetre keeps the quotient finite for a bone that has collapsed.
    deviation = (
        max(
            (max(longest - middle, middle - shortest) / max(middle, 0.001))
            for shortest, middle, longest in lengths
        )
        if lengths
        else 0.0
    )
    plausible = all(_BONE_M[0] <= middle <= _BONE_M[1] for _, middle, _ in lengths)
    warnings = []
    if mirrored:
        warnings.append("mirrored")
    if _uprightness(positions) < _UPSIDE_DOWN:
        warnings.append("upside_down")
    if deviation > _MOST_DEVIATION or not plausible:
        warnings.append("bone_length")
    if measured < _LEAST_TRACKED:
        warnings.append("occluded")
    return Quality(measured, filled, deviation, tuple(warnings))


def _bone_lengths(
    positions: Float32, confidence: Float32 | None
) -> list[tuple[float, float, float]]:
    """Shortest, median and longest length in metres of every bone that is ever measured."""
    bones = positions.take(_CHILDREN, axis=1) - positions.take(_PARENTS, axis=1)
    lengths = np.sqrt(np.einsum("tbi,tbi->tb", bones, bones))
    if confidence is None:
        lengths.sort(axis=0)
        middle = len(lengths) // 2
        return list(zip(*(lengths[row].tolist() for row in (0, middle, -1)), strict=True))
    measured = confidence > 0.0
    both = measured[:, _PARENTS] & measured[:, _CHILDREN]
    return [
        (ordered[0], ordered[len(ordered) // 2], ordered[-1])
        for bone in range(len(CORE_BONES))
        if (ordered := sorted(lengths[both[:, bone], bone].tolist()))
    ]


def _uprightness(positions: Float32) -> float:
    """Cosine between upwards and the mean line from the navel to the head; 0 without one."""
    x, y, z = (positions[:, CoreJoint.HEAD] - positions[:, CoreJoint.NAVEL]).sum(axis=0).tolist()
    length = math.sqrt(x * x + y * y + z * z)
    return y / length if length > 0.0 else 0.0
