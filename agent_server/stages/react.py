"""From what a person does to the agent's reaction, which is made while it plays.

The generator is given the three seconds that a decision is made on, the second that was seen and
the two that are expected, and writes the reaction to all of it. What of it falls into the
second that was seen is over; the rest is played from the moment of the decision on, in time with
the person.
"""

import hashlib
from collections.abc import Iterator
from math import floor

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.model import Reactor
from agent_server.domain.motion import CLASSIFIED_FRAMES, RATE_HZ, SEEN_FRAMES, Forecast, Window
from agent_server.domain.reaction import Stretch, TrainingRange
from agent_server.errors import InferenceError
from agent_server.skeleton.pair import (
    ARMS,
    TORSO,
    UPPER_BODY,
    as_action,
    as_agent,
    bone_vectors,
    with_lengths,
)

STRETCH_FRAMES = 5
"""Frames that are given at once: a fifth of a second."""
DRAWS = 3
"""So often noise is drawn for one reaction; each draw that comes to nothing takes some 50 ms."""
LEAST_QUALITY = 0.5
"""Of a reaction of less quality it is rather held that it is none."""
UPPER_BONES = UPPER_BODY - 1
NO_FRAMES = np.zeros((0, 15, 3), np.float32)


def react(reactor: Reactor, window: Window, forecast: Forecast, seed: str) -> Iterator[Stretch]:
    """Make a reaction, stretch by stretch; the last one says so.

    Where a draw of noise comes to nothing before its first stretch, the next one is tried.

    Args:
        reactor: Makes it.
        window: What was seen.
        forecast: What is expected.
        seed: The same text gives the same noise.
    """
    person = np.concatenate([window.positions, forecast.positions])
    action = as_action(person, np.array(reactor.range.action, np.float32))
    action = _resampled(action, reactor.rate_hz)[: reactor.frames]
    for draw in range(DRAWS):
        noise = noise_of(f"{seed} {draw}" if draw else seed, reactor.latent)
        stretches = _stretches(reactor, action, noise)
        beginning = next(stretches)
        if beginning.refused is None:
            break
    yield beginning
    yield from stretches


def _stretches(reactor: Reactor, action: Float32, noise: Float32) -> Iterator[Stretch]:
    """One draw, from the end of the window on."""
    given = reactor.range
    first = np.array(given.reaction, np.float32)
    poses = reactor.react(action, first, noise)
    lengths = np.linalg.norm(bone_vectors(first), axis=-1)
    doubt = Doubt(given, reactor.rate_hz)
    waiting: list[Float32] = []
    sent, at = 0, SEEN_FRAMES - 1  # frames given, and the next of the 75 to be made
    at_first = at * reactor.rate_hz // RATE_HZ
    refused, last = None, first

    def stretch(count: int, *, is_last: bool = False) -> Stretch:
        nonlocal sent
        chosen, waiting[:] = waiting[:count], waiting[count:]
        frames = as_agent(with_lengths(np.stack(chosen), lengths), first) if chosen else NO_FRAMES
        frames.flags.writeable = False
        made = Stretch(sent, frames, is_last, refused if is_last else None)
        sent += len(chosen)
        return made

    try:
        for index, (pose, quality) in enumerate(poses):
            # Nothing is played of what comes before, on which quality has time to form.
            is_judged = index >= at_first
            refused = doubt.push(pose) or (_unfit(quality) if is_judged else None)
            if refused is not None:
                break
            while (place := at * reactor.rate_hz / RATE_HZ) <= index:
                waiting.append((last + (place - index + 1) * (pose - last)).astype(np.float32))
                at += 1
            last = pose
            while len(waiting) > STRETCH_FRAMES:
                yield stretch(STRETCH_FRAMES)
    except InferenceError as error:
        refused = str(error)
    if refused is None and not (sent or waiting):
        refused = "the reaction is over before it begins"
    yield stretch(len(waiting), is_last=True)


def _unfit(quality: float) -> str | None:
    if quality >= LEAST_QUALITY:
        return None
    return (
        f"it does not go with what the person does: quality {quality:.2f}, "
        f"{LEAST_QUALITY:g} is asked"
    )


def broken_off(reason: str) -> Stretch:
    """A stretch without frames: nothing more comes, for a reason in words."""
    return Stretch(0, NO_FRAMES, is_last=True, refused=reason)


def noise_of(seed: str, size: int) -> Float32:
    """Normal noise that a text alone decides on, shape (size,)."""
    number = int.from_bytes(hashlib.sha256(seed.encode()).digest(), "big")
    return np.random.default_rng(number).standard_normal(size, dtype=np.float32)


def _resampled(motion: Float32, rate_hz: int) -> Float32:
    """Motion (75, J, 3) of 25 Hz at another rate, between its first and its last frame."""
    count = floor((CLASSIFIED_FRAMES - 1) * rate_hz / RATE_HZ) + 1
    places = np.arange(count) * RATE_HZ / rate_hz
    before = np.minimum(places.astype(np.intp), CLASSIFIED_FRAMES - 2)
    share = (places - before)[:, None, None].astype(np.float32)
    between: Float32 = motion[before] + share * (motion[before + 1] - motion[before])
    return between


class Doubt:
    """Whether a motion is one that the generator could have learnt: limits, no judgement.

    Looked at are head, neck, torso, shoulders, elbows and hands, as the generator gives them:
    lengths of bones before they are set right, speed, acceleration, distance from the torso.

    Args:
        known: The limits.
        rate_hz: Frames a second.
    """

    def __init__(self, known: TrainingRange, rate_hz: int) -> None:
        self._known = known
        self._rate_hz = rate_hz
        bones = bone_vectors(np.array(known.reaction, np.float32))[:UPPER_BONES]
        self._lengths = np.linalg.norm(bones, axis=-1)
        self._before: list[Float32] = []

    def push(self, pose: Float32) -> str | None:
        """Why the motion is not to be believed from this pose (15, 3) on; None if it is."""
        known, rate = self._known, self._rate_hz
        self._before = [*self._before[-2:], pose[:UPPER_BODY]]
        bones = np.linalg.norm(bone_vectors(pose)[:UPPER_BONES], axis=-1)
        reach = np.linalg.norm(pose[ARMS,] - pose[TORSO], axis=-1)
        shares = {
            "a bone is too long or short": (np.abs(bones / self._lengths - 1) / known.bones).max(),
            "an arm reaches too far": (reach / known.reach_m).max(),
            "a joint is too fast": self._largest(1) * rate / known.speed_m_s,
            "a joint changes its speed too fast": (
                self._largest(2) * rate**2 / known.acceleration_m_s2
            ),
        }
        for sentence, share in shares.items():
            if not share <= 1:
                return f"{sentence}: {share:.2f} times the limit of the training set"
        return None

    def _largest(self, order: int) -> float:
        """Length of the longest difference of this order that ends at the newest pose."""
        if len(self._before) <= order:
            return 0.0
        last = np.diff(np.stack(self._before), order, axis=0)[-1]
        return float(np.linalg.norm(last, axis=-1).max())
