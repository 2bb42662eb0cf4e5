"""Errors of a tracked joint: slow ones, jumpy ones, and the tracker's own smoothing."""

import numpy as np

from agent_server.domain.arrays import Float64

SMOOTHING_FRAMES = 6


def wander(
    n: int, joints: int, period: int, change: float, rng: np.random.Generator
) -> tuple[Float64, Float64]:
    """Errors of unit size that last.

    Args:
        n: How many frames.
        joints: How many joints.
        period: Frames after which the smooth errors are independent; at least 2.
        change: Probability a frame with which a stepped error takes another value.
        rng: Where they come from.

    Returns:
        Smooth and stepped errors, shape (n, joints, 3) each.
    """
    knots = rng.standard_normal((n // period + 3, joints, 3))
    at = np.arange(n) / period
    low = at.astype(int)
    share = (at - low)[:, None, None]
    share = share * share * (3 - 2 * share)
    smooth = knots[low] * (1 - share) + knots[low + 1] * share
    changes = rng.random((n, joints)) < change
    changes[0] = True
    held = np.maximum.accumulate(np.where(changes, np.arange(n)[:, None], 0), axis=0)
    steps = rng.standard_normal((n, joints, 3))[held, np.arange(joints)]
    return smooth, steps


def speed(positions: Float64, times_s: Float64) -> Float64:
    """Metres a second since the frame before: (T, J, 3) -> (T, J), 0 in the first frame."""
    step = np.zeros(positions.shape[:2])
    step[1:] = np.linalg.norm(np.diff(positions, axis=0), axis=2)
    return np.asarray(step / np.diff(times_s, prepend=times_s[0] - 1.0)[:, None])


def low_pass(positions: Float64, lag_frames: float) -> Float64:
    """An exponential filter with a time constant in frames, cut off after six frames."""
    weights = np.exp(-np.arange(SMOOTHING_FRAMES) / lag_frames)
    weights /= weights.sum()
    before = SMOOTHING_FRAMES - 1
    padded = np.concatenate([np.repeat(positions[:1], before, axis=0), positions])
    out = np.zeros_like(positions)
    for lag, weight in enumerate(weights):
        out += weight * padded[before - lag : before - lag + len(positions)]
    return out
