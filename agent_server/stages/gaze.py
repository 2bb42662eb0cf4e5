"""Whether a person looks at the agent: a gaze that rests within a cone for a time.

It takes the place of the face where a headset hides it and tracks the eyes.
"""

from math import acos, degrees

import numpy as np

from agent_server.config import GazeSettings
from agent_server.domain.face import GazeSample
from agent_server.domain.stamp import NS_PER_MS
from agent_server.errors import InvalidInput


class GazeCone:
    """Follows the gaze of one person.

    Args:
        settings: Where the agent is, and how near and how long the gaze must be.
    """

    def __init__(self, settings: GazeSettings) -> None:
        self._settings = settings
        self._latest: GazeSample | None = None
        self._angle_deg = 180.0
        self._since_ns: int | None = None

    def push(self, sample: GazeSample) -> None:
        """Take the next sample.

        Raises:
            InvalidInput: If it is not later than the last one; nothing has changed then.
        """
        latest, s = self._latest, self._settings
        if latest is not None and sample.originating_ns <= latest.originating_ns:
            raise InvalidInput(
                f"originating_ns is {sample.originating_ns}, and {latest.originating_ns} has been "
                "seen: send each gaze once, in the order of capture",
                field="originating_ns",
                code="out_of_order",
            )
        was_lost = latest is None or (
            sample.originating_ns - latest.originating_ns > s.max_age_ms * NS_PER_MS
        )
        if was_lost:
            self._since_ns = None
        self._latest = sample
        self._angle_deg = _angle_deg(sample, s.agent)
        limit = s.enter_deg if self._since_ns is None else s.leave_deg
        if self._angle_deg > limit:
            self._since_ns = None
        elif self._since_ns is None:
            self._since_ns = sample.originating_ns

    def age_ms(self, now_ns: int) -> float | None:
        """Time from the last gaze to ``now_ns``; None before the first."""
        return None if self._latest is None else (now_ns - self._latest.originating_ns) / NS_PER_MS

    def angle_deg(self, now_ns: int) -> float | None:
        """Angle between the gaze and the way to the agent; None without a usable gaze."""
        age_ms = self.age_ms(now_ns)
        if age_ms is None or abs(age_ms) > self._settings.max_age_ms:
            return None
        return self._angle_deg

    def dwells(self) -> bool:
        """Whether the gaze has rested on the agent for long enough."""
        if self._since_ns is None or self._latest is None:
            return False
        rested_ns = self._latest.originating_ns - self._since_ns
        return rested_ns >= self._settings.dwell_ms * NS_PER_MS


def _angle_deg(sample: GazeSample, target: tuple[float, float, float]) -> float:
    way = np.subtract(target, sample.origin)
    distance = float(np.linalg.norm(way))
    if distance == 0.0:
        return 0.0
    cosine = float(np.dot(way, sample.direction)) / distance
    return degrees(acos(max(-1.0, min(1.0, cosine))))
