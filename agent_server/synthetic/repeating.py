"""Gestures that repeat a movement: ``cold`` (rubbing) and ``hot`` (fanning).

Points are written outwards, up and back, in metres for the reference stature.
"""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from agent_server.synthetic.script import BOTH, Hands, Pen, Writer, degrees, flinch
from agent_server.synthetic.trajectory import Vector

# --------------------------------------------------------------------------- hot


def _fan(pen: Pen, hands: Hands, centre: Vector, spread: Vector, size: tuple[float, float]) -> None:
    """Hands wave air towards the face or the neck."""
    arrival = pen.bring(
        hands, "head", centre, spread, (32.0, 14.0), fingers=(-0.9, 0.6, 0.0), median_s=0.75
    )
    release = arrival + max(1.0, pen.hold())
    frequency = pen.uniform(1.8, 4.2) * pen.person.tempo**0.5
    amplitude = pen.uniform(*size) * pen.person.vigour * min(1.0, 3.0 / frequency)
    angle = pen.uniform(-0.6, 1.3)
    lift = pen.uniform(-0.2, 0.5)
    opposed = pen.chance(0.3)
    for side in hands:
        pen.swing(
            side,
            arrival - pen.uniform(0.1, 0.3),
            release + 0.15,
            (amplitude * np.sin(angle), amplitude * lift, amplitude * np.cos(angle)),
            frequency,
            across=(0.2 * amplitude, 0.25 * amplitude, 0.0),
            phase_rad=np.pi * (side if opposed else 0) + pen.rng.normal(0, 0.3),
        )
    end = pen.lower(hands, release)
    flinch(pen, pen.start_s + 0.15, end, -6)


def _fan_one(pen: Pen) -> None:
    _fan(pen, (pen.main,), (0.14, -0.23, -0.22), (0.05, 0.06, 0.05), (0.035, 0.10))


def _fan_both(pen: Pen) -> None:
    _fan(pen, BOTH, (0.18, -0.21, -0.21), (0.04, 0.05, 0.04), (0.03, 0.09))


def _neck(pen: Pen) -> None:
    """The open hand moves to and fro at the neck."""
    _fan(pen, (pen.main,), (0.11, -0.265, -0.17), (0.035, 0.03, 0.03), (0.035, 0.08))


def _collar(pen: Pen) -> None:
    """A hand or both hands pull at the collar and let air in."""
    hands = BOTH if pen.chance(0.3) else (pen.main,)
    place, spread = (0.06, -0.29, -0.15), (0.025, 0.03, 0.02)
    arrival = pen.bring(hands, "head", place, spread, (42.0, 14.0), fingers=(-0.8, 0.4, 0.3))
    release = arrival + max(1.0, pen.hold())
    size = pen.uniform(0.028, 0.06) * pen.person.vigour
    frequency = pen.uniform(1.2, 3.0)
    for side in hands:
        pen.swing(side, arrival, release + 0.1, (0.2 * size, -0.2 * size, -size), frequency)
    end = pen.lower(hands, release)
    flinch(pen, pen.start_s + 0.15, end, -8)


# --------------------------------------------------------------------------- cold


def _rub(pen: Pen, sides: Hands, arrival: float, release: float, size: float, rate: float) -> None:
    """Hands go up and down the opposite arms."""
    opposed = pen.chance(0.45)
    for side in sides:
        mine = size * pen.uniform(0.8, 1.2)
        pen.swing(
            side,
            arrival - pen.uniform(0.0, 0.25),
            release + 0.1,
            (-0.1 * mine, mine, 0.3 * mine),
            rate * pen.uniform(0.97, 1.03),
            phase_rad=np.pi * (side if opposed else 0) + pen.rng.normal(0, 0.35),
        )


def _shiver(pen: Pen, start_s: float, stop_s: float) -> None:
    """Drawn-in trunk, now and then with a tremor."""
    hunch = degrees(pen.uniform(0, 9), pen.rng.normal(0, 1.5), pen.rng.normal(0, 3))
    pen.turn_and_back("trunk", start_s, stop_s, hunch, share=0.25)
    if pen.chance(0.5):
        pen.turn_and_back("head", start_s, stop_s, degrees(pen.uniform(0, 12), 0, 0), share=0.3)
    if pen.chance(0.35):
        shake = degrees(0.2, 0.5, 0.8)
        pen.sway("trunk", start_s + 0.5, stop_s - 0.3, shake, pen.uniform(3.0, 6.0))


def _hug(pen: Pen, height: float, low: float, high: float) -> None:
    """Crossed arms, each hand on the other arm."""
    place, spread = (-0.11, height, -0.18), (0.03, 0.035, 0.02)
    apart = {pen.main: (0.0, 0.03, -0.045), 1 - pen.main: (0.0, -0.01, 0.0)}
    fingers = (-0.6, 0.3, 0.5)
    arrival = pen.bring(
        BOTH, "chest", place, spread, (40.0, 12.0), fingers=fingers, median_s=0.95, apart=apart
    )
    release = arrival + max(1.0, pen.hold())
    size = pen.uniform(low, high) * pen.person.vigour
    frequency = pen.uniform(1.0, 3.6) * pen.person.tempo**0.5
    _rub(pen, BOTH, arrival, release, size * min(1.0, 2.6 / frequency), frequency)
    end = pen.lower(BOTH, release, median_s=1.0)
    _shiver(pen, pen.start_s, end)


def _upper_arms(pen: Pen) -> None:
    _hug(pen, -0.20, 0.025, 0.075)


def _shoulders(pen: Pen) -> None:
    _hug(pen, -0.11, 0.02, 0.05)


def _elbows(pen: Pen) -> None:
    _hug(pen, -0.28, 0.02, 0.06)


def _one_arm(pen: Pen) -> None:
    """One hand rubs the other arm, which hangs or lies before the belly."""
    side, other = pen.main, 1 - pen.main
    start = pen.start_s
    bent = pen.chance(0.6)
    if bent:
        point = pen.around((0.04, -0.38, -0.26), (0.05, 0.05, 0.03))
        pen.reach(other, start, pen.seconds(0.8), "chest", point, bow=(0.0, 0.0, -0.05))
    place, spread = (-0.14, -0.22, -0.155), (0.025, 0.04, 0.02)
    arrival = pen.bring((side,), "chest", place, spread, (42.0, 10.0), fingers=(-0.7, 0.2, 0.5))
    release = arrival + max(1.0, pen.hold())
    size = pen.uniform(0.03, 0.09) * pen.person.vigour
    _rub(pen, (side,), arrival, release, size, pen.uniform(1.0, 3.0))
    end = pen.lower((side, other) if bent else (side,), release)
    _shiver(pen, start, end)


def _alternating(pen: Pen) -> None:
    """First one hand rubs the other arm, then the other way round."""
    first, second = pen.main, 1 - pen.main
    frequency = pen.uniform(1.2, 3.0)
    size = pen.uniform(0.03, 0.08) * pen.person.vigour
    belly = pen.around((0.03, -0.34, -0.25), 0.03)
    rubbed = pen.around((-0.12, -0.21, -0.18), (0.03, 0.04, 0.02))
    hand = (-0.7, 0.2, 0.5)
    move = pen.seconds(0.85)
    start = pen.start_s
    pen.reach(first, start, move, "chest", rubbed, hand=hand, bow=(0.0, 0.0, -0.08))
    pen.reach(second, start + 0.1, move, "chest", belly, hand=hand, bow=(0.0, 0.0, -0.05))
    arrival = start + move
    change = arrival + pen.uniform(0.8, 1.8)
    _rub(pen, (first,), arrival, change, size, frequency)
    swap = pen.seconds(0.6)
    pen.reach(first, change, swap, "chest", belly, hand=hand, bow=(0.0, -0.05, -0.05))
    pen.reach(second, change, swap, "chest", rubbed, hand=hand, bow=(0.0, 0.03, 0.02))
    release = change + swap + pen.uniform(0.8, 1.8)
    _rub(pen, (second,), change + swap, release, size, frequency)
    end = pen.lower(BOTH, release)
    _shiver(pen, start, end)


REPEATING: Mapping[str, Mapping[str, tuple[float, Writer]]] = MappingProxyType(
    {
        "cold": {
            "upper_arms": (3.0, _upper_arms),
            "shoulders": (1.0, _shoulders),
            "elbows": (1.0, _elbows),
            "one_arm": (1.5, _one_arm),
            "alternating": (1.0, _alternating),
        },
        "hot": {
            "fan_one": (3.0, _fan_one),
            "fan_both": (2.0, _fan_both),
            "neck": (1.5, _neck),
            "collar": (1.0, _collar),
        },
    }
)
"""Gesture -> variant -> (how often, what writes it)."""
