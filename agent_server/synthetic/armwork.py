"""Idle actions with large movements of the arms: sport, games, signals."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from agent_server.synthetic.script import BOTH, Hands, Pen, Writer, degrees
from agent_server.synthetic.trajectory import ORIGIN, Vector


def _lift_arms(pen: Pen) -> None:
    """Stretched arms go out and up, stay, and come down."""
    out, up = pen.around((0.68, -0.02, -0.08), 0.06), pen.around((0.30, 0.50, -0.05), 0.1)
    half = pen.seconds(0.7)
    for side in BOTH:
        pen.reach(side, pen.start_s, half, "chest", out, bow=(0.08, 0, 0))
        pen.reach(side, pen.start_s + 0.7 * half, half, "chest", up, bow=(0.1, 0, 0))
    arrival = pen.start_s + 1.7 * half
    release = arrival + pen.uniform(0.0, 1.5)
    if pen.chance(0.5):
        for side in BOTH:
            pen.reach(side, release, half, "chest", out, bow=(0.1, 0, 0))
        release += 0.7 * half
    pen.lower(BOTH, release)


def _sideways(pen: Pen) -> None:
    """Spreads both arms like wings."""
    place, spread = (0.68, -0.04, -0.10), (0.06, 0.15, 0.10)
    arrival = pen.bring(BOTH, "chest", place, spread)
    release = arrival + pen.uniform(0.2, 2.0)
    if pen.chance(0.3):
        for side in BOTH:
            pen.swing(side, arrival, release, (0, pen.uniform(0.03, 0.15), 0), pen.uniform(0.6, 2))
    pen.lower(BOTH, release)


def _push_side(pen: Pen) -> None:
    """One hand sweeps across, out or in."""
    height = pen.uniform(-0.45, -0.02)
    spots: list[Vector] = [
        (pen.uniform(-0.12, 0.12), height, -pen.uniform(0.22, 0.42)),
        (pen.uniform(0.42, 0.62), height + pen.rng.normal(0, 0.05), -pen.uniform(0.05, 0.35)),
    ]
    if pen.chance(0.35):
        spots.reverse()
    end = pen.through((pen.main,), spots, 0.6, spread=0.04)
    pen.lower((pen.main,), end + pen.uniform(0, 0.4))
    if pen.chance(0.5):
        pen.turn_and_back("trunk", pen.start_s, end + 0.5, degrees(0, 0, pen.rng.normal(0, 12)))


def _push_forward(pen: Pen) -> None:
    hands = BOTH if pen.chance(0.7) else (pen.main,)
    spots: list[Vector] = [(0.15, -0.16, -0.22), (0.17, -0.05, -0.56)]
    end = pen.through(hands, spots, 0.5)
    pen.lower(hands, end + pen.uniform(0, 0.6))


def _throw(pen: Pen) -> None:
    """Over or under the shoulder."""
    spots: list[Vector] = [
        (pen.uniform(0.26, 0.42), pen.uniform(-0.1, 0.24), pen.uniform(-0.05, 0.22)),
        (0.24, pen.uniform(0.0, 0.28), -0.30),
        (0.03, -0.22, -0.50),
    ]
    if pen.chance(0.25):
        spots = [(0.30, -0.48, 0.18), (0.18, -0.25, -0.42), (0.05, 0.08, -0.45)]
    end = pen.through((pen.main,), spots, pen.uniform(0.6, 0.8))
    hands: Hands = (pen.main,)
    if pen.chance(0.4):
        # The other hand reaches ahead for balance.
        ahead = pen.around((0.18, -0.38, -0.32), (0.06, 0.12, 0.12))
        pen.reach(1 - pen.main, pen.start_s, pen.seconds(0.6), "chest", ahead)
        hands = BOTH
    pen.lower(hands, end)
    yaw = 16.0 * (1 if pen.main == 0 else -1)
    pen.turn("trunk", pen.start_s, 0.6, degrees(-3, 0, yaw))
    pen.turn("trunk", pen.start_s + 0.6, 0.4, degrees(12, 0, -yaw))
    pen.turn("trunk", end, 0.8, ORIGIN)


def _shoot(pen: Pen) -> None:
    """Both hands forward as if they held a pistol, or a ball to the basket."""
    if pen.chance(0.3):
        spots: list[Vector] = [(0.06, -0.05, -0.25), (0.10, 0.35, -0.35)]
        end = pen.through(BOTH, spots, 0.55)
    else:
        shared = pen.around((0.035, -0.08, -0.48), (0.015, 0.08, 0.05))
        end = pen.bring(BOTH, "chest", shared, 0.01)
        for _ in range(int(pen.rng.integers(0, 4))):
            kicked = (shared[0], shared[1] + 0.06, shared[2] + 0.05)
            for side in BOTH:
                pen.reach(side, end, 0.12, "chest", kicked)
                pen.reach(side, end + 0.12, 0.3, "chest", shared)
            end += pen.uniform(0.45, 0.9)
    pen.lower(BOTH, end + pen.uniform(0.1, 1.0))


def _punch(pen: Pen) -> None:
    guard = pen.around((0.12, -0.08, -0.25), (0.03, 0.06, 0.04))
    at = pen.bring(BOTH, "chest", guard, 0.01, median_s=0.6)
    for index in range(int(pen.rng.integers(1, 6))):
        side = pen.main if pen.chance(0.3) else index % 2
        target = pen.around((0.06, 0.02, -0.53), 0.07)
        out, back = pen.uniform(0.16, 0.3), pen.uniform(0.2, 0.35)
        pen.reach(side, at, out, "chest", target)
        pen.reach(side, at + out, back, "chest", guard)
        at += out + back + pen.uniform(-0.1, 0.3)
    pen.sway("trunk", pen.start_s, at, degrees(1, 0, 8), 1.2)
    pen.lower(BOTH, at + 0.1)


def _club(pen: Pen) -> None:
    """Swings a bat, a club or a racket."""
    side = 1 if pen.main else -1
    hands = BOTH if pen.chance(0.6) else (pen.main,)
    back = pen.around((0.36, pen.uniform(-0.25, 0.25), -0.12), 0.05)
    front = pen.around((-0.10, pen.uniform(-0.3, 0.2), -0.42), 0.06)
    windup, stroke = pen.seconds(0.7), max(0.42, pen.seconds(0.5))
    for hand in hands:
        sign = 1.0 if hand == pen.main else -1.0
        for begin, duration, spot in (
            (pen.start_s, windup, back),
            (pen.start_s + windup, stroke, front),
        ):
            own = (sign * spot[0] + 0.02, spot[1], spot[2] - 0.06 * (sign < 0))
            pen.reach(hand, begin, duration, "chest", own, bow=(0, 0, -0.08))
    pen.turn("trunk", pen.start_s, windup, degrees(4, 0, -25 * side))
    pen.turn("trunk", pen.start_s + windup, stroke, degrees(6, 0, 30 * side))
    end = pen.start_s + windup + stroke + pen.uniform(0.0, 0.4)
    pen.turn("trunk", end, 0.8, ORIGIN)
    pen.lower(hands, end)


def _circles(pen: Pen) -> None:
    """One or both hands draw circles or other figures before the body."""
    hands = BOTH if pen.chance(0.5) else (pen.main,)
    place, spread = (0.16, -0.12, -0.40), (0.08, 0.12, 0.06)
    arrival = pen.bring(hands, "chest", place, spread, median_s=0.6)
    size = pen.uniform(0.06, 0.3)
    flat = pen.chance(0.3)
    along = (size, 0.0, 0.0) if not flat else (0.0, 0.6 * size, 0.0)
    across = (0.0, pen.uniform(0.3, 1.0) * size, 0.0) if not flat else (0.0, 0.0, 0.6 * size)
    frequency = pen.uniform(0.6, 1.8) * min(1.0, 0.2 / size)
    stop = arrival + pen.uniform(1.0, 3.0) / frequency
    opposed = pen.chance(0.4)
    for side in hands:
        phase = np.pi * side * opposed
        pen.swing(side, arrival - 0.2, stop, along, frequency, across=across, phase_rad=phase)
    pen.lower(hands, stop)


def _strokes(pen: Pen) -> None:
    """Draws straight lines in the air: a cross, a triangle, a letter."""
    spots = [pen.around((0.12, -0.08, -0.44), (0.15, 0.14, 0.04)) for _ in range(4)]
    end = pen.through((pen.main,), spots[: int(pen.rng.integers(2, 5))], 0.45, spread=0.02)
    pen.lower((pen.main,), end)


def _weapon(pen: Pen) -> None:
    """A hand goes over a shoulder, as if to draw a sword, and returns to the front."""
    behind = pen.around((0.14, 0.13, 0.09), 0.03)
    if pen.chance(0.65):
        behind = pen.around((-0.14, 0.12, -0.12), (0.05, 0.08, 0.06))
    first = pen.seconds(0.8)
    pen.reach(
        pen.main,
        pen.start_s,
        first,
        "chest",
        behind,
        None if behind[0] < 0 else 105.0,
        bow=(0.0, 0, -0.1),
    )
    at = pen.start_s + first + pen.uniform(0, 0.4)
    front = pen.around((0.12, -0.28, -0.32), 0.05)
    move = pen.seconds(0.7)
    pen.reach(pen.main, at, move, "chest", front, bow=(0.1, 0.05, 0))
    hands: Hands = (pen.main,)
    if pen.chance(0.6):
        pen.reach(1 - pen.main, at, move, "chest", pen.around(front, 0.06))
        hands = BOTH
    pen.lower(hands, at + move + pen.uniform(0, 0.8))


def _drum(pen: Pen) -> None:
    """Both hands beat up and down before the body, together or in turn."""
    place, spread = (0.18, -0.16, -0.34), (0.06, 0.14, 0.06)
    arrival = pen.bring(BOTH, "chest", place, spread, median_s=0.6)
    stop = arrival + pen.uniform(1.0, 3.0)
    size, frequency = pen.uniform(0.05, 0.2), pen.uniform(0.8, 3.0)
    opposed = pen.chance(0.5)
    for side in BOTH:
        along = (0.0, size * min(1.0, 1.8 / frequency), -0.3 * size)
        pen.swing(side, arrival - 0.2, stop, along, frequency, phase_rad=np.pi * side * opposed)
    pen.lower(BOTH, stop)


def _beat_time(pen: Pen) -> None:
    """Stretches out both arms and beats inwards and outwards, as a conductor does."""
    place, spread = (0.46, 0.08, -0.14), (0.06, 0.16, 0.10)
    arrival = pen.bring(BOTH, "chest", place, spread, median_s=0.7)
    stop = arrival + pen.uniform(0.8, 2.5)
    along = (pen.uniform(0.06, 0.18), pen.rng.normal(0, 0.05), 0.0)
    frequency = pen.uniform(0.7, 2.2)
    for side in BOTH:
        pen.swing(side, arrival - 0.2, stop, along, frequency)
    pen.lower(BOTH, stop)


def _clap(pen: Pen) -> None:
    place, spread = (0.12, -0.22, -0.34), (0.02, 0.10, 0.05)
    arrival = pen.bring(BOTH, "chest", place, spread, median_s=0.6)
    stop = arrival + pen.uniform(0.8, 3.0)
    frequency = pen.uniform(1.5, 4.0)
    size = pen.uniform(0.05, 0.12) * min(1.0, 2.5 / frequency)
    for side in BOTH:
        pen.swing(side, arrival - 0.1, stop, (size, 0, 0), frequency, unevenness=0.05)
    pen.lower(BOTH, stop)


def _knock(pen: Pen) -> None:
    place, spread = (0.14, 0.0, -0.40), (0.05, 0.08, 0.05)
    arrival = pen.bring((pen.main,), "chest", place, spread, median_s=0.6)
    stop = arrival + pen.uniform(0.6, 1.8)
    along = (0.0, 0.02, -pen.uniform(0.03, 0.11))
    pen.swing(pen.main, arrival - 0.1, stop, along, pen.uniform(1.8, 4.0), ramp_s=0.15)
    pen.lower((pen.main,), stop)


def _curl(pen: Pen) -> None:
    hands = BOTH if pen.chance(0.8) else (pen.main,)
    spots: list[Vector] = [(0.20, -0.10, -0.20), (0.22, -0.48, -0.12)]
    end = pen.through(hands, spots * int(pen.rng.integers(1, 3)), 0.7, spread=0.03)
    pen.lower(hands, end)


def _catch(pen: Pen) -> None:
    place, spread = (0.10, -0.12, -0.42), (0.05, 0.15, 0.06)
    arrival = pen.bring(BOTH, "chest", place, spread, median_s=0.45)
    hugged = pen.around((0.08, -0.28, -0.22), 0.03)
    for side in BOTH:
        pen.reach(side, arrival, 0.35, "chest", hugged)
    pen.lower(BOTH, arrival + 0.35 + pen.uniform(0, 1.0))


def _signal(pen: Pen) -> None:
    """Directs traffic: arms go from one stretched or bent pose to the next."""
    at = pen.start_s
    for _ in range(int(pen.rng.integers(2, 5))):
        hands = BOTH if pen.chance(0.4) else (int(pen.rng.integers(2)),)
        move = pen.seconds(0.6)
        for side in hands:
            x, y, z = pen.around((0.42, 0.06, -0.30), (0.19, 0.22, 0.16))
            spot = (x, y, min(z, -0.1))
            pen.reach(side, at, move, "chest", spot)
        at += move + pen.uniform(0.0, 0.8)
    pen.lower(BOTH, at)


def _anything(pen: Pen) -> None:
    """Hands wander through all the room before the body, swinging now and then."""
    hands = BOTH if pen.chance(0.6) else (pen.main,)
    stop = pen.start_s
    for side in hands:
        at = pen.start_s + pen.uniform(0, 0.4)
        for _ in range(int(pen.rng.integers(1, 5))):
            spot = (pen.uniform(-0.15, 0.62), pen.uniform(-0.5, 0.45), pen.uniform(-0.56, -0.14))
            move = pen.seconds(0.65, 0.3)
            bow = pen.around(ORIGIN, 0.05)
            arrival = pen.reach(side, at, move, "chest", spot, bow=bow)
            at = arrival + pen.uniform(-0.2, 0.8)
            if pen.chance(0.12):
                along = pen.around(ORIGIN, 0.05)
                pen.swing(side, arrival, arrival + 1.2, along, pen.uniform(0.6, 2.5))
        stop = max(stop, at)
    pen.lower(hands, stop)


ARMWORK: Mapping[str, tuple[float, Writer]] = MappingProxyType(
    {
        "lift_arms": (1.5, _lift_arms),
        "sideways": (1.0, _sideways),
        "push_side": (2.4, _push_side),
        "push_forward": (1.0, _push_forward),
        "throw": (2.8, _throw),
        "shoot": (1.3, _shoot),
        "punch": (1.2, _punch),
        "club": (1.0, _club),
        "circles": (2.0, _circles),
        "strokes": (2.0, _strokes),
        "weapon": (2.2, _weapon),
        "drum": (1.3, _drum),
        "beat_time": (1.2, _beat_time),
        "clap": (1.3, _clap),
        "knock": (1.4, _knock),
        "curl": (1.3, _curl),
        "catch": (0.8, _catch),
        "signal": (2.0, _signal),
        "anything": (5.0, _anything),
    }
)
"""Action -> (how often, what writes it)."""
