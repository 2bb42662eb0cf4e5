"""Idle actions of people who stand about or sit at a desk."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from agent_server.synthetic.script import BOTH, Hands, Pen, Writer, degrees
from agent_server.synthetic.trajectory import ORIGIN, Vector


def _still(pen: Pen) -> None:
    end = pen.start_s + pen.uniform(2.5, 5.0)
    look = degrees(pen.rng.normal(0, 6), pen.rng.normal(0, 2), pen.rng.normal(0, 10))
    pen.turn_and_back("head", pen.start_s, end, look, share=0.25)


def _look_about(pen: Pen) -> None:
    at = pen.start_s
    for _ in range(int(pen.rng.integers(1, 4))):
        look = degrees(pen.rng.normal(3, 12), pen.rng.normal(0, 4), pen.rng.normal(0, 30))
        at = pen.turn("head", at, pen.seconds(0.5), look) + pen.uniform(0.2, 1.2)
        if pen.chance(0.4):
            yaw = 0.3 * np.degrees(look[2])
            pen.turn("trunk", at - 0.6, pen.seconds(0.7), degrees(pen.rng.normal(0, 3), 0, yaw))
    pen.turn("head", at, pen.seconds(0.5), ORIGIN)
    pen.turn("trunk", at, pen.seconds(0.8), ORIGIN)


def _nod(pen: Pen) -> None:
    """Nods or shakes the head."""
    end = pen.start_s + pen.uniform(1.0, 2.2)
    axis = degrees(pen.uniform(6, 14), 0, 0) if pen.chance(0.5) else degrees(0, 0, 18)
    pen.sway("head", pen.start_s, end, axis, pen.uniform(1.2, 2.4))
    pen.turn("head", end - 0.1, 0.3, ORIGIN)


def _shift_weight(pen: Pen) -> None:
    at = pen.start_s
    reach = 0.3 if pen.placement.seated else 1.0
    for _ in range(int(pen.rng.integers(1, 4))):
        aside = pen.uniform(-0.08, 0.08)
        shift = (reach * aside, -0.01, reach * pen.uniform(-0.03, 0.03))
        duration = pen.seconds(0.9)
        lean = degrees(pen.rng.normal(0, 3), 40 * aside, pen.rng.normal(0, 5))
        pen.turn("trunk", at, duration, lean)
        at = pen.turn("pelvis", at, duration, shift) + pen.uniform(0.0, 1.0)
    pen.turn("trunk", at, 0.9, ORIGIN)
    pen.turn("pelvis", at, 0.9, ORIGIN)


def _lean(pen: Pen) -> None:
    """Leans forward, back or aside for a while."""
    end = pen.start_s + pen.uniform(2.0, 5.0)
    lean = degrees(pen.rng.normal(6, 10), pen.rng.normal(0, 6), pen.rng.normal(0, 10))
    pen.turn_and_back("trunk", pen.start_s, end, lean, share=pen.uniform(0.2, 0.4))


def _touch(
    pen: Pen,
    hands: Hands,
    place: Vector,
    spread: Vector | float,
    hold: tuple[float, float],
    swivel: tuple[float, float] = (45.0, 20.0),
    *,
    rub: float = 0.0,
    pitch: float = 2.0,
) -> None:
    """Hands go to the head, stay or scratch there, and come back."""
    arrival = pen.bring(hands, "head", place, spread, swivel, fingers=(-0.6, 0.5, 0.2))
    release = arrival + pen.uniform(*hold)
    if rub:
        for side in hands:
            along = pen.around(ORIGIN, rub)
            pen.swing(side, arrival - 0.1, release, along, pen.uniform(2.0, 5.0), ramp_s=0.15)
    end = pen.lower(hands, release)
    if pen.chance(0.6):
        tilt = degrees(pen.rng.normal(pitch, 6), pen.rng.normal(0, 6), pen.rng.normal(0, 8))
        pen.turn_and_back("head", pen.start_s + 0.2, end, tilt)


def _scratch_head(pen: Pen) -> None:
    place, spread = (0.10, 0.11, 0.0), (0.03, 0.04, 0.05)
    _touch(pen, (pen.main,), place, spread, (0.5, 2.0), (80.0, 18.0), rub=0.015)


def _scratch_cheek(pen: Pen) -> None:
    _touch(pen, (pen.main,), (0.14, -0.13, -0.10), (0.02, 0.03, 0.02), (0.3, 1.2), rub=0.012)


def _hair(pen: Pen) -> None:
    """A hand runs through the hair, from the forehead back."""
    side = pen.main
    arrival = pen.bring((side,), "head", (0.09, 0.07, -0.13), 0.025, (72.0, 14.0))
    back = pen.around((0.11, 0.10, 0.05), 0.03)
    stroke = pen.seconds(0.6)
    end = pen.reach(side, arrival, stroke, "head", back, 90.0, bow=(0.06, 0.05, 0.0))
    pen.lower((side,), end + pen.uniform(0, 0.5))


def _glasses(pen: Pen) -> None:
    _touch(pen, (pen.main,), (0.13, -0.05, -0.12), (0.02, 0.03, 0.02), (0.1, 0.5))


def _neck_rub(pen: Pen) -> None:
    place, spread = (0.06, -0.05, 0.09), (0.02, 0.025, 0.02)
    _touch(pen, (pen.main,), place, spread, (0.8, 2.5), (95.0, 14.0), rub=0.01)


def _chin(pen: Pen) -> None:
    place, spread = (0.05, -0.265, -0.115), (0.02, 0.02, 0.02)
    _touch(pen, (pen.main,), place, spread, (1.0, 4.0), (30.0, 12.0), pitch=6)


def _phone(pen: Pen) -> None:
    place, spread = (0.14, -0.125, -0.075), (0.018, 0.03, 0.025)
    _touch(pen, (pen.main,), place, spread, (2.0, 5.0), (50.0, 18.0))


def _drink(pen: Pen) -> None:
    side = pen.main
    pick = pen.around((0.12, -0.36, -0.32), 0.05)
    at = pen.reach(side, pen.start_s, pen.seconds(0.8), "chest", pick)
    lips = pen.around((0.07, -0.20, -0.235), (0.02, 0.02, 0.02))
    at += pen.uniform(0.0, 0.5)
    arrival = pen.reach(side, at, pen.seconds(0.9), "head", lips, pen.uniform(30, 70))
    drunk = arrival + pen.uniform(0.6, 2.0)
    tilt = degrees(-pen.uniform(5, 20), 0, 0)
    pen.turn_and_back("head", at + 0.4, drunk + 0.4, tilt)
    down = pen.reach(side, drunk, pen.seconds(0.8), "chest", pick)
    pen.lower((side,), down + pen.uniform(0, 0.4))


def _fold(pen: Pen) -> None:
    """Folds the arms and keeps them still."""
    over = pen.main
    apart = {over: (0.0, 0.0, -0.045)}
    place, spread = (-0.05, -0.28, -0.19), (0.03, 0.03, 0.02)
    arrival = pen.bring(
        BOTH, "chest", place, spread, (42.0, 10.0), fingers=(-0.9, 0.2, 0.0), apart=apart
    )
    pen.lower(BOTH, arrival + pen.uniform(1.0, 5.0))


def _hips(pen: Pen) -> None:
    hands = BOTH if pen.chance(0.7) else (pen.main,)
    place, fingers = (0.205, 0.17, -0.05), (-0.6, -0.3, -0.5)
    arrival = pen.bring(hands, "pelvis", place, 0.02, (80.0, 10.0), fingers=fingers)
    pen.lower(hands, arrival + pen.uniform(0.8, 4.0))


def _stretch(pen: Pen) -> None:
    place, spread = (0.22, 0.46, 0.0), (0.14, 0.08, 0.06)
    arrival = pen.bring(BOTH, "chest", place, spread, (50.0, 15.0), median_s=1.2)
    release = arrival + pen.uniform(0.4, 2.0)
    end = pen.lower(BOTH, release, median_s=1.2)
    pen.turn_and_back("trunk", pen.start_s, end, degrees(-pen.uniform(2, 10), 0, 0))


def _talk(pen: Pen) -> None:
    """Hands beat along with speech before the chest."""
    hands = BOTH if pen.chance(0.65) else (pen.main,)
    at = pen.bring(hands, "chest", (0.15, -0.32, -0.30), (0.06, 0.06, 0.05), median_s=0.7)
    for _ in range(int(pen.rng.integers(2, 8))):
        beat = pen.seconds(0.4)
        side = hands[int(pen.rng.integers(len(hands)))]
        for moved in hands if pen.chance(0.6) else (side,):
            spot = pen.around((0.18, -0.27, -0.30), (0.09, 0.10, 0.07))
            pen.reach(moved, at, beat, "chest", spot)
        at += beat + pen.uniform(-0.1, 0.5)
    pen.sway("head", pen.start_s, at, degrees(4, 2, 5), pen.uniform(0.5, 1.2))
    pen.turn("head", at, 0.2, ORIGIN)
    pen.lower(hands, at + 0.1)


def _point(pen: Pen) -> None:
    target = pen.around((0.24, -0.02, -0.52), (0.24, 0.14, 0.10))
    arrival = pen.bring((pen.main,), "chest", target, 0.02, median_s=0.7)
    side_turn = 15.0 * (1 if pen.main == 0 else -1) * (target[0] > 0.3)
    end = pen.lower((pen.main,), arrival + pen.uniform(0.3, 2.0))
    pen.turn_and_back("head", pen.start_s, end, degrees(0, 0, side_turn + pen.rng.normal(0, 8)))


def _grasp(pen: Pen) -> None:
    """Takes something from a table or a shelf and puts it elsewhere."""
    hands = BOTH if pen.chance(0.3) else (pen.main,)
    at = pen.start_s
    first = pen.around((0.20, -0.25, -0.42), (0.14, 0.20, 0.08))
    end = at
    for target in (first, pen.around(first, 0.12)):
        for side in hands:
            arrival = pen.reach(side, at, pen.seconds(0.8), "chest", target)
            end = max(end, arrival)
        at = end + pen.uniform(0.1, 0.8)
    end = pen.lower(hands, at)
    pen.turn_and_back("trunk", pen.start_s, end, degrees(pen.uniform(0, 14), 0, 0))


def _type(pen: Pen) -> None:
    if pen.placement.seated:
        arrival = pen.bring(BOTH, "pelvis", (0.11, 0.24, -0.38), (0.03, 0.03, 0.03))
    else:
        arrival = pen.bring(BOTH, "chest", (0.11, -0.36, -0.33), (0.03, 0.04, 0.03))
    release = arrival + pen.uniform(2.0, 5.0)
    for side in BOTH:
        size = pen.uniform(0.003, 0.010)
        pen.swing(
            side, arrival, release, (size, size, 0), pen.uniform(2, 5), across=(0, size, size)
        )
    pen.lower(BOTH, release)
    pen.turn_and_back("head", pen.start_s, release, degrees(pen.uniform(0, 20), 0, 0))


def _mouse(pen: Pen) -> None:
    place = (0.24, 0.22, -0.38) if pen.placement.seated else (0.24, -0.02, -0.34)
    side = pen.main
    arrival = pen.bring((side,), "pelvis", place, (0.05, 0.03, 0.04))
    release = arrival + pen.uniform(1.5, 4.0)
    pen.swing(side, arrival, release, (0.03, 0, 0), pen.uniform(0.4, 1.2), across=(0, 0, 0.02))
    pen.lower((side,), release)


def _text(pen: Pen) -> None:
    """Holds a phone or a book before the chest and looks at it."""
    hands = BOTH if pen.chance(0.7) else (pen.main,)
    arrival = pen.bring(hands, "chest", (0.05, -0.27, -0.29), (0.02, 0.06, 0.04))
    release = arrival + pen.uniform(1.5, 5.0)
    for side in hands:
        pen.swing(side, arrival, release, (0.004, 0.004, 0), pen.uniform(1, 3))
    end = pen.lower(hands, release)
    pen.turn_and_back("head", pen.start_s, end, degrees(pen.uniform(10, 28), 0, 0))


def _watch(pen: Pen) -> None:
    side = 1 - pen.main
    spot = pen.around((-0.02, -0.22, -0.30), 0.04)
    arrival = pen.bring((side,), "chest", spot, 0.02, median_s=0.7)
    end = pen.lower((side,), arrival + pen.uniform(0.4, 1.5))
    pen.turn_and_back("head", pen.start_s, end, degrees(20, 0, 8 if side == 0 else -8))


def _clothes(pen: Pen) -> None:
    """Straightens a shirt or a jacket."""
    arrival = pen.bring(BOTH, "chest", (0.10, -0.36, -0.18), (0.04, 0.10, 0.02))
    release = arrival + pen.uniform(0.5, 2.0)
    for side in BOTH:
        pen.swing(side, arrival, release, (0.01, 0.02, 0.01), pen.uniform(0.8, 2.0))
    pen.lower(BOTH, release)


def _half_way(pen: Pen) -> None:
    """Begins to raise the hands, thinks better of it and lowers them."""
    hands = BOTH if pen.chance(0.5) else (pen.main,)
    place, spread = (0.16, -0.27, -0.30), (0.07, 0.09, 0.05)
    arrival = pen.bring(hands, "chest", place, spread, median_s=0.6)
    pen.lower(hands, arrival + pen.uniform(-0.1, 0.5), median_s=0.75)


def _change_rest(pen: Pen) -> None:
    """Lets the hands rest elsewhere for a while."""
    hands = BOTH if pen.chance(0.6) else (pen.main,)
    spots = ((0.05, 0.10, -0.21), (0.13, 0.12, -0.26), (0.21, 0.05, -0.05), (0.06, 0.09, 0.17))
    spot = spots[int(pen.rng.integers(3 if pen.placement.seated else 4))]
    arrival = pen.bring(hands, "pelvis", spot, 0.02, median_s=1.0)
    pen.lower(hands, arrival + pen.uniform(1.0, 4.0), median_s=1.0)


EVERYDAY: Mapping[str, tuple[float, Writer]] = MappingProxyType(
    {
        "still": (3.5, _still),
        "look_about": (2.0, _look_about),
        "nod": (0.6, _nod),
        "shift_weight": (1.6, _shift_weight),
        "lean": (1.5, _lean),
        "scratch_head": (1.8, _scratch_head),
        "scratch_cheek": (1.3, _scratch_cheek),
        "hair": (1.5, _hair),
        "glasses": (1.4, _glasses),
        "neck_rub": (0.8, _neck_rub),
        "chin": (2.2, _chin),
        "phone": (2.2, _phone),
        "drink": (2.2, _drink),
        "fold": (2.6, _fold),
        "hips": (1.2, _hips),
        "stretch": (1.2, _stretch),
        "talk": (3.0, _talk),
        "point": (1.5, _point),
        "grasp": (2.0, _grasp),
        "type": (1.5, _type),
        "mouse": (0.7, _mouse),
        "text": (1.2, _text),
        "watch": (0.7, _watch),
        "clothes": (0.8, _clothes),
        "half_way": (1.5, _half_way),
        "change_rest": (1.2, _change_rest),
    }
)
"""Action -> (how often, what writes it)."""
