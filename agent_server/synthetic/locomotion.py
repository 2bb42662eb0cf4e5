"""Idle actions of the whole body: walking, bending, kicking, jumping, sitting down."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from agent_server.synthetic.script import BOTH, Pen, Writer, degrees
from agent_server.synthetic.trajectory import ORIGIN, Vector


def _march(pen: Pen, rate_hz: float, lift: float, stop_s: float, away: float) -> None:
    """Feet go up and down in turn; the body travels ``away`` metres back and returns."""
    half = 0.5 / rate_hz
    count = max(2, int((stop_s - pen.start_s) / half))
    for index in range(count):
        side, at = index % 2, pen.start_s + index * half
        travelled = away * np.sin(np.pi * (index + 1) / count)
        pen.step(side, at, 0.5 * half, (0.0, lift, travelled))
        pen.step(side, at + 0.5 * half, 0.5 * half, (0.0, 0.0, travelled))
    pen.step(count % 2, stop_s, 0.3, ORIGIN)
    pen.step(1 - count % 2, stop_s, 0.3, ORIGIN)
    pen.sway("pelvis", pen.start_s, stop_s, (0.0, 0.015, 0.0), 2 * rate_hz)
    pen.sway("pelvis", pen.start_s, stop_s, (0.02, 0.0, 0.0), rate_hz)
    pen.sway("trunk", pen.start_s, stop_s, degrees(0, 0, 4), rate_hz)
    if away:
        third = (stop_s - pen.start_s) / 2
        pen.turn("pelvis", pen.start_s, third, (0.0, 0.0, away))
        pen.turn("pelvis", pen.start_s + third, third, ORIGIN)


def _walk(pen: Pen) -> None:
    rate = pen.uniform(0.75, 1.05)
    stop = pen.start_s + pen.uniform(2.0, 4.5)
    away = pen.uniform(-0.5, 0.6) if pen.chance(0.5) else 0.0
    _march(pen, rate, pen.uniform(0.05, 0.25), stop, away)
    size = pen.uniform(0.04, 0.2)
    for side in BOTH:
        phase = np.pi * side
        pen.swing(side, pen.start_s, stop, (0, -0.02, size), rate, phase_rad=phase, ramp_s=0.5)


def _jog(pen: Pen) -> None:
    rate = pen.uniform(1.2, 1.6)
    place, spread = (0.20, -0.36, -0.18), (0.03, 0.04, 0.05)
    arrival = pen.bring(BOTH, "chest", place, spread, median_s=0.5)
    stop = arrival + pen.uniform(1.0, 3.0)
    _march(pen, rate, pen.uniform(0.15, 0.3), stop, 0.0)
    size = pen.uniform(0.08, 0.16)
    for side in BOTH:
        phase = np.pi * side
        pen.swing(side, arrival - 0.3, stop, (-0.03, 0.05, -size), rate, phase_rad=phase)
    pen.lower(BOTH, stop)


def _duck(pen: Pen) -> None:
    """Ducks or squats, arms along or forward."""
    depth = pen.uniform(0.12, 0.5) * (0.3 if pen.placement.seated else 1.0)
    down = pen.seconds(0.7)
    stay = pen.uniform(0.1, 1.2)
    pen.turn("pelvis", pen.start_s, down, (0.0, -depth, 0.35 * depth))
    end = pen.turn("pelvis", pen.start_s + down + stay, down, ORIGIN)
    bend = degrees(60 * depth + pen.rng.normal(0, 6), 0, 0)
    pen.turn("trunk", pen.start_s, down, bend)
    pen.turn("trunk", pen.start_s + down + stay, down, ORIGIN)
    if pen.chance(0.55):
        places = ((0.18, -0.1, -0.5), (0.12, -0.3, -0.3), (0.30, -0.35, -0.2))
        place = places[int(pen.rng.integers(3))]
        pen.bring(BOTH, "chest", place, 0.06, median_s=0.7)
        pen.lower(BOTH, end - down)


def _bow(pen: Pen) -> None:
    down = pen.seconds(0.9)
    stay = pen.uniform(0.1, 1.0)
    depth = pen.uniform(20, 80)
    for part, share in (("trunk", 1.0), ("head", 0.25)):
        pen.turn(part, pen.start_s, down, degrees(share * depth, 0, 0))
        pen.turn(part, pen.start_s + down + stay, down, ORIGIN)
    pen.turn_and_back("pelvis", pen.start_s, pen.start_s + 2 * down + stay, (0, 0, 0.0015 * depth))
    if pen.chance(0.3):
        arrival = pen.bring((pen.main,), "chest", (0.0, -0.25, -0.16), 0.03)
        pen.lower((pen.main,), max(arrival, pen.start_s + down + stay))


def _kick(pen: Pen) -> None:
    side = pen.main
    lift, swing = pen.seconds(0.45), pen.uniform(0.3, 0.75)
    at = pen.step(side, pen.start_s, lift, (0.05, 0.15, 0.2))
    at = pen.step(side, at, 0.6 * lift, (0.0, pen.uniform(0.2, 0.6), -swing))
    end = pen.step(side, at, 1.5 * lift, ORIGIN)
    lean = degrees(-pen.uniform(2, 14), pen.rng.normal(0, 5), pen.rng.normal(0, 8))
    pen.turn_and_back("trunk", pen.start_s, end, lean)
    pen.turn_and_back("pelvis", pen.start_s, end, (0.06 * (-1 if side else 1), 0.0, 0.05))
    spread = pen.around((0.38, -0.38, -0.02), 0.09)
    for hand in BOTH:
        spot = pen.around(spread, 0.06)
        pen.reach(hand, pen.start_s, 1.6 * lift, "chest", spot)
    pen.lower(BOTH, end - lift)


def _lunge(pen: Pen) -> None:
    side = pen.main
    go, stay = pen.seconds(0.7), pen.uniform(0.2, 1.0)
    deep = pen.uniform(0.1, 0.3)
    pen.step(side, pen.start_s, go, (0.0, 0.0, -0.6))
    pen.turn("pelvis", pen.start_s, go, (0.0, -deep, -0.3))
    back = pen.start_s + go + stay
    pen.step(side, back, go, ORIGIN)
    pen.turn("pelvis", back, go, ORIGIN)


def _jump(pen: Pen) -> None:
    down, up = (0.0, -0.22, 0.05), (0.0, pen.uniform(0.1, 0.3), 0.0)
    at = pen.turn("pelvis", pen.start_s, 0.45, down)
    top = at + 0.32
    pen.turn("pelvis", at, 0.32, up)
    pen.turn("pelvis", top, 0.3, (0.0, -0.12, 0.03))
    end = pen.turn("pelvis", top + 0.3, 0.4, ORIGIN)
    for side in BOTH:
        pen.step(side, at + 0.1, 0.22, up)
        pen.step(side, top, 0.25, ORIGIN)
    pen.turn_and_back("trunk", pen.start_s, end, degrees(pen.uniform(5, 25), 0, 0))
    if pen.chance(0.6):
        spots: list[Vector] = [(0.26, -0.50, 0.14), (0.27, -0.50, -0.16), (0.28, 0.1, -0.40)]
        pen.lower(BOTH, pen.through(BOTH, spots, 0.35))


def _sit_or_stand(pen: Pen) -> None:
    """Sits down and gets up again, or the other way round."""
    drop = pen.person.thigh_m + pen.person.shank_m - 0.5 * pen.person.scale + 0.04
    up = drop if pen.placement.seated else -drop
    ahead = -0.28 if pen.placement.seated else 0.30
    change = pen.seconds(1.3)
    stay = pen.uniform(0.3, 2.0)
    bend = degrees(pen.uniform(22, 45), 0, 0)
    at = pen.start_s
    for value in ((0.0, up, ahead), ORIGIN):
        pen.turn("trunk", at, 0.5 * change, bend)
        pen.turn("trunk", at + 0.5 * change, 0.6 * change, ORIGIN)
        at = pen.turn("pelvis", at, change, value) + stay
    if pen.chance(0.5):
        knees = pen.around((0.14, 0.12, -0.28), 0.03)
        start, end = pen.start_s, pen.start_s + change
        for side in BOTH:
            pen.reach(side, start, 0.7 * change, "pelvis", knees)
        pen.lower(BOTH, end)


LOCOMOTION: Mapping[str, tuple[float, Writer]] = MappingProxyType(
    {
        "walk": (2.0, _walk),
        "jog": (0.7, _jog),
        "duck": (1.5, _duck),
        "bow": (1.6, _bow),
        "kick": (1.2, _kick),
        "lunge": (0.5, _lunge),
        "jump": (0.6, _jump),
        "sit_or_stand": (1.5, _sit_or_stand),
    }
)
"""Action -> (how often, what writes it)."""
