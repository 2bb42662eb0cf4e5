"""Long synthetic streams of idle motion, to count false reactions on."""

from dataclasses import dataclass

import numpy as np

from agent_server.domain.arrays import Float32, Float64
from agent_server.synthetic.body import BodyMotion
from agent_server.synthetic.clips import perform
from agent_server.synthetic.corpus import people, resample
from agent_server.synthetic.idle import write_idle
from agent_server.synthetic.performance import Performance
from agent_server.synthetic.person import Placement
from agent_server.synthetic.rest import sample_rest
from agent_server.synthetic.script import Pen, Script
from agent_server.synthetic.sensors import SENSORS, observe_core

PAUSE_S = (0.4, 2.5)
CHUNK_S = 60.0


@dataclass(frozen=True, slots=True)
class _Chapter:
    """A stretch of a performance, as sensors want it: it begins at 0."""

    performance: Performance
    duration_s: float

    def at(self, times_s: Float64) -> BodyMotion:
        return self.performance.at(times_s)


def idle_streams(seed: int, minutes: int, subjects: tuple[str, ...]) -> list[Float32]:
    """One-minute streams of idle actions and hard negatives, one after the other.

    Args:
        seed: Where everything comes from.
        minutes: How many streams.
        subjects: Names of the people, who take turns.

    Returns:
        Arrays (T, 9, 3), metres in the camera frame, 25 Hz, as a sensor sees them.
    """
    group = people(seed, subjects)
    streams = []
    for index in range(minutes):
        rng = np.random.default_rng([seed, 13, index])
        person = group[subjects[index % len(subjects)]]
        place = Placement.sample(rng)
        rest = sample_rest(rng, person, place)
        scripts: list[Script] = []
        now = 1.0
        while now < CHUNK_S:
            scripts.append(write_idle(Pen(rng, person, place, rest, now)))
            now = scripts[-1].offset_s + float(rng.uniform(*PAUSE_S))
        performance = perform(rng, person, place, rest, tuple(scripts))
        sensor = SENSORS[int(rng.integers(2))]
        positions, _ = resample(observe_core(_Chapter(performance, now), sensor, rng))
        streams.append(positions.astype(np.float32))
    return streams
