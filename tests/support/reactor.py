"""A generator of reactions without weights: the right forearm rises from where it hangs."""

import numpy as np

from agent_server.domain.reaction import TrainingRange
from agent_server.errors import InferenceError

RIGHT_ELBOW, RIGHT_HAND = 7, 8
_STANDING = (
    *((0.0, 0.42, 0.0), (0.0, 0.21, 0.0), (0.0, 0.0, 0.0)),
    *((0.0, 0.21, -0.16), (0.0, -0.06, -0.2), (0.1, -0.32, -0.19)),
    *((0.0, 0.21, 0.16), (0.0, -0.06, 0.2), (0.1, -0.32, 0.19)),
    *((0.0, -0.22, -0.07), (0.0, -0.65, -0.08), (0.0, -1.06, -0.08)),
    *((0.0, -0.22, 0.07), (0.0, -0.65, 0.08), (0.0, -1.06, 0.08)),
)
"""Looks along x."""
RANGE = TrainingRange(
    action=tuple((x - 0.6, y, z) for x, y, z in _STANDING),
    reaction=tuple((0.6 - x, y, -z) for x, y, z in _STANDING),
    bones=(1.5,) * 8,
    speed_m_s=3.0,
    acceleration_m_s2=50.0,
    reach_m=(0.8, 0.8, 0.8, 0.8),
)


class HandReactor:
    """Moves the right hand forwards and up, about the elbow, at a speed in m/s.

    ``ends_at`` and ``breaks_at`` say after how many poses it is over or fails, ``waits`` is called
    before each pose, ``known`` are the limits that it claims, ``grows`` is the share by which the
    forearm becomes longer in a second, ``quality`` is what it holds of each pose's reaction;
    ``action`` is what it was given.
    """

    name = "hand_reactor"
    sha256 = "5" * 64
    rate_hz = 15
    frames = 64
    latent = 4

    def __init__(
        self,
        *,
        speed=0.1,
        ends_at=1000,
        breaks_at=1000,
        waits=None,
        known=RANGE,
        grows=0.0,
        quality=lambda index: 0.9,
    ):
        self.range = known
        self.action = None
        self.made = 0
        self._speed, self._ends_at, self._breaks_at = speed, ends_at, breaks_at
        self._waits, self._grows, self._quality = waits, grows, quality

    def react(self, action, first, noise):
        self.action = action
        for index in range(min(len(action), self._ends_at)):
            if index >= self._breaks_at:
                raise InferenceError("the hand is broken")
            if self._waits is not None:
                self._waits()
            self.made += 1
            pose = first.copy()
            ahead, down = first[RIGHT_ELBOW, :2] - first[RIGHT_HAND, :2]
            length = np.hypot(ahead, down)
            angle = np.arctan2(ahead, down) + self._speed * index / self.rate_hz / length
            length *= 1 + self._grows * index / self.rate_hz
            turned = length * np.array([np.sin(angle), np.cos(angle)])
            pose[RIGHT_HAND, :2] = first[RIGHT_ELBOW, :2] - turned
            yield pose + 0 * np.float32(noise.sum()), self._quality(index)
