"""Percentiles, as every measurement reports them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class Percentiles:
    """Percentiles of a duration, in milliseconds."""

    p50_ms: float
    p95_ms: float
    p99_ms: float


def percentiles(durations_ms: Sequence[float]) -> Percentiles:
    """The 50th, 95th and 99th percentile, rounded to a microsecond."""
    p50, p95, p99 = np.percentile(durations_ms, (50, 95, 99))
    return Percentiles(round(float(p50), 3), round(float(p95), 3), round(float(p99), 3))
