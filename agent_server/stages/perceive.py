"""From a sensor's frames to windows of the followed person's motion."""

from collections import Counter

from agent_server.config import SubjectSettings, WindowSettings
from agent_server.domain.motion import FRAME_NS, BodyLost, Window
from agent_server.domain.skeleton import CoreFrame, SkeletonFrame
from agent_server.domain.stamp import NS_PER_MS, to_ns
from agent_server.errors import InvalidInput
from agent_server.skeleton.resample import Resampler
from agent_server.skeleton.retarget import Retargeter, navel_distance
from agent_server.skeleton.subject import SubjectLock
from agent_server.stages.window import WindowStage

_MAX_BODIES = 64
"""More ids than any sensor tracks at once; older ones are forgotten."""


class Perception:
    """Chooses the person, brings their joints to 25 Hz and cuts windows.

    Args:
        window: When a window is made.
        subject: Who is followed.

    Attributes:
        latest: The newest frame on the 25 Hz grid, or None.
        counters: What was left out, by reason.
    """

    def __init__(self, window: WindowSettings, subject: SubjectSettings) -> None:
        self.latest: CoreFrame | None = None
        self.counters: Counter[str] = Counter()
        self._lock = SubjectLock(
            subject.policy,
            body_id=subject.body_id,
            release_ns=to_ns(subject.release_s),
            lost_ns=to_ns(subject.lost_s),
        )
        self._retargeter = Retargeter()
        self._resampler = Resampler(window.max_gap_ms * NS_PER_MS)
        self._windows = WindowStage(window.hop)
        self._seen_ns: dict[int, int] = {}

    def push(self, frame: SkeletonFrame) -> list[Window | BodyLost]:
        """Take the next frame of any body.

        Raises:
            InvalidInput: If it is not later than the last one of the same body; it is left
                out, and nothing has changed.
        """
        stamp_ns, body_id = frame.originating_ns, frame.body_id
        self._check_order(body_id, stamp_ns)
        found: list[Window | BodyLost] = []
        lost = self._lock.advance(stamp_ns)
        if lost is not None:
            found.append(lost)
        if not self._lock.offer(body_id, navel_distance(frame), stamp_ns):
            self.counters["other_bodies"] += 1
            return found
        core = self._retargeter.push(frame)
        if core is None:
            self.counters["incomplete"] += 1
            return found
        for on_grid in self._resampler.push(core):
            if self._is_new_start(on_grid):
                self._windows.reset()
            self.latest = on_grid
            window = self._windows.push(on_grid)
            if window is not None:
                found.append(window)
        self.counters["gaps"] = self._resampler.gaps
        return found

    @property
    def is_following(self) -> bool:
        """Whether somebody is followed who may leave."""
        return self._lock.followed is not None

    def advance(self, now_ns: int) -> BodyLost | None:
        """Let time pass without frames."""
        return self._lock.advance(now_ns)

    def _check_order(self, body_id: int, stamp_ns: int) -> None:
        seen_ns = self._seen_ns.get(body_id)
        if seen_ns is not None and stamp_ns <= seen_ns:
            raise InvalidInput(
                f"originating_ns is {stamp_ns}, and {seen_ns} has been seen of body {body_id}: "
                "send each frame once, in the order of capture",
                field="originating_ns",
                code="out_of_order",
            )
        if seen_ns is None and len(self._seen_ns) >= _MAX_BODIES:
            del self._seen_ns[next(iter(self._seen_ns))]
        self._seen_ns[body_id] = stamp_ns

    def _is_new_start(self, frame: CoreFrame) -> bool:
        """Whether the grid starts anew: after a gap, or with another body."""
        last = self.latest
        return (
            last is None
            or frame.body_id != last.body_id
            or frame.stamp_ns - last.stamp_ns != FRAME_NS
        )
