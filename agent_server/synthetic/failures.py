"""How trackers fail: wrists at the head, before the trunk or at each other get lost and jump."""

from dataclasses import dataclass

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.domain.skeleton import CoreJoint
from agent_server.synthetic.body import BodyMotion
from agent_server.synthetic.limbs import unturn

ARMS = (
    (CoreJoint.LEFT_ELBOW, CoreJoint.LEFT_WRIST),
    (CoreJoint.RIGHT_ELBOW, CoreJoint.RIGHT_WRIST),
)


@dataclass(frozen=True, slots=True)
class Weakness:
    """How a sensor fails on joints that are hard to see.

    Attributes:
        failures_hz: Failures of a wrist a second while it is fully exposed to them.
        jump_m: Size of the jumps in a failure, smallest and largest.
        inferred: Share of failures that the sensor owns up to with a lower confidence.
        untracked_hz: How often a second an exposed wrist is given up.
    """

    failures_hz: float
    jump_m: tuple[float, float]
    inferred: float
    untracked_hz: float


def exposure(core: Float64, body: BodyMotion) -> Float64:
    """How hard a joint is to see, from 0 (free) to about 1 (hidden): shape (T, 9)."""
    exposed = np.zeros(core.shape[:2])
    apart = np.linalg.norm(core[:, CoreJoint.LEFT_WRIST] - core[:, CoreJoint.RIGHT_WRIST], axis=1)
    together = _fade(apart, 0.10, 0.22)
    for elbow, wrist in ARMS:
        from_head = np.linalg.norm(core[:, wrist] - core[:, CoreJoint.HEAD], axis=1)
        local = unturn(body.chest, core[:, wrist] - core[:, CoreJoint.NECK])
        before = _fade(np.abs(local[:, 0]), 0.13, 0.24) * _fade(-local[:, 2], 0.18, 0.34)
        before *= _fade(local[:, 1], -0.05, 0.08) * _fade(-local[:, 1], 0.45, 0.60)
        behind = _behind_trunk(core, wrist)
        at_head = _fade(from_head, 0.18, 0.32)
        exposed[:, wrist] = 1 - (1 - at_head) * (1 - 0.6 * before) * (1 - behind) * (
            1 - 0.5 * together
        )
        pointing = core[:, elbow] - core[:, wrist - 2]
        foreshortened = _fade(
            -np.abs(pointing[:, 2]) / np.linalg.norm(pointing, axis=1), -0.95, -0.75
        )
        exposed[:, elbow] = 1 - (1 - _behind_trunk(core, elbow)) * (
            1 - 0.35 * np.maximum(exposed[:, wrist], foreshortened)
        )
    exposed[:, CoreJoint.HEAD] = 0.3 * exposed[:, [5, 8]].max(axis=1)
    return exposed


def _fade(value: Float64, full: float, none: float) -> Float64:
    """1 at ``full``, 0 at ``none``, linear between."""
    return np.asarray(np.clip((none - value) / (none - full), 0.0, 1.0))


def _behind_trunk(core: Float64, joint: int) -> Float64:
    """Whether the trunk lies between the sensor and a joint."""
    middle = 0.5 * (core[:, CoreJoint.NECK] + core[:, CoreJoint.NAVEL])
    joint_at = core[:, joint]
    scale = middle[:, 2] / joint_at[:, 2]
    beside = np.abs(joint_at[:, 0] * scale - middle[:, 0])
    return _fade(beside, 0.11, 0.19) * _fade(-(joint_at[:, 2] - middle[:, 2]), -0.14, -0.04)


def fail(
    seen: Float64,
    confidence: Float64,
    exposed: Float64,
    times_s: Float64,
    weakness: Weakness,
    rng: np.random.Generator,
) -> None:
    """Writes failures of both arms into ``seen`` (T, 9, 3) and ``confidence`` (T, 9).

    Failures begin as a Poisson process whose rate follows the exposure (by thinning), last 0.1
    to 1.5 s and do one of three things: the wrist jumps and takes part of the elbow along, the
    wrist is pulled to the other one, or the joint is only inferred.
    """
    for side, (elbow, wrist) in enumerate(ARMS):
        other = ARMS[1 - side][1]
        for begin, stop in _episodes(exposed[:, wrist], times_s, weakness.failures_hz, 0.22, rng):
            span = slice(begin, stop)
            owned = rng.random() < weakness.inferred
            kind = rng.random()
            near = np.linalg.norm(seen[begin, wrist] - seen[begin, other]) < 0.25
            if kind < 0.25 and near:
                share = rng.uniform(0.4, 0.9)
                seen[span, wrist] += share * (seen[span, other] - seen[span, wrist])
            elif kind < 0.75:
                jump = _jump(seen[begin, wrist] - seen[begin, elbow], weakness.jump_m, rng)
                shake = rng.standard_normal((stop - begin, 3)) * 0.15 * np.linalg.norm(jump)
                seen[span, wrist] += jump + shake
                seen[span, elbow] += rng.uniform(0.1, 0.8) * jump
            if owned:
                confidence[span, wrist] = 0.5
                if rng.random() < 0.3:
                    confidence[span, elbow] = 0.5
        given_up = exposed[:, wrist] + 0.15
        for begin, stop in _episodes(given_up, times_s, weakness.untracked_hz, 0.2, rng):
            confidence[begin:stop, wrist] = 0.0
        hidden = exposed[:, elbow] > 0.8
        if hidden.any() and rng.random() < weakness.inferred:
            confidence[hidden, elbow] = np.minimum(confidence[hidden, elbow], 0.5)


def _episodes(
    rate: Float64, times_s: Float64, peak_hz: float, median_s: float, rng: np.random.Generator
) -> list[tuple[int, int]]:
    """Index ranges of a thinned Poisson process; ``rate`` in about [0, 1] scales ``peak_hz``."""
    duration = float(times_s[-1] - times_s[0])
    begins = rng.uniform(times_s[0], times_s[-1], rng.poisson(peak_hz * duration))
    accepted = begins[rng.random(len(begins)) < np.interp(begins, times_s, rate)]
    episodes = []
    for begin in np.sort(accepted):
        length = float(np.clip(median_s * np.exp(rng.normal(0, 0.7)), 0.05, 1.5))
        first, last = np.searchsorted(times_s, (begin, begin + length))
        if last > first:
            episodes.append((int(first), int(last)))
    return episodes


def _jump(forearm: Float64, size: tuple[float, float], rng: np.random.Generator) -> Float64:
    """A wrong wrist mostly lies towards the elbow and below, rarely far away."""
    direction = rng.standard_normal(3) - 0.8 * forearm / np.linalg.norm(forearm)
    direction[1] -= 0.3
    length = rng.uniform(*size) * (2.2 if rng.random() < 0.12 else 1.0)
    return np.asarray(length * direction / np.linalg.norm(direction))
