"""Two protocols of the literature on Human3.6M.

``h36m-256`` is that of siMLPe and History Repeats Itself: 256 windows an action, mean joint
distance at a frame. ``h36m-rms`` is that of the MA-WGAN papers (their equation 11): the root of the
mean squared joint distance over all frames up to a horizon, of 17 joints, on windows that start
every 25 frames. Both use the actions of S5 of which both takes are there.
"""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from models.data.h36m import complete_actions, read_h36m
from models.data.layouts import H36M

SEEN = 50
FUTURE = 25
COPIES = {16: 13, 20: 19, 23: 22, 24: 13, 28: 27, 31: 30}
"""h36m-256: a joint that lies where another does -> that other one. The rest never moves."""
RMS_JOINTS = (0, 1, 2, 3, 6, 7, 8, 12, 13, 14, 15, 17, 18, 19, 25, 26, 27)
"""h36m-rms: the joints that count."""

_SEED = 1234567890
_PAIRS = 128
_FIRST_START = 16
_MARGIN = 150
_STRIDE = 25


def random_windows(data: Path, cache: Path) -> dict[str, Float32]:
    """h36m-256: 128 windows of each take at the published random starts, (256, 75, 32, 3) mm."""
    del cache  # nothing is generated
    return _windows(data, _random)


def regular_windows(data: Path, cache: Path) -> dict[str, Float32]:
    """h36m-rms: windows that start every 25 frames, (N, 75, 32, 3) mm an action."""
    del cache  # nothing is generated
    return _windows(data, _regular)


def joint_errors(expected: Float32, true: Float32) -> Float32:
    """h36m-256: mean joint distance at each frame over all 32 joints.

    Args:
        expected: The 22 joints that models predict, shape (N, F, 22, 3), mm.
        true: All joints, shape (N, F, 32, 3), mm.

    Returns:
        Shape (F,), mm.
    """
    filled = _filled(expected, true)
    for joint, original in COPIES.items():
        filled[:, :, joint] = filled[:, :, original]
    errors: Float32 = np.linalg.norm(filled - true, axis=-1).mean(axis=(0, 2))
    return errors


def rms_errors(expected: Float32, true: Float32) -> Float32:
    """h36m-rms: root mean squared joint distance up to each frame, mean over windows.

    Args:
        expected: The 22 joints that models predict, shape (N, F, 22, 3), mm.
        true: All joints, shape (N, F, 32, 3), mm.

    Returns:
        Shape (F,), mm.
    """
    off = (_filled(expected, true) - true)[:, :, RMS_JOINTS]
    squared = np.square(off).sum(axis=-1).mean(axis=2)  # (N, F), mean over joints
    until = np.cumsum(squared, axis=1) / np.arange(1, squared.shape[1] + 1)
    errors: Float32 = np.sqrt(until).mean(axis=0)
    return errors


def _filled(expected: Float32, true: Float32) -> Float32:
    """The predicted joints in their places; what no model predicts keeps its true value."""
    filled = true.copy()
    filled[:, :, H36M.joints] = expected
    return filled


def _windows(
    data: Path, cut: Callable[[Float32, Float32], Iterator[Float32]]
) -> dict[str, Float32]:
    takes = complete_actions(read_h36m(data, "test"))
    return {action: np.stack(list(cut(*pair))) for action, pair in takes.items()}


def _random(first: Float32, second: Float32) -> Iterator[Float32]:
    # The legacy generator is the protocol: other implementations draw with it.
    rng = np.random.RandomState(_SEED)
    for _ in range(_PAIRS):
        for take in (first, second):
            start = rng.randint(_FIRST_START, len(take) - _MARGIN)
            yield take[start : start + SEEN + FUTURE]


def _regular(first: Float32, second: Float32) -> Iterator[Float32]:
    for take in (first, second):
        for start in range(0, len(take) - SEEN - FUTURE + 1, _STRIDE):
            yield take[start : start + SEEN + FUTURE]
