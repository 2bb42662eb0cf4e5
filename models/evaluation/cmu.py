"""The literature's protocol on CMU motion capture: 25 joints, windows that start every 5 frames."""

from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from models.data.cmu import read_cmu_positions

WINDOW = 75
STRIDE = 5


def cmu_windows(data: Path, cache: Path) -> dict[str, Float32]:
    """Windows (N, 75, 38, 3) of the test files in mm, by action; global motion is zeroed."""
    del cache  # nothing is generated
    windows: dict[str, list[Float32]] = {}
    for key, positions in read_cmu_positions(data, "test").items():
        action = windows.setdefault(key.partition("/")[0], [])
        starts = range(0, len(positions) - WINDOW + 1, STRIDE)
        action.extend(positions[start : start + WINDOW] for start in starts)
    return {action: np.stack(found) for action, found in windows.items() if found}
