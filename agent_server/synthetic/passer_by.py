"""Somebody who walks through the picture behind the person in front of the sensor."""

import numpy as np

from agent_server.synthetic.clips import perform
from agent_server.synthetic.person import Person, Placement
from agent_server.synthetic.rest import hanging
from agent_server.synthetic.script import BOTH, Pen
from agent_server.synthetic.timeline import Stretch

STEP_HZ = 1.9
"""Steps a second of a comfortable walk."""


def walk_through(
    rng: np.random.Generator,
    person: Person,
    *,
    distance_m: float,
    half_width_m: float,
    sensor_height_m: float,
) -> Stretch:
    """A walk from one edge of the view to the other, at about 1.1 m/s.

    Args:
        rng: Where the variation comes from.
        person: Who walks.
        distance_m: Depth of the path.
        half_width_m: Where it begins and ends beside the middle.
        sensor_height_m: Height of the sensor.
    """
    to_left = bool(rng.random() < 0.5)
    place = Placement(
        seated=False,
        slouch_rad=0.05,
        list_rad=0.0,
        heading_rad=float(np.radians(80.0 if to_left else -80.0)),
        distance_m=distance_m,
        lateral_m=half_width_m if to_left else -half_width_m,
        sensor_height_m=sensor_height_m,
        sensor_tilt_rad=0.0,
        seat_m=0.5,
    )
    rest = hanging(rng)
    pen = Pen(rng, person, place, rest, 0.0)
    way = 2 * half_width_m
    duration = way / 1.1
    steps = max(4, round(duration * STEP_HZ))
    period = duration / steps
    for index in range(steps):
        # A foot lands half a step ahead of the body and stays there for two steps.
        ahead = (0.0, 0.0, -min(way, way * (index + 1.5) / steps))
        lifted = (0.0, 0.08, ahead[2] + 0.5 * way / steps)
        side = index % 2
        pen.step(side, index * period, 0.5 * period, lifted)
        pen.step(side, (index + 0.5) * period, 0.5 * period, ahead)
        pen.turn("pelvis", index * period - 0.5 * period, 2 * period, _progress(way, index, steps))
    pen.sway("pelvis", 0.0, duration, (0.0, 0.015, 0.0), STEP_HZ)
    pen.sway("trunk", 0.0, duration, (0.0, 0.0, 0.07), STEP_HZ / 2)
    for side in BOTH:
        phase = np.pi * side
        pen.swing(side, 0.0, duration, (0.0, -0.02, 0.16), STEP_HZ / 2, phase_rad=phase)
    script = pen.script("idle", "walk_through")
    return Stretch(perform(rng, person, place, rest, (script,)), duration)


def _progress(way: float, index: int, steps: int) -> tuple[float, float, float]:
    return 0.0, 0.0, -way * (index + 1) / steps
