"""The six gestures of the thesis's Table 5.1, in all the ways in which people do them.

Points are written outwards, up and back, in metres for the reference stature. Where wrists
come to rest at the face, how fast they get there and how far they swing was tuned on Kinect
recordings of people who cover their eyes, hold their head and wave; see ``docs/synthetic.md``.
"""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from agent_server.errors import InvalidInput
from agent_server.synthetic.script import BOTH, Hands, Pen, Script, Writer, degrees
from agent_server.synthetic.trajectory import Vector


def _elbow(pen: Pen) -> Vector:
    """Where elbows point while hands are at the face: from hanging to raised sideways."""
    raised = pen.uniform(-0.85, 0.25)
    return pen.around((0.75, raised, -0.35), (0.12, 0.1, 0.25))


def _flinch(pen: Pen, start_s: float, stop_s: float, pitch: float, spread: float = 6) -> None:
    """Head and trunk give way while the hands are up: often, but not always."""
    if pen.chance(0.6):
        yaw = pen.rng.normal(0, 7)
        roll = pen.rng.normal(0, 3)
        turn = degrees(pen.rng.normal(pitch, spread), roll, yaw)
        pen.turn_and_back("head", start_s, stop_s, turn, share=pen.uniform(0.2, 0.4))
    if pen.chance(0.4):
        turn = degrees(pen.rng.normal(0.4 * pitch, 4), pen.rng.normal(0, 2), pen.rng.normal(0, 5))
        pen.turn_and_back("trunk", start_s, stop_s, turn, share=pen.uniform(0.2, 0.4))


def _fidget(pen: Pen, hands: Hands, start_s: float, stop_s: float) -> None:
    """Hands that hold something are never quite still."""
    for side in hands:
        size = pen.person.liveliness * pen.uniform(0.001, 0.006)
        along = pen.around((0.0, 0.0, 0.0), size)
        pen.swing(side, start_s, stop_s, along, pen.uniform(0.5, 1.8), ramp_s=0.4)


def _at_face(
    pen: Pen, hands: Hands, centre: Vector, spread: Vector, fingers: Vector, pitch: float
) -> None:
    """Raises hands to the face, holds them there, lowers them."""
    shared = pen.around(centre, spread)
    pole = _elbow(pen)

    def place(side: int) -> tuple[Vector, Vector, Vector]:
        return pen.around(shared, 0.012), pen.around(pole, 0.06), pen.around(fingers, 0.15)

    arrival = pen.raise_to(hands, "head", place)
    release = arrival + pen.hold()
    _fidget(pen, hands, arrival - 0.2, release)
    end = pen.lower(hands, release)
    _flinch(pen, pen.start_s + 0.15, end, pitch)


# --------------------------------------------------------------------------- bright


def _eyes_both(pen: Pen) -> None:
    _at_face(pen, BOTH, (0.115, -0.10, -0.145), (0.028, 0.035, 0.025), (-0.7, 0.6, 0.3), 8)


def _eyes_one(pen: Pen) -> None:
    hands = (pen.main,)
    _at_face(pen, hands, (0.09, -0.08, -0.15), (0.04, 0.035, 0.025), (-0.9, 0.4, 0.2), 8)


def _visor(pen: Pen) -> None:
    hands = (pen.main,)
    _at_face(pen, hands, (0.14, 0.015, -0.14), (0.035, 0.03, 0.035), (-1.0, 0.3, 0.0), 4)


def _visor_both(pen: Pen) -> None:
    _at_face(pen, BOTH, (0.135, 0.01, -0.14), (0.03, 0.03, 0.03), (-1.0, 0.4, 0.0), 4)


def _forearm(pen: Pen) -> None:
    hands = (pen.main,)
    shared = pen.around((-0.10, 0.03, -0.19), (0.05, 0.04, 0.03))
    pole = pen.around((0.9, 0.0, -0.5), 0.15)
    arrival = pen.raise_to(hands, "head", lambda _: (shared, pole, (-0.5, 0.3, 0.0)))
    release = arrival + pen.hold()
    _fidget(pen, hands, arrival, release)
    end = pen.lower(hands, release)
    away = degrees(pen.rng.normal(10, 6), 0, pen.rng.normal(0, 12))
    pen.turn_and_back("head", pen.start_s + 0.1, end, away)


# --------------------------------------------------------------------------- loud


def _ears_palms(pen: Pen) -> None:
    _at_face(pen, BOTH, (0.145, -0.015, -0.07), (0.02, 0.03, 0.035), (-0.3, 0.8, 0.5), 6)


def _ears_fingers(pen: Pen) -> None:
    _at_face(pen, BOTH, (0.165, -0.055, -0.065), (0.018, 0.03, 0.03), (-0.8, 0.5, 0.2), 8)


def _ears_clutch(pen: Pen) -> None:
    _at_face(pen, BOTH, (0.145, 0.04, -0.01), (0.022, 0.03, 0.035), (-0.3, 0.9, 0.4), 14)


def _ears_front(pen: Pen) -> None:
    _at_face(pen, BOTH, (0.12, -0.02, -0.115), (0.02, 0.03, 0.02), (0.0, 0.6, 0.9), 8)


# --------------------------------------------------------------------------- smell


def _pinch(pen: Pen) -> None:
    hands = (pen.main,)
    _at_face(pen, hands, (0.055, -0.155, -0.175), (0.03, 0.03, 0.025), (-0.4, 0.7, 0.5), -3)


def _mouth_both(pen: Pen) -> None:
    _at_face(pen, BOTH, (0.055, -0.185, -0.145), (0.018, 0.022, 0.025), (-0.6, 0.8, 0.3), 3)


def _mouth_one(pen: Pen) -> None:
    hands = (pen.main,)
    _at_face(pen, hands, (0.075, -0.155, -0.14), (0.03, 0.025, 0.03), (-1.0, 0.3, 0.3), -3)


def _pinch_and_turn(pen: Pen) -> None:
    _pinch(pen)
    stop = pen.start_s + 1.6
    away = degrees(-4, 0, pen.rng.choice((-1, 1)) * pen.uniform(15, 40))
    pen.turn_and_back("head", pen.start_s + 0.3, stop, away)


# --------------------------------------------------------------------------- hot


def _fan(pen: Pen, hands: Hands, centre: Vector, spread: Vector, size: tuple[float, float]) -> None:
    shared = pen.around(centre, spread)
    pole = pen.around((0.55, -0.75, -0.1), (0.2, 0.2, 0.15))
    fingers = pen.around((-0.9, 0.6, 0.0), 0.2)

    def place(side: int) -> tuple[Vector, Vector, Vector]:
        return pen.around(shared, 0.02), pen.around(pole, 0.08), fingers

    arrival = pen.raise_to(hands, "head", place, median_s=0.75)
    release = arrival + max(1.0, pen.hold())
    frequency = pen.uniform(1.8, 4.2) * pen.person.tempo**0.5
    amplitude = pen.uniform(*size) * pen.person.vigour * min(1.0, 3.0 / frequency)
    angle = pen.uniform(-0.6, 1.3)
    lift = pen.uniform(-0.2, 0.5)
    opposed = pen.chance(0.3)
    for side in hands:
        phase = np.pi * (side if opposed else 0) + pen.rng.normal(0, 0.3)
        along = (amplitude * np.sin(angle), amplitude * lift, amplitude * np.cos(angle))
        pen.swing(
            side,
            arrival - pen.uniform(0.1, 0.3),
            release + 0.15,
            along,
            frequency,
            across=(0.2 * amplitude, 0.25 * amplitude, 0.0),
            phase_rad=phase,
        )
    end = pen.lower(hands, release)
    _flinch(pen, pen.start_s + 0.15, end, -6)


def _fan_one(pen: Pen) -> None:
    _fan(pen, (pen.main,), (0.14, -0.23, -0.22), (0.05, 0.06, 0.05), (0.035, 0.10))


def _fan_both(pen: Pen) -> None:
    _fan(pen, BOTH, (0.18, -0.21, -0.20), (0.04, 0.06, 0.05), (0.03, 0.09))


def _neck(pen: Pen) -> None:
    """The open hand moves to and fro at the neck."""
    _fan(pen, (pen.main,), (0.10, -0.27, -0.15), (0.035, 0.03, 0.03), (0.025, 0.06))


def _collar(pen: Pen) -> None:
    """A hand or both hands pull at the collar and let air in."""
    hands = BOTH if pen.chance(0.3) else (pen.main,)
    shared = pen.around((0.06, -0.29, -0.15), (0.025, 0.03, 0.02))
    pole = pen.around((0.7, -0.7, 0.0), 0.15)
    arrival = pen.raise_to(
        hands, "head", lambda _: (pen.around(shared, 0.01), pole, (-0.8, 0.4, 0.3))
    )
    release = arrival + max(1.0, pen.hold())
    size = pen.uniform(0.02, 0.055) * pen.person.vigour
    frequency = pen.uniform(1.2, 3.0)
    for side in hands:
        along = (0.2 * size, -0.2 * size, -size)
        pen.swing(side, arrival, release + 0.1, along, frequency, phase_rad=0.0)
    end = pen.lower(hands, release)
    _flinch(pen, pen.start_s + 0.15, end, -8)


# --------------------------------------------------------------------------- cold


def _rub(
    pen: Pen, sides: Hands, arrival: float, release: float, size: float, frequency: float
) -> None:
    """Hands go up and down the opposite arms."""
    opposed = pen.chance(0.45)
    for side in sides:
        phase = np.pi * (side if opposed else 0) + pen.rng.normal(0, 0.35)
        mine = size * pen.uniform(0.8, 1.2)
        along = (-0.1 * mine, mine, 0.3 * mine)
        pen.swing(
            side,
            arrival - pen.uniform(0.0, 0.25),
            release + 0.1,
            along,
            frequency * pen.uniform(0.97, 1.03),
            phase_rad=phase,
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
    over = pen.main
    shared = pen.around((-0.11, height, -0.18), (0.03, 0.035, 0.02))
    pole = pen.around((0.75, -0.6, -0.15), (0.12, 0.12, 0.12))

    def place(side: int) -> tuple[Vector, Vector, Vector]:
        x, y, z = pen.around(shared, 0.012)
        depth = -0.045 if side == over else 0.0
        return (x, y + (0.03 if side == over else -0.01), z + depth), pole, (-0.6, 0.3, 0.5)

    arrival = pen.raise_to(BOTH, "chest", place, median_s=0.95)
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
        pen.reach(other, start, pen.seconds(0.8), "chest", point, (0.7, -0.7, 0.3))
    rubbed = pen.around((-0.13, -0.22, -0.17), (0.03, 0.05, 0.025))
    pole = pen.around((0.7, -0.6, -0.3), 0.12)
    arrival = pen.raise_to((side,), "chest", lambda _: (rubbed, pole, (-0.7, 0.2, 0.5)))
    release = arrival + max(1.0, pen.hold())
    size = pen.uniform(0.03, 0.09) * pen.person.vigour
    _rub(pen, (side,), arrival, release, size, pen.uniform(1.0, 3.0))
    end = pen.lower((side, other) if bent else (side,), release)
    _shiver(pen, start, end)


def _alternating(pen: Pen) -> None:
    """First one hand rubs the other arm, then the other way round."""
    first, second = pen.main, 1 - pen.main
    pole = pen.around((0.7, -0.6, -0.25), 0.1)
    frequency = pen.uniform(1.2, 3.0)
    size = pen.uniform(0.03, 0.08) * pen.person.vigour
    belly = pen.around((0.03, -0.34, -0.25), 0.03)
    rubbed = pen.around((-0.12, -0.21, -0.18), (0.03, 0.04, 0.02))
    hand = (-0.7, 0.2, 0.5)
    move = pen.seconds(0.85)
    start = pen.start_s
    pen.reach(first, start, move, "chest", rubbed, pole, hand=hand, bow=(0, 0, -0.06))
    pen.reach(second, start + 0.1, move, "chest", belly, pole, hand=hand)
    arrival = start + move
    change = arrival + pen.uniform(0.8, 1.8)
    _rub(pen, (first,), arrival, change, size, frequency)
    swap = pen.seconds(0.6)
    pen.reach(first, change, swap, "chest", belly, pole, hand=hand, bow=(0, -0.05, -0.05))
    pen.reach(second, change, swap, "chest", rubbed, pole, hand=hand, bow=(0, 0.03, 0.02))
    release = change + swap + pen.uniform(0.8, 1.8)
    _rub(pen, (second,), change + swap, release, size, frequency)
    end = pen.lower(BOTH, release)
    _shiver(pen, start, end)


# --------------------------------------------------------------------------- hello


def _wave(
    pen: Pen,
    hands: Hands,
    centre: Vector,
    spread: Vector,
    size: tuple[float, float],
    rate: tuple[float, float],
) -> None:
    shared = pen.around(centre, spread)
    pole = pen.around((0.35, -0.9, 0.05), (0.2, 0.1, 0.2))

    def place(side: int) -> tuple[Vector, Vector, Vector]:
        return pen.around(shared, 0.025), pen.around(pole, 0.08), (0.0, 0.7, 0.0)

    arrival = pen.raise_to(hands, "chest", place, median_s=0.7)
    frequency = pen.uniform(*rate) * pen.person.tempo**0.5
    release = arrival + max(pen.hold(), 1.5 / frequency)
    amplitude = pen.uniform(*size) * pen.person.vigour * min(1.0, 2.2 / frequency)
    mirrored = pen.chance(0.7)
    depth = pen.rng.normal(0, 0.25) * amplitude
    sink = pen.uniform(0.0, 0.2) * amplitude
    for side in hands:
        sign = 1 if mirrored or side == 0 else -1
        pen.swing(
            side,
            arrival - pen.uniform(0.1, 0.35),
            release + 0.15,
            (sign * amplitude, 0.0, depth),
            frequency,
            across=(0.0, sink, 0.1 * amplitude),
            phase_rad=pen.rng.normal(0, 0.4),
            ramp_s=0.2,
        )
    end = pen.lower(hands, release, median_s=0.85)
    if pen.chance(0.3):
        nod = degrees(pen.uniform(-6, 8), pen.rng.normal(0, 4), pen.rng.normal(0, 5))
        pen.turn_and_back("head", pen.start_s, end, nod)
    if pen.chance(0.25):
        lean = degrees(pen.uniform(-3, 5), pen.rng.normal(0, 3), pen.rng.normal(0, 4))
        pen.turn_and_back("trunk", pen.start_s, end, lean)


def _beside_head(pen: Pen) -> None:
    place, spread = (0.33, 0.13, -0.28), (0.07, 0.07, 0.08)
    _wave(pen, (pen.main,), place, spread, (0.07, 0.21), (1.3, 3.0))


def _before_face(pen: Pen) -> None:
    place, spread = (0.20, 0.13, -0.38), (0.08, 0.07, 0.05)
    _wave(pen, (pen.main,), place, spread, (0.10, 0.28), (1.2, 2.6))


def _high(pen: Pen) -> None:
    place, spread = (0.28, 0.42, -0.16), (0.07, 0.05, 0.08)
    _wave(pen, (pen.main,), place, spread, (0.08, 0.25), (0.9, 2.4))


def _small(pen: Pen) -> None:
    place, spread = (0.30, -0.08, -0.25), (0.05, 0.06, 0.06)
    _wave(pen, (pen.main,), place, spread, (0.03, 0.08), (1.8, 3.6))


def _both_hands(pen: Pen) -> None:
    place, spread = (0.35, 0.15, -0.25), (0.06, 0.12, 0.08)
    _wave(pen, BOTH, place, spread, (0.06, 0.18), (1.2, 3.0))


def _both_high(pen: Pen) -> None:
    place, spread = (0.27, 0.42, -0.14), (0.07, 0.05, 0.07)
    _wave(pen, BOTH, place, spread, (0.08, 0.22), (0.9, 2.2))


VARIANTS: Mapping[str, Mapping[str, tuple[float, Writer]]] = MappingProxyType(
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
        "loud": {
            "palms": (3.0, _ears_palms),
            "fingers": (1.5, _ears_fingers),
            "clutch": (2.0, _ears_clutch),
            "front": (1.5, _ears_front),
        },
        "smell": {
            "pinch": (3.0, _pinch),
            "pinch_and_turn": (1.0, _pinch_and_turn),
            "mouth_both": (2.0, _mouth_both),
            "mouth_one": (1.5, _mouth_one),
        },
        "bright": {
            "eyes_both": (3.5, _eyes_both),
            "eyes_one": (1.5, _eyes_one),
            "visor": (1.5, _visor),
            "visor_both": (0.7, _visor_both),
            "forearm": (1.0, _forearm),
        },
        "hello": {
            "beside_head": (3.0, _beside_head),
            "before_face": (2.0, _before_face),
            "high": (1.5, _high),
            "small": (1.5, _small),
            "both": (1.0, _both_hands),
            "both_high": (0.7, _both_high),
        },
    }
)
"""Gesture -> variant -> (how often, what writes it)."""


def write_gesture(pen: Pen, gesture: str, variant: str | None = None) -> Script:
    """Writes one of the six gestures; without ``variant`` one is drawn.

    Raises:
        InvalidInput: If there is no such gesture or variant.
    """
    if gesture not in VARIANTS:
        raise InvalidInput(
            f"gesture is '{gesture}', expected one of {', '.join(VARIANTS)}", field="gesture"
        )
    ways = VARIANTS[gesture]
    if variant is None:
        weights = np.array([weight for weight, _ in ways.values()])
        variant = str(pen.rng.choice(list(ways), p=weights / weights.sum()))
    if variant not in ways:
        raise InvalidInput(
            f"variant is '{variant}', expected one of {', '.join(ways)} for '{gesture}'",
            field="variant",
        )
    ways[variant][1](pen)
    return pen.script(gesture, variant)
