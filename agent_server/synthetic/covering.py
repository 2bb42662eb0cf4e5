"""Gestures that cover something at the head: ``bright``, ``loud`` and ``smell``.

Points are written outwards, up and back, in metres for the reference stature. Where wrists
come to rest, how fast they get there and where elbows point was tuned on Kinect recordings of
people who cover their eyes and hold their head; see ``docs/synthetic.md``.
"""

from collections.abc import Mapping
from types import MappingProxyType

from agent_server.synthetic.script import BOTH, Hands, Pen, Writer, degrees, flinch
from agent_server.synthetic.trajectory import ORIGIN, Vector

Swivel = tuple[float, float]
_FORWARD: Vector = (0.04, -0.12, -0.21)
_SIDEWAYS: Vector = (0.28, -0.11, -0.14)


def _fidget(pen: Pen, hands: Hands, start_s: float, stop_s: float) -> None:
    """Hands that hold something are never quite still."""
    for side in hands:
        size = pen.person.liveliness * pen.uniform(0.001, 0.006)
        along = pen.around(ORIGIN, size)
        pen.swing(side, start_s, stop_s, along, pen.uniform(0.5, 1.8), ramp_s=0.4)


def _at_face(
    pen: Pen,
    hands: Hands,
    centre: Vector,
    spread: Vector,
    swivel: Swivel,
    *,
    fingers: Vector,
    pitch: float,
    bow: Vector = _FORWARD,
    median_s: float = 0.62,
) -> None:
    """Raises hands to the face, holds them there, lowers them."""
    arrival = pen.bring(
        hands, "head", centre, spread, swivel, fingers=fingers, bow=bow, median_s=median_s
    )
    release = arrival + pen.hold()
    _fidget(pen, hands, arrival - 0.2, release)
    end = pen.lower(hands, release, median_s=median_s + 0.08, bow=bow)
    flinch(pen, pen.start_s + 0.15, end, pitch)


# --------------------------------------------------------------------------- bright


def _eyes_both(pen: Pen) -> None:
    place, spread = (0.128, -0.08, -0.152), (0.022, 0.030, 0.018)
    swivel = (80.0, 14.0) if pen.chance(0.06) else (32.0, 9.0)
    _at_face(pen, BOTH, place, spread, swivel, fingers=(-0.7, 0.6, 0.3), pitch=6)


def _eyes_one(pen: Pen) -> None:
    place, spread = (0.08, -0.065, -0.15), (0.03, 0.026, 0.022)
    swivel = (40.0, 18.0)
    _at_face(pen, (pen.main,), place, spread, swivel, fingers=(-0.9, 0.4, 0.2), pitch=6)


def _visor(pen: Pen) -> None:
    place, spread = (0.14, 0.015, -0.135), (0.035, 0.03, 0.035)
    swivel = (62.0, 20.0)
    _at_face(pen, (pen.main,), place, spread, swivel, fingers=(-1.0, 0.3, 0.0), pitch=3)


def _visor_both(pen: Pen) -> None:
    place, spread = (0.135, 0.005, -0.145), (0.03, 0.025, 0.03)
    _at_face(pen, BOTH, place, spread, (48.0, 12.0), fingers=(-1.0, 0.4, 0.0), pitch=3)


def _forearm(pen: Pen) -> None:
    """The forearm lies across before the eyes."""
    place, spread = (-0.09, 0.0, -0.19), (0.05, 0.04, 0.03)
    swivel = (70.0, 15.0)
    _at_face(pen, (pen.main,), place, spread, swivel, fingers=(-0.5, 0.3, 0.0), pitch=9)


# --------------------------------------------------------------------------- loud


def _ears_palms(pen: Pen) -> None:
    place, spread = (0.15, 0.018, -0.115), (0.018, 0.028, 0.03)
    swivel, fingers = (57.0, 15.0), (-0.3, 0.8, 0.5)
    _at_face(pen, BOTH, place, spread, swivel, fingers=fingers, pitch=5, bow=_SIDEWAYS)


def _ears_fingers(pen: Pen) -> None:
    place, spread = (0.165, -0.055, -0.085), (0.018, 0.03, 0.035)
    swivel, fingers = (54.0, 19.0), (-0.8, 0.5, 0.2)
    _at_face(pen, BOTH, place, spread, swivel, fingers=fingers, pitch=6, bow=_SIDEWAYS)


def _ears_clutch(pen: Pen) -> None:
    place, spread = (0.145, 0.04, -0.045), (0.022, 0.03, 0.035)
    swivel, fingers = (62.0, 15.0), (-0.3, 0.9, 0.4)
    _at_face(pen, BOTH, place, spread, swivel, fingers=fingers, pitch=12, bow=_SIDEWAYS)


def _ears_front(pen: Pen) -> None:
    place, spread = (0.13, 0.01, -0.115), (0.02, 0.03, 0.02)
    swivel, fingers = (55.0, 15.0), (0.0, 0.6, 0.9)
    _at_face(pen, BOTH, place, spread, swivel, fingers=fingers, pitch=6, bow=_SIDEWAYS)


# --------------------------------------------------------------------------- smell


def _pinch(pen: Pen) -> None:
    place, spread = (0.05, -0.165, -0.17), (0.025, 0.024, 0.025)
    swivel = (70.0, 15.0) if pen.chance(0.25) else (32.0, 12.0)
    _at_face(pen, (pen.main,), place, spread, swivel, fingers=(-0.4, 0.7, 0.5), pitch=-3)


def _pinch_and_turn(pen: Pen) -> None:
    _pinch(pen)
    away = degrees(-4, 0, pen.rng.choice((-1, 1)) * pen.uniform(15, 40))
    start = pen.start_s + pen.uniform(0.1, 0.6)
    pen.turn_and_back("head", start, start + pen.uniform(1.2, 2.0), away)


def _mouth_both(pen: Pen) -> None:
    place, spread = (0.055, -0.185, -0.14), (0.018, 0.022, 0.022)
    _at_face(pen, BOTH, place, spread, (36.0, 12.0), fingers=(-0.6, 0.8, 0.3), pitch=2)


def _mouth_one(pen: Pen) -> None:
    place, spread = (0.075, -0.155, -0.14), (0.03, 0.025, 0.028)
    swivel = (45.0, 18.0)
    _at_face(pen, (pen.main,), place, spread, swivel, fingers=(-1.0, 0.3, 0.3), pitch=-3)


COVERING: Mapping[str, Mapping[str, tuple[float, Writer]]] = MappingProxyType(
    {
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
            "eyes_both": (4.0, _eyes_both),
            "eyes_one": (1.2, _eyes_one),
            "visor": (1.5, _visor),
            "visor_both": (0.7, _visor_both),
            "forearm": (1.0, _forearm),
        },
    }
)
"""Gesture -> variant -> (how often, what writes it)."""
