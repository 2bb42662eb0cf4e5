"""A corpus: endless seeded clips of a group of people, seen by sensors, at the models' rate."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from agent_server.domain.arrays import Float32, Float64, frozen
from agent_server.domain.gesture import GESTURES, IDLE
from agent_server.domain.motion import RATE_HZ, MotionSequence
from agent_server.errors import InvalidInput
from agent_server.synthetic.clips import sample_clip
from agent_server.synthetic.person import Person
from agent_server.synthetic.sensors import SENSORS, CoreObservation, Sensor, observe_core

SENSOR_SHARES = (0.35, 0.35, 0.15, 0.15)
"""How often each of ``SENSORS`` looks on."""


@dataclass(frozen=True, slots=True)
class CorpusItem:
    """One labelled clip at 25 Hz.

    Attributes:
        motion: Positions (T, 9, 3), confidence (T, 9), subject and label.
        variant: Which way of doing the gesture, or which idle action.
        onset_frame: First frame at or after the start of the movement.
        offset_frame: First frame at or after the return to rest; below T.
        sensor: Name of the sensor that looked on.
    """

    motion: MotionSequence
    variant: str
    onset_frame: int
    offset_frame: int
    sensor: str

    @property
    def positions(self) -> Float32:
        """Shape (T, 9, 3), metres in the camera frame."""
        return self.motion.positions

    @property
    def confidence(self) -> Float32:
        """Shape (T, 9), in [0, 1]."""
        return self.motion.confidence

    @property
    def gesture(self) -> str:
        """The label."""
        return self.motion.label

    @property
    def subject(self) -> str:
        """Who moves."""
        return self.motion.subject


def people(seed: int, names: Sequence[str]) -> dict[str, Person]:
    """The same name is the same person for a seed, whoever else is asked for."""
    return {
        name: Person.sample(np.random.default_rng([seed, *name.encode()]), subject=name)
        for name in names
    }


def subject_names(count: int, first: int = 0) -> tuple[str, ...]:
    """``v00``, ``v01``, ... from ``first`` on."""
    return tuple(f"v{index:02d}" for index in range(first, first + count))


def corpus(
    seed: int,
    count: int,
    *,
    subjects: Sequence[str],
    gestures: Sequence[str] = GESTURES,
    sensors: Sequence[Sensor] = SENSORS,
    idle_share: float = 0.35,
) -> Iterator[CorpusItem]:
    """Draws ``count`` clips; item i depends on the seed and i alone, not on its predecessors.

    Args:
        seed: Where everything comes from.
        count: How many clips.
        subjects: Names of the people, see :func:`subject_names`.
        gestures: Labels to draw from; all but ``idle`` are equally likely.
        sensors: Who looks on; the four of ``SENSORS`` as often as ``SENSOR_SHARES`` says,
            others equally often.
        idle_share: Share of ``idle``, if it is among ``gestures``.

    Raises:
        InvalidInput: If there is nobody, nothing or no sensor to draw from.
    """
    for name, values in (("subjects", subjects), ("gestures", gestures), ("sensors", sensors)):
        if not values:
            raise InvalidInput(f"{name} is empty, name at least one", field=name)
    group = people(seed, subjects)
    active = [gesture for gesture in gestures if gesture != IDLE]
    shares = np.array(SENSOR_SHARES if tuple(sensors) == SENSORS else [1.0] * len(sensors))
    for index in range(count):
        rng = np.random.default_rng([seed, 7, index])
        person = group[str(rng.choice(list(subjects)))]
        idle = not active or (IDLE in gestures and rng.random() < idle_share)
        gesture = IDLE if idle else str(rng.choice(active))
        sensor = sensors[int(rng.choice(len(sensors), p=shares / shares.sum()))]
        clip = sample_clip(rng, gesture, person)
        positions, confidence = resample(observe_core(clip, sensor, rng))
        last = len(positions) - 1
        yield CorpusItem(
            motion=MotionSequence(
                positions=frozen(positions, (None, 9, 3)),
                confidence=frozen(confidence, (None, 9)),
                rate_hz=RATE_HZ,
                subject=clip.subject,
                label=gesture,
                source="synthetic",
            ),
            variant=clip.variant,
            onset_frame=min(last, int(np.ceil(clip.onset_s * RATE_HZ))),
            offset_frame=min(last, int(np.ceil(clip.offset_s * RATE_HZ))),
            sensor=sensor.name,
        )


def resample(seen: CoreObservation) -> tuple[Float64, Float64]:
    """Interpolates an observation linearly to 25 Hz; frame k is k / 25 s into the motion.

    A confidence between two frames is the smaller one, so that 0 stays 0.

    Returns:
        Positions (T, 9, 3) and confidence (T, 9).
    """
    stamps = seen.stamps_s
    times = np.arange(0.0, stamps[-1], 1.0 / RATE_HZ)
    right = np.clip(np.searchsorted(stamps, times, side="right"), 1, len(stamps) - 1)
    left = right - 1
    share = np.clip((times - stamps[left]) / (stamps[right] - stamps[left]), 0.0, 1.0)
    mix = share[:, None, None]
    positions = (1 - mix) * seen.positions[left] + mix * seen.positions[right]
    confidence = np.minimum(seen.confidence[left], seen.confidence[right])
    return positions, confidence
