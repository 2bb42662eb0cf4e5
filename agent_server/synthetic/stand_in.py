"""A made-up person who does what is asked for, so that anybody can play without a sensor."""

from dataclasses import dataclass

import numpy as np

from agent_server.domain.gesture import GESTURES, IDLE
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import to_ns
from agent_server.errors import InvalidInput
from agent_server.synthetic.gestures import VARIANTS
from agent_server.synthetic.person import Person
from agent_server.synthetic.scenario import BODY_ID, place_before
from agent_server.synthetic.sensors import KINECT_V2, observe_frames
from agent_server.synthetic.timeline import Stretch, Timeline

REST_S = 0.4
"""Before and after a gesture the hands are at rest, so that clips follow each other."""
IDLE_S = 6.0


@dataclass(frozen=True, slots=True)
class Clip:
    """One thing that the stand-in does, from rest to rest.

    Attributes:
        gesture: What it is.
        variant: Which way of doing it, empty for ``idle``.
        frames: Kinect v2 frames at 30 Hz, the first at 0.
        onset_ns: When the gesture begins.
        offset_ns: When it ends.
    """

    gesture: str
    variant: str
    frames: list[SkeletonFrame]
    onset_ns: int
    offset_ns: int


def stand_in(gesture: str, seed: int, take: int = 0) -> Clip:
    """Let the stand-in do something; the same arguments give the same frames.

    Args:
        gesture: One of the built-in gestures, or ``idle``.
        seed: Who it is and where they stand.
        take: Which performance; each is a little different.

    Raises:
        InvalidInput: If there is no such gesture.
    """
    if gesture not in GESTURES:
        raise InvalidInput(
            f"gesture is {gesture!r}: the stand-in can do {', '.join(GESTURES)}", field="gesture"
        )
    who = np.random.default_rng([seed, 37])
    person = Person.sample(who, subject=f"stand-in {seed}")
    place = place_before(who, seated=False)
    rng = np.random.default_rng([seed, take, GESTURES.index(gesture), 41])
    timeline = Timeline(rng, person, place)
    variant, onset_s, offset_s = "", 0.0, IDLE_S
    if gesture == IDLE:
        timeline.idle_until(IDLE_S, calm=True)
    else:
        ways = VARIANTS[gesture]
        weights = np.array([weight for weight, _ in ways.values()])
        variant = str(rng.choice(list(ways), p=weights / weights.sum()))
        timeline.idle_until(REST_S, calm=True)
        script = timeline.act(gesture, variant)
        onset_s, offset_s = script.onset_s, script.offset_s
        timeline.idle_until(timeline.now_s + REST_S, calm=True)
    motion = Stretch(timeline.performance(), timeline.now_s)
    frames = observe_frames(motion, KINECT_V2, rng, BODY_ID, 0)
    return Clip(gesture, variant, frames, to_ns(onset_s), to_ns(offset_s))
