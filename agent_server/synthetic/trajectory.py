"""How things move between places: minimum jerk, superposed, with oscillations on top.

A point-to-point movement follows the minimum-jerk profile of Flash and Hogan (1985,
eq. 2); a movement that starts before the last one has ended is added to it, as in Flash and
Henis (1991), which also gives corrective sub-movements. Everything is a continuous function
of time, so that any sensor samples it at its own ticks.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from agent_server.domain.arrays import Float64

Vector = tuple[float, float, float]
ORIGIN: Vector = (0.0, 0.0, 0.0)
LONG_AGO_S = -1e6


@dataclass(frozen=True, slots=True)
class Move:
    """A movement of a three-component value from wherever it is to ``value``.

    Attributes:
        start_s: When it starts.
        duration_s: How long it takes, in seconds.
        value: Where it ends.
        skew: Exponent on the relative time; above 1 peaks late, below 1 early.
    """

    start_s: float
    duration_s: float
    value: Vector
    skew: float = 1.0

    @property
    def end_s(self) -> float:
        """When it ends."""
        return self.start_s + self.duration_s


@dataclass(frozen=True, slots=True)
class Oscillation:
    """A swing about wherever the value is, for rubbing, fanning and waving.

    Attributes:
        start_s: When it starts to build up.
        stop_s: When it has died down.
        ramp_s: Time to build up and to die down.
        along: Amplitude of the first component of the swing.
        across: Amplitude of the component a quarter of a period later (an ellipse).
        frequency_hz: Mean frequency.
        phase_rad: Phase at the start.
        unevenness: Relative modulation of phase and amplitude from cycle to cycle.
        arc: Displacement at both ends of the swing, as of a hand that turns about its elbow.
    """

    start_s: float
    stop_s: float
    ramp_s: float
    along: Vector
    across: Vector
    frequency_hz: float
    phase_rad: float
    unevenness: float = 0.0
    arc: Vector = ORIGIN


@dataclass(frozen=True, slots=True)
class Drift:
    """Involuntary movement: a sum of sines whose amplitude falls with the frequency.

    Attributes:
        amplitude: Shape (K, 3).
        frequency_hz: Shape (K, 3).
        phase_rad: Shape (K, 3).
    """

    amplitude: Float64
    frequency_hz: Float64
    phase_rad: Float64


def minimum_jerk(relative: Float64) -> Float64:
    """The minimum-jerk profile: 0 before 0, 1 after 1, two continuous derivatives."""
    tau = np.clip(relative, 0.0, 1.0)
    return np.asarray(tau * tau * tau * (10.0 + tau * (6.0 * tau - 15.0)))


def progress(start_s: float, duration_s: float, skew: float, times_s: Float64) -> Float64:
    """How far a movement has got at ``times_s``: shape (T,), from 0 to 1."""
    tau = np.clip((times_s - start_s) / duration_s, 0.0, 1.0)
    return minimum_jerk(tau if skew == 1.0 else tau**skew)


def blend(moves: Sequence[Move], times_s: Float64) -> Float64:
    """Where superposed moves that begin at the origin have got to: shape (T, 3)."""
    value = np.zeros((len(times_s), 3))
    last: Vector = ORIGIN
    for move in moves:
        step = np.subtract(move.value, last)
        last = move.value
        if step.any():
            share = progress(move.start_s, move.duration_s, move.skew, times_s)
            value += share[:, None] * step
    return value


def oscillate(swings: Sequence[Oscillation], times_s: Float64) -> Float64:
    """Sum of swings: shape (T, 3)."""
    value = np.zeros((len(times_s), 3))
    for swing in swings:
        inside: NDArray[np.bool_] = (times_s > swing.start_s) & (times_s < swing.stop_s)
        if not inside.any():
            continue
        t = times_s[inside] - swing.start_s
        left = swing.stop_s - swing.start_s
        envelope = minimum_jerk(t / swing.ramp_s) * minimum_jerk((left - t) / swing.ramp_s)
        slow = np.sin(2 * np.pi * 0.37 * swing.frequency_hz * t + 2.3 * swing.phase_rad)
        phase = 2 * np.pi * swing.frequency_hz * t + swing.phase_rad
        phase += swing.unevenness * slow
        envelope = envelope * (1 + 0.6 * swing.unevenness * slow)
        value[inside] += (envelope * np.sin(phase))[:, None] * np.asarray(swing.along)
        value[inside] += (envelope * np.cos(phase))[:, None] * np.asarray(swing.across)
        value[inside] += (envelope * np.sin(phase) ** 2)[:, None] * np.asarray(swing.arc)
    return value


def sample_drift(rng: np.random.Generator, size: Vector, *, terms: int = 5) -> Drift:
    """Draws involuntary movement whose standard deviation is about ``size``."""
    frequency = np.exp(rng.uniform(np.log(0.06), np.log(1.1), (terms, 3)))
    weight = 1.0 / (0.12 + frequency)
    weight *= rng.uniform(0.5, 1.5, (terms, 3))
    weight /= np.sqrt((weight**2).sum(axis=0) / 2)
    phase = rng.uniform(0, 2 * np.pi, (terms, 3))
    return Drift(weight * np.asarray(size), frequency, phase)


def drift(involuntary: Drift, times_s: Float64) -> Float64:
    """Involuntary movement at ``times_s``: shape (T, 3)."""
    angle = 2 * np.pi * involuntary.frequency_hz * times_s[:, None, None] + involuntary.phase_rad
    return np.asarray((np.sin(angle) * involuntary.amplitude).sum(axis=1))
