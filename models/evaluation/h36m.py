"""Two protocols of the literature on Human3.6M, for any forecaster of 32 joints.

``h36m-256`` is that of siMLPe and History Repeats Itself: 256 windows an action, mean joint
distance at a frame. ``h36m-rms`` is that of the MA-WGAN papers (their equation 11): the root of the
mean squared joint distance over all frames up to a horizon, of 17 joints, on windows that start
every 25 frames. Both use the actions of S5 of which both takes are there.
"""

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import RATE_HZ
from models.data.h36m import complete_actions, read_h36m

SEEN = 50
FUTURE = 25
Protocol = Literal["h36m-256", "h36m-rms"]
Forecaster = Callable[[Float32], Float32]
"""(N, 50, 32, 3) seen -> (N, 25, 32, 3) expected, mm."""

HORIZONS_MS: dict[Protocol, tuple[int, ...]] = {
    "h36m-256": (80, 160, 320, 400, 560, 720, 880, 1000),
    "h36m-rms": (80, 160, 320, 400, 1000),
}

PREDICTED = (2, 3, 4, 5, 7, 8, 9, 10, 12, 13, 14, 15, 17, 18, 19, 21, 22, 25, 26, 27, 29, 30)
"""h36m-256: the joints that a model predicts."""
COPIES = {16: 13, 20: 19, 23: 22, 24: 13, 28: 27, 31: 30}
"""h36m-256: a joint that lies where another does -> that other one. The rest never moves."""
RMS_JOINTS = (0, 1, 2, 3, 6, 7, 8, 12, 13, 14, 15, 17, 18, 19, 25, 26, 27)
"""h36m-rms: the joints that count."""

_SEED = 1234567890
_PAIRS = 128
_FIRST_START = 16
_MARGIN = 150
_STRIDE = 25


def repeat_last_frame(seen: Float32) -> Float32:
    """The zero-velocity baseline."""
    return np.repeat(seen[:, -1:], FUTURE, axis=1)


def evaluate_h36m(forecast: Forecaster, protocol: Protocol, data: Path) -> dict[str, Any]:
    """Measure a forecaster.

    Args:
        forecast: What is measured.
        protocol: ``h36m-256`` or ``h36m-rms``.
        data: Folder that holds ``h36m/``.

    Returns:
        ``average`` and ``actions``: the error in mm at each horizon, by name of the action.
    """
    takes = complete_actions(read_h36m(data, "test"))
    measure, cut = (
        (_joint_errors, _random_windows)
        if protocol == "h36m-256"
        else (_rms_errors, _regular_windows)
    )
    actions = {}
    for action, pair in takes.items():
        windows = np.stack(list(cut(*pair)))
        seen, true = windows[:, :SEEN], windows[:, SEEN:]
        actions[action] = measure(forecast(seen), true)
    frames = [ms * RATE_HZ // 1000 - 1 for ms in HORIZONS_MS[protocol]]

    def at_horizons(errors: Float32) -> dict[str, float]:
        values = [round(float(errors[frame]), 2) for frame in frames]
        return dict(zip(map(str, HORIZONS_MS[protocol]), values, strict=True))

    return {
        "protocol": protocol,
        "average": {"error_mm": at_horizons(np.mean(list(actions.values()), axis=0))},
        "actions": {action: {"error_mm": at_horizons(e)} for action, e in actions.items()},
    }


def _random_windows(first: Float32, second: Float32) -> Iterable[Float32]:
    """128 windows of each take at the published random starts, (75, 32, 3) each."""
    # The legacy generator is the protocol: other implementations draw with it.
    rng = np.random.RandomState(_SEED)
    for _ in range(_PAIRS):
        for take in (first, second):
            start = rng.randint(_FIRST_START, len(take) - _MARGIN)
            yield take[start : start + SEEN + FUTURE]


def _regular_windows(first: Float32, second: Float32) -> Iterable[Float32]:
    for take in (first, second):
        for start in range(0, len(take) - SEEN - FUTURE + 1, _STRIDE):
            yield take[start : start + SEEN + FUTURE]


def _joint_errors(expected: Float32, true: Float32) -> Float32:
    """Mean joint distance at each frame, shape (25,), over all 32 joints."""
    filled = true.copy()
    filled[:, :, PREDICTED] = expected[:, :, PREDICTED]
    for joint, original in COPIES.items():
        filled[:, :, joint] = filled[:, :, original]
    errors: Float32 = np.linalg.norm(filled - true, axis=-1).mean(axis=(0, 2))
    return errors


def _rms_errors(expected: Float32, true: Float32) -> Float32:
    """Root mean squared joint distance up to each frame, shape (25,), mean over windows."""
    off = (expected - true)[:, :, RMS_JOINTS]
    squared = np.square(off).sum(axis=-1).mean(axis=2)  # (N, 25), mean over joints
    until = np.cumsum(squared, axis=1) / np.arange(1, FUTURE + 1)
    errors: Float32 = np.sqrt(until).mean(axis=0)
    return errors


BASELINES: Mapping[str, Forecaster] = {"zero_velocity": repeat_last_frame}
"""Forecasters that need no training."""
