"""Clips: somebody rests, does one thing, and rests again."""

from dataclasses import dataclass

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.domain.gesture import IDLE
from agent_server.synthetic.body import BodyMotion
from agent_server.synthetic.gestures import write_gesture
from agent_server.synthetic.idle import ON_FOOT, write_idle
from agent_server.synthetic.performance import Arm, Performance, Reach, Track
from agent_server.synthetic.person import Person, Placement
from agent_server.synthetic.rest import sample_rest
from agent_server.synthetic.script import LEFT, RIGHT, Pen, Script
from agent_server.synthetic.trajectory import Drift, sample_drift


@dataclass(frozen=True, slots=True)
class Clip:
    """Clean motion around one action, as a continuous function of time.

    Attributes:
        gesture: Its label, or ``idle``.
        variant: Which way of doing it.
        onset_s: When the movement starts.
        offset_s: When the body is back at rest.
        duration_s: Length of the clip, which begins at 0.
        subject: Who moves.
        performance: The motion itself.
    """

    gesture: str
    variant: str
    onset_s: float
    offset_s: float
    duration_s: float
    subject: str
    performance: Performance

    @property
    def person(self) -> Person:
        """Who moves."""
        return self.performance.person

    def at(self, times_s: Float64) -> BodyMotion:
        """The clean body at ``times_s``, shape (T,), ascending."""
        return self.performance.at(times_s)


def sample_clip(
    rng: np.random.Generator,
    gesture: str,
    person: Person,
    variant: str | None = None,
    *,
    placement: Placement | None = None,
) -> Clip:
    """Draws a clip: rest, the action, rest.

    Args:
        rng: Where all variation comes from.
        gesture: One of ``domain.gesture.GESTURES``.
        person: Who moves.
        variant: Which way of doing it; None draws one.
        placement: Where; None draws one, standing if the variant needs feet.

    Raises:
        InvalidInput: If there is no such gesture or variant.
    """
    if placement is None:
        on_foot = gesture == IDLE and variant in ON_FOOT
        placement = Placement.sample(rng, seated=False if on_foot else None)
    rest = sample_rest(rng, person, placement)
    start = float(rng.uniform(1.05, 3.0))
    pen = Pen(rng, person, placement, rest, start)
    script = write_idle(pen, variant) if gesture == IDLE else write_gesture(pen, gesture, variant)
    duration = script.offset_s + float(rng.uniform(0.6, 2.0))
    return Clip(
        gesture=gesture,
        variant=script.variant,
        onset_s=script.onset_s,
        offset_s=script.offset_s,
        duration_s=duration,
        subject=person.subject,
        performance=perform(rng, person, placement, rest, (script,)),
    )


def perform(
    rng: np.random.Generator,
    person: Person,
    placement: Placement,
    rest: tuple[Reach, Reach],
    scripts: tuple[Script, ...],
) -> Performance:
    """Joins scripts, in order of time, into one continuous motion with involuntary movement."""

    def arm(side: int) -> Arm:
        return Arm(
            (rest[side], *(r for s in scripts for r in s.reaches[side])),
            tuple(w for s in scripts for w in s.swings[side]),
        )

    return Performance(
        person=person,
        placement=placement,
        arms=(arm(LEFT), arm(RIGHT)),
        trunk=Track(
            tuple(m for s in scripts for m in s.trunk),
            tuple(w for s in scripts for w in s.trunk_swings),
        ),
        head=Track(
            tuple(m for s in scripts for m in s.head),
            tuple(w for s in scripts for w in s.head_swings),
        ),
        pelvis=Track(
            tuple(m for s in scripts for m in s.pelvis),
            tuple(w for s in scripts for w in s.pelvis_swings),
        ),
        feet=(
            Track(tuple(m for s in scripts for m in s.feet[LEFT])),
            Track(tuple(m for s in scripts for m in s.feet[RIGHT])),
        ),
        involuntary=_involuntary(rng, person, placement),
        breath_hz=float(rng.uniform(0.2, 0.33)),
    )


def _involuntary(
    rng: np.random.Generator, person: Person, placement: Placement
) -> tuple[Drift, Drift, Drift, Drift, Drift]:
    """Sway (some 5 to 10 mm standing, Winter 1995), trunk, head and hands at rest."""
    life = float(np.clip(person.liveliness * np.exp(rng.normal(0, 0.3)), 0.3, 2.2))
    sway = life * (0.4 if placement.seated else 1.0)
    return (
        sample_drift(rng, (0.009 * sway, 0.001 * sway, 0.006 * sway)),
        sample_drift(rng, (0.010 * life, 0.007 * life, 0.012 * life)),
        sample_drift(rng, (0.035 * life, 0.015 * life, 0.045 * life)),
        sample_drift(rng, (0.006 * life, 0.005 * life, 0.007 * life)),
        sample_drift(rng, (0.006 * life, 0.005 * life, 0.007 * life)),
    )
