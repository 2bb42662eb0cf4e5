"""When the hands leave their rest, and when they are back."""

from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32, Float64
from agent_server.domain.motion import RATE_HZ
from agent_server.domain.skeleton import CoreJoint

ARMS: tuple[CoreJoint, ...] = (
    CoreJoint.LEFT_ELBOW,
    CoreJoint.LEFT_WRIST,
    CoreJoint.RIGHT_ELBOW,
    CoreJoint.RIGHT_WRIST,
)
"""The joints that are watched."""

AWAY_M = 0.2
"""A joint that is farther from where it rested is away, also while it is held still."""
FAST_M_S = 0.5
"""A joint that is faster moves. What sensors make of resting arms is slower, or short."""
STIRRING_M_S = 0.2
"""A joint that is faster before and after it is away or fast is on its way."""
SURE = 0.6
"""Joints below this confidence are guesses, which jump: they start no movement."""
_SUSTAINED = 5
"""Frames in a row that make a movement."""
_SMOOTHING = 5
"""Frames of the running median, which a single wrong frame does not get through."""
_SPAN = 2
"""Speed at a frame is measured from this many frames before it to as many after it."""


@dataclass(frozen=True, slots=True)
class Movement:
    """Where the arms are not at rest.

    Attributes:
        onset: First frame at which they are on their way.
        offset: Last frame at which they are.
        is_over: Whether they are back at rest before the last frame.
    """

    onset: int
    offset: int
    is_over: bool


def find_movement(positions: Float32, confidence: Float32, resting: int) -> Movement | None:
    """Look for the movement of the arms that begins and ends at rest.

    From the first to the last frame at which a wrist or an elbow is fast, or away from where it
    rested, and from there outwards as long as any of them stirs. A hold or a pause in between
    belongs to it.

    Args:
        positions: Shape (T, 9, 3) at 25 Hz, metres in the camera frame.
        confidence: Shape (T, 9), in [0, 1].
        resting: Number of frames at the start that show the rest; at least 1. A movement that
            has begun by then starts with the frame after them.

    Returns:
        The movement, or None if nothing moved.
    """
    joints = list(ARMS)
    track = _running_median(np.asarray(positions[:, joints], dtype=np.float64))
    speed = _speed(track)
    away = np.linalg.norm(track - np.median(track[:resting], axis=0), axis=2) > AWAY_M
    clear = ((speed > FAST_M_S) | away) & (confidence[:, joints] >= SURE)
    found = np.flatnonzero(_sustained(clear.any(axis=1))[resting:]) + resting
    if not len(found):
        return None
    stirring: NDArray[np.bool_] = np.any(speed > STIRRING_M_S, axis=1)
    onset, offset, last = int(found[0]), int(found[-1]), len(positions) - 1
    while onset > resting and stirring[onset - 1]:
        onset -= 1
    while offset < last and stirring[offset + 1]:
        offset += 1
    return Movement(onset, offset, is_over=offset < last)


def _running_median(track: Float64) -> Float64:
    """The median of neighbouring frames; shape (T, J, 3) stays."""
    half = _SMOOTHING // 2
    padded = np.pad(track, ((half, half), (0, 0), (0, 0)), mode="edge")
    median: Float64 = np.median(sliding_window_view(padded, _SMOOTHING, axis=0), axis=-1)
    return median


def _speed(track: Float64) -> Float64:
    """Speed of each joint in m/s, shape (T, J), over 0.16 s about each frame."""
    index = np.arange(len(track))
    before, after = np.maximum(index - _SPAN, 0), np.minimum(index + _SPAN, len(track) - 1)
    seconds = np.maximum(after - before, 1) / RATE_HZ
    speed: Float64 = np.linalg.norm(track[after] - track[before], axis=2) / seconds[:, None]
    return speed


def _sustained(active: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Without runs that are too short."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], active, [False]))))
    kept = active.copy()
    for start, stop in edges.reshape(-1, 2):
        if stop - start < _SUSTAINED:
            kept[start:stop] = False
    return kept
