"""The gesture ``hello``: waving.

Points are written outwards, up and back, in metres for the reference stature. How far and how
fast hands swing, and the way they take, was tuned on Kinect recordings of people who wave; see
``docs/synthetic.md``.
"""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from agent_server.synthetic.script import BOTH, Hands, Pen, Writer, degrees
from agent_server.synthetic.trajectory import Vector

Swivel = tuple[float, float]
FASTEST_SWING_M_S = 2.6
"""Nobody waves both as wide and as fast as they can."""


def _wave(
    pen: Pen,
    hands: Hands,
    centre: Vector,
    spread: Vector,
    swivel: Swivel,
    *,
    size: tuple[float, float],
    rate: tuple[float, float],
    bend: tuple[float, float] = (0.0, 0.5),
) -> None:
    """Hands swing sideways, along an arc as forearms do.

    Args:
        pen: What writes it.
        hands: Which ones.
        centre: Where they swing.
        spread: Standard deviation of the place.
        swivel: Mean and standard deviation of the elbows' turn, in degrees.
        size: Least and largest amplitude.
        rate: Least and largest frequency.
        bend: By which share of the amplitude hands sink at both ends of a swing.
    """
    # Two hands that go far out on their way up would be on it to the ears.
    aside = pen.uniform(0.0, 0.28 if len(hands) == 1 else 0.1)
    ahead = -pen.uniform(0.1, 0.24)
    arrival = pen.bring(
        hands,
        "chest",
        centre,
        spread,
        swivel,
        fingers=(0.0, 0.7, 0.0),
        median_s=pen.uniform(0.35, 0.8),
        bow=(aside, -0.02, ahead),
    )
    frequency = pen.uniform(*rate) * pen.person.tempo**0.5
    release = arrival + max(0.8 * pen.hold(), 1.5 / frequency)
    amplitude = pen.uniform(*size) * pen.person.vigour * min(1.0, 2.4 / frequency)
    amplitude = min(amplitude, FASTEST_SWING_M_S / (2 * np.pi * frequency))
    mirrored = pen.chance(0.7)
    depth = pen.rng.normal(0, 0.25) * amplitude
    sink = pen.uniform(0.0, 0.15) * amplitude
    arc = (0.0, -pen.uniform(*bend) * amplitude, pen.rng.normal(0, 0.2) * amplitude)
    # Either the first swing begins where the hand arrives, or the hand arrives far out.
    phase = pen.rng.normal(np.pi / 2, 0.5) if pen.chance(0.5) else pen.rng.normal(0, 0.5)
    for side in hands:
        sign = 1 if mirrored or side == 0 else -1
        pen.swing(
            side,
            arrival - pen.uniform(0.1, 0.35),
            release + 0.15,
            (sign * amplitude, 0.0, depth),
            frequency,
            across=(0.0, sink, 0.1 * amplitude),
            phase_rad=phase + pen.rng.normal(0, 0.1),
            ramp_s=0.2,
            arc=arc,
        )
    end = pen.lower(hands, release, median_s=pen.uniform(0.45, 0.9), bow=(0.9 * aside, 0.0, ahead))
    if pen.chance(0.3):
        nod = degrees(pen.uniform(-6, 8), pen.rng.normal(0, 4), pen.rng.normal(0, 5))
        pen.turn_and_back("head", pen.start_s, end, nod)
    if pen.chance(0.25):
        lean = degrees(pen.uniform(-3, 5), pen.rng.normal(0, 3), pen.rng.normal(0, 4))
        pen.turn_and_back("trunk", pen.start_s, end, lean)


def _beside_head(pen: Pen) -> None:
    place, spread = (0.32, 0.13, -0.29), (0.07, 0.07, 0.065)
    _wave(pen, (pen.main,), place, spread, (22.0, 14.0), size=(0.07, 0.21), rate=(1.3, 3.0))


def _before_face(pen: Pen) -> None:
    place, spread = (0.22, 0.13, -0.36), (0.08, 0.08, 0.07)
    _wave(pen, (pen.main,), place, spread, (26.0, 14.0), size=(0.08, 0.26), rate=(1.2, 3.2))


def _wide(pen: Pen) -> None:
    """The whole arm takes part."""
    place, spread = (0.20, 0.12, -0.32), (0.10, 0.09, 0.08)
    swing: tuple[float, float] = (0.2, 0.36)
    _wave(
        pen, (pen.main,), place, spread, (32.0, 14.0), size=swing, rate=(1.0, 2.3), bend=(0.2, 0.6)
    )


def _high(pen: Pen) -> None:
    place, spread = (0.28, 0.42, -0.18), (0.07, 0.05, 0.06)
    _wave(pen, (pen.main,), place, spread, (45.0, 16.0), size=(0.08, 0.25), rate=(0.9, 2.4))


def _small(pen: Pen) -> None:
    place, spread = (0.30, -0.08, -0.25), (0.05, 0.06, 0.06)
    _wave(pen, (pen.main,), place, spread, (16.0, 10.0), size=(0.03, 0.08), rate=(1.8, 3.6))


def _both_hands(pen: Pen) -> None:
    place, spread = (0.32, 0.14, -0.26), (0.05, 0.10, 0.07)
    _wave(pen, BOTH, place, spread, (25.0, 14.0), size=(0.06, 0.18), rate=(1.2, 3.0))


def _both_high(pen: Pen) -> None:
    place, spread = (0.27, 0.42, -0.14), (0.07, 0.05, 0.07)
    _wave(pen, BOTH, place, spread, (45.0, 14.0), size=(0.08, 0.22), rate=(0.9, 2.2))


WAVING: Mapping[str, Mapping[str, tuple[float, Writer]]] = MappingProxyType(
    {
        "hello": {
            "beside_head": (3.0, _beside_head),
            "before_face": (2.0, _before_face),
            "wide": (1.2, _wide),
            "high": (1.5, _high),
            "small": (1.5, _small),
            "both": (0.8, _both_hands),
            "both_high": (0.6, _both_high),
        },
    }
)
"""Gesture -> variant -> (how often, what writes it)."""
