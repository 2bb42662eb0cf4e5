"""Figures that several measurements report."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

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


def resident_mb(pid: int) -> float | None:
    """Resident memory of a process in MB; None where the system does not tell."""
    status = Path(f"/proc/{pid}/status")
    if not status.exists():
        return None
    for line in status.read_text("ascii").splitlines():
        if line.startswith("VmRSS:"):
            return round(int(line.split()[1]) / 1024, 1)
    return None


def peak_resident_mb() -> float | None:
    """Most resident memory that this process has ever had, in MB; None where nobody tells."""
    status = Path("/proc/self/status")
    if not status.exists():
        return None
    lines = status.read_text("ascii").splitlines()
    return next(
        (round(int(line.split()[1]) / 1024, 1) for line in lines if line.startswith("VmHWM:")), None
    )
