"""What a predicted future adds to a held one, class by class, and whether that is chance."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32
from agent_server.domain.skeleton import CoreJoint
from models.evaluation.readings import HELD, PREDICTED, TRUE
from models.evaluation.rows import paired_p_value
from models.evaluation.time_seen import SECONDS, TimeSeen

LEVEL = 0.01
"""A difference that chance makes less often than this counts."""
HORIZONS_MS = (400, 1000, 2000)
FRAME_MS = 40
HANDS = [CoreJoint.LEFT_WRIST, CoreJoint.RIGHT_WRIST]
MM = 1000.0


class Verdict(Enum):
    """What the prediction does to how often windows are named right."""

    HELPS = "helps"
    HURTS = "hurts"
    EVEN = "makes no sure difference to"


@dataclass(frozen=True, slots=True)
class Gain:
    """Windows that are read three times.

    Attributes:
        windows: How many.
        accuracy: Reading -> share that is named right.
        p_value: How likely two equally good readings differ as much as predicted and held.
    """

    windows: int
    accuracy: dict[str, float]
    p_value: float

    @property
    def points(self) -> float:
        """Gain of predicted over held futures, in points of a hundred."""
        return 100 * (self.accuracy[PREDICTED] - self.accuracy[HELD])

    @property
    def room(self) -> float:
        """Gain of true over held futures: what there is to gain, in points."""
        return 100 * (self.accuracy[TRUE] - self.accuracy[HELD])

    @property
    def verdict(self) -> Verdict:
        """Whether the gain is more than chance."""
        if self.p_value >= LEVEL:
            return Verdict.EVEN
        return Verdict.HELPS if self.points > 0 else Verdict.HURTS


def gain_of(right: dict[str, NDArray[np.bool_]], which: NDArray[np.bool_]) -> Gain:
    """The gain over some windows (N,), at least one.

    Args:
        right: Reading -> shape (N,), which windows are named right.
        which: Shape (N,), those to look at.
    """
    return Gain(
        int(which.sum()),
        {reading: float(found[which].mean()) for reading, found in right.items()},
        paired_p_value(right[PREDICTED][which], right[HELD][which]),
    )


def p_over_time(seen: TimeSeen) -> NDArray[np.float64]:
    """P-value of predicted against held futures at each time after the onset, shape (S,).

    Each gesture gives one window at each time, so that no two of a test overlap.
    """
    return np.array(
        [
            paired_p_value(
                seen.right[PREDICTED][seen.there[:, step], step],
                seen.right[HELD][seen.there[:, step], step],
            )
            for step in range(len(SECONDS))
        ]
    )


def hand_distances(future: Float32, true: Float32) -> Float32:
    """Mean distance of both hands from where they are (N, horizons), mm.

    Args:
        future: Shape (N, 50, 9, 3), metres.
        true: The same.
    """
    frames = [ms // FRAME_MS - 1 for ms in HORIZONS_MS]
    picked = np.ix_(range(len(true)), frames, HANDS)
    off: Float32 = MM * np.linalg.norm(future[picked] - true[picked], axis=-1).mean(axis=-1)
    return off
