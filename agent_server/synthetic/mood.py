"""How a face looks around gestures: a smooth track of valence and arousal."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from agent_server.domain.affect import AFFECT_LIMIT, AffectSample
from agent_server.domain.stamp import to_ns
from agent_server.synthetic.trajectory import Move, blend, drift, sample_drift

Expression = Literal["neutral", "unpleasant", "pleasant"]
RATE_HZ = 10.0
LEVELS: dict[Expression, tuple[float, float]] = {
    "neutral": (0.6, 0.8),
    "unpleasant": (-6.0, 5.0),
    "pleasant": (5.0, 4.5),
}
"""Valence and arousal in [-10, 10]."""


@dataclass(frozen=True, slots=True)
class Look:
    """A stretch in which the face shows something."""

    start_s: float
    stop_s: float
    expression: Expression


def affect_track(
    rng: np.random.Generator, looks: Sequence[Look], duration_s: float
) -> list[AffectSample]:
    """Samples at 10 Hz: neutral, changed by every look, unsteady as estimates are.

    A face changes within some 0.5 s, a little ahead of the hands.

    Args:
        rng: Where the variation comes from.
        looks: In order of time.
        duration_s: Length of the track.
    """
    base = np.array(LEVELS["neutral"])
    moves = []
    for look in looks:
        level = np.array(LEVELS[look.expression]) + rng.normal(0, 0.4, 2)
        away = level - base
        onset = look.start_s - rng.uniform(0.2, 0.7)
        moves.append(Move(onset, rng.uniform(0.4, 0.8), (float(away[0]), float(away[1]), 0.0)))
        moves.append(Move(look.stop_s, rng.uniform(0.8, 1.5), (0.0, 0.0, 0.0)))
    times = np.arange(0.05, duration_s, 1.0 / RATE_HZ)
    values = base + blend(moves, times)[:, :2]
    values += drift(sample_drift(rng, (0.35, 0.35, 0.0)), times)[:, :2]
    values += rng.normal(0, 0.12, values.shape)
    values = np.clip(values, -AFFECT_LIMIT, AFFECT_LIMIT).round(2)
    return [
        AffectSample(to_ns(time), float(valence), float(arousal))
        for time, (valence, arousal) in zip(times, values, strict=True)
    ]
