"""Leading a person through the repetitions of a gesture: when to prompt, and what to label.

The machine knows no clock but the stamps of the frames, so it does on a recording that is sent
faster than it was made what it does in front of a person.
"""

from enum import Enum, auto

import numpy as np

from agent_server.domain.label import Label
from agent_server.domain.skeleton import CoreFrame, CoreJoint, SkeletonFrame
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.recording.takes import (
    MIN_IDLE_NS,
    Again,
    Count,
    Cue,
    Done,
    Go,
    Gone,
    Left,
    Seen,
    Spoilt,
    Taken,
    TakePlan,
)
from agent_server.skeleton.movement import SURE, find_movement
from agent_server.skeleton.resample import Resampler
from agent_server.skeleton.retarget import Retargeter, navel_distance
from agent_server.skeleton.subject import SubjectLock

COUNT_DOWN = 3
"""Seconds that are counted before a repetition."""
SETTLE_NS = NS_PER_S
"""A body is watched for this long before the first count."""
MAX_GAP_NS = 250 * NS_PER_MS
"""A longer gap spoils a repetition: no window of the live stages would span it either."""
AWAY_NS = NS_PER_S
"""Whoever is not seen for this long between two repetitions has gone."""
REMIND_NS = 10 * NS_PER_S
"""How often the time that is left of a long stretch is told."""

_REST_FRAMES = 13
"""How much of the count-down shows where the arms rest: half a second."""
_WRISTS = [CoreJoint.LEFT_WRIST, CoreJoint.RIGHT_WRIST]


class _Stage(Enum):
    WAITING = auto()
    SETTLING = auto()
    COUNTING = auto()
    SHOWING = auto()
    IDLING = auto()
    RESTING = auto()
    DONE = auto()


class TakeDirector:
    """Follows one body, says when it is time for what, and labels what was shown.

    A repetition is what moves between "go" and the end of its time. One in which nothing moves,
    the hands are hidden or the body is lost comes again. Idle motion is labelled as it is; a
    lost body parts it in two.

    Args:
        plan: What is to be recorded.

    Attributes:
        labels: What was shown so far.
        repeated: How many repetitions did not count.
        followed: How many frames of the body were seen, at 25 Hz.
    """

    def __init__(self, plan: TakePlan) -> None:
        self.labels: list[Label] = []
        self.repeated = 0
        self.followed = 0
        self._plan = plan
        self._lock = SubjectLock("nearest")
        self._retargeter = Retargeter()
        self._resampler = Resampler(MAX_GAP_NS)
        self._stage = _Stage.WAITING
        self._until_ns = 0
        self._seen_ns = 0
        self._go_ns = 0
        self._counted = 0
        self._idle_left_ns = plan.idle_ns if plan.is_idle else 0
        self._remind_ns = 0
        self._track: list[CoreFrame] = []
        self._resting = 0

    @property
    def repetition(self) -> int:
        """The repetition that is going on, or comes next, from 1."""
        return len(self.labels) + 1

    def push(self, frame: SkeletonFrame) -> list[Cue]:
        """Take the next frame of any body."""
        cues = self.advance(frame.originating_ns)
        if not self._lock.offer(frame.body_id, navel_distance(frame), frame.originating_ns):
            return cues
        core = self._retargeter.push(frame)
        # Some sensors go on sending a body that they have lost, with no joint tracked.
        if core is not None and core.confidence.any():
            self._seen_ns = core.stamp_ns
            for on_grid in self._resampler.push(core):
                cues += self._step(on_grid)
        return cues

    def advance(self, now_ns: int) -> list[Cue]:
        """Let time pass without a frame of the body."""
        self._lock.advance(now_ns)
        limit_ns = AWAY_NS
        match self._stage:
            case _Stage.WAITING | _Stage.DONE:
                return []
            case _Stage.COUNTING | _Stage.SHOWING | _Stage.IDLING:
                limit_ns = MAX_GAP_NS
        return self._lose() if now_ns - self._seen_ns > limit_ns else []

    def stop(self) -> list[Cue]:
        """End early. Idle motion counts up to here, a repetition that is going on does not."""
        cues = self._end_idle(self._seen_ns) if self._stage is _Stage.IDLING else []
        self._stage = _Stage.DONE
        return cues

    # ------------------------------------------------------------------ from stage to stage

    def _enter(self, stage: _Stage, now_ns: int, for_ns: int) -> None:
        self._stage, self._until_ns = stage, now_ns + for_ns

    def _step(self, frame: CoreFrame) -> list[Cue]:
        """Take a frame of the body on the 40 ms grid."""
        now_ns = frame.stamp_ns
        self.followed += 1
        is_due = now_ns >= self._until_ns
        match self._stage:
            case _Stage.WAITING:
                self._enter(_Stage.SETTLING, now_ns, SETTLE_NS)
                return [Seen()]
            case _Stage.SETTLING | _Stage.RESTING:
                return self._next(now_ns) if is_due else []
            case _Stage.COUNTING:
                return self._go(frame) if is_due else self._count(frame)
            case _Stage.SHOWING:
                self._track.append(frame)
                return self._judge(now_ns) if is_due else []
            case _Stage.IDLING:
                return self._finish_idle(now_ns) if is_due else self._remind(now_ns)
            case _Stage.DONE:
                return []

    def _next(self, now_ns: int) -> list[Cue]:
        missing = self._idle_left_ns
        if not self._plan.is_idle:
            missing = self._plan.repetitions - len(self.labels)
        if missing <= 0:
            self._stage = _Stage.DONE
            return [Done()]
        self._enter(_Stage.COUNTING, now_ns, COUNT_DOWN * NS_PER_S)
        self._track.clear()
        self._counted = COUNT_DOWN
        return [Count(self.repetition, COUNT_DOWN)]

    def _count(self, frame: CoreFrame) -> list[Cue]:
        self._track.append(frame)
        left = -((frame.stamp_ns - self._until_ns) // NS_PER_S)
        if left == self._counted:
            return []
        self._counted = left
        return [Count(self.repetition, left)]

    def _go(self, frame: CoreFrame) -> list[Cue]:
        self._go_ns = frame.stamp_ns
        if self._plan.is_idle:
            self._enter(_Stage.IDLING, frame.stamp_ns, self._idle_left_ns)
            self._remind_ns = (self._idle_left_ns - 1) // REMIND_NS * REMIND_NS
            return [Go(self.repetition, self._idle_left_ns)]
        self._enter(_Stage.SHOWING, frame.stamp_ns, self._plan.window_ns)
        self._track = [*self._track[-_REST_FRAMES:], frame]
        self._resting = len(self._track) - 1
        return [Go(self.repetition, self._plan.window_ns)]

    def _judge(self, now_ns: int) -> list[Cue]:
        self._enter(_Stage.RESTING, now_ns, self._plan.rest_ns)
        positions = np.stack([frame.positions for frame in self._track])
        confidence = np.stack([frame.confidence for frame in self._track])
        movement = find_movement(positions, confidence, self._resting)
        if movement is None:
            sure = np.mean(confidence[self._resting :, _WRISTS] >= SURE)
            return [self._spoil(Spoilt.STILL if sure >= 0.5 else Spoilt.HIDDEN)]
        onset_ns = self._track[movement.onset].stamp_ns
        offset_ns = self._track[movement.offset].stamp_ns
        return [self._label(onset_ns, offset_ns, is_cut=not movement.is_over)]

    def _spoil(self, reason: Spoilt) -> Cue:
        self.repeated += 1
        return Again(self.repetition, reason)

    def _label(self, onset_ns: int, offset_ns: int, *, is_cut: bool) -> Cue:
        plan, repetition = self._plan, self.repetition
        label = Label(
            plan.gesture, onset_ns, offset_ns, plan.subject, expected=None, quiet=plan.is_idle
        )
        self.labels.append(label)
        return Taken(repetition, label, is_cut)

    def _lose(self) -> list[Cue]:
        stage, self._stage = self._stage, _Stage.WAITING
        cues: list[Cue] = []
        if stage is _Stage.SHOWING:
            cues.append(self._spoil(Spoilt.LOST))
        elif stage is _Stage.IDLING:
            cues += self._end_idle(self._seen_ns)
        return [*cues, Gone()]

    # ------------------------------------------------------------------ idle motion

    def _remind(self, now_ns: int) -> list[Cue]:
        if not 0 < self._until_ns - now_ns <= self._remind_ns:
            return []
        left_ns, self._remind_ns = self._remind_ns, self._remind_ns - REMIND_NS
        return [Left(left_ns)]

    def _finish_idle(self, now_ns: int) -> list[Cue]:
        self._enter(_Stage.RESTING, now_ns, 0)
        return self._end_idle(now_ns)

    def _end_idle(self, now_ns: int) -> list[Cue]:
        """Label the stretch that ends now, if it is long enough to be of use."""
        stretch_ns = now_ns - self._go_ns
        if stretch_ns < MIN_IDLE_NS:
            return [self._spoil(Spoilt.LOST)]
        left_ns = self._idle_left_ns - stretch_ns
        self._idle_left_ns = left_ns if left_ns >= MIN_IDLE_NS else 0
        return [self._label(self._go_ns, now_ns, is_cut=False)]
