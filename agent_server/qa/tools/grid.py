"""Where a recording can be cut so that windows after the cut are those of the whole.

Windows lie on a grid of 40 ms that starts with the first frame of the followed body, and come
every few frames of it. A part that begins anywhere has another grid, and decisions on the edge
come out differently. So a part begins at the start of a window, with one pose made up there: the
one that the resampler had made up. What comes after the next frame is then interpolated between
the same frames as before, and one second later every window is the same to the bit.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from agent_server.config import Settings
from agent_server.domain.arrays import Float32, frozen
from agent_server.domain.motion import Window
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.errors import InvalidInput
from agent_server.stages.perceive import Perception

ELECTION_NS = 200 * NS_PER_MS
"""How long the nearest body is looked for before it is followed."""
_GUESSED = 0.5
"""Confidence of a joint that the sensor guessed."""


@dataclass(frozen=True, slots=True)
class GridStart:
    """Where a part may begin.

    Attributes:
        stamp_ns: Start of the window.
        frames: Two frames of the followed body in the pose that it has there: the first opens
            the election of the nearest body, the second, at ``stamp_ns``, closes it.
    """

    stamp_ns: int
    frames: tuple[SkeletonFrame, SkeletonFrame]


def grid_start(frames: Iterable[SkeletonFrame], at_ns: int, settings: Settings) -> GridStart | None:
    """The last start of a window at or before a time; None where nobody is followed then.

    Args:
        frames: All skeletons, in the order in which they came.
        at_ns: The time.
        settings: Those that the recording was made with.
    """
    perception = Perception(settings.window, settings.subject)
    found: Window | None = None
    seen: list[SkeletonFrame] = []
    for frame in frames:
        if frame.originating_ns > at_ns + 2 * NS_PER_S:
            break
        try:
            jobs = perception.push(frame)
        except InvalidInput:  # a frame that is out of order: the core has refused it too
            continue
        seen.append(frame)
        for job in jobs:
            if isinstance(job, Window) and job.start_ns <= at_ns:
                found = job
    if found is None or at_ns - found.start_ns > NS_PER_S or found.start_ns < ELECTION_NS:
        return None
    own = [frame for frame in seen if frame.body_id == found.body_id]
    pose = _pose_at(own, found.start_ns)
    start_ns = found.start_ns
    opening = replace(pose, originating_ns=start_ns - ELECTION_NS)
    return GridStart(start_ns, (opening, replace(pose, originating_ns=start_ns)))


def _pose_at(frames: list[SkeletonFrame], at_ns: int) -> SkeletonFrame:
    """The pose at a time between two frames; a joint that is hidden is where it was last seen."""
    last: Float32 | None = None
    before = frames[0]
    for frame in frames:
        if frame.originating_ns > at_ns:
            break
        tracked = frame.joints[:, 3:] > 0
        last = frame.joints if last is None else np.where(tracked, frame.joints, last)
        before = frame
    else:
        frame = before
    known = frame.joints if last is None else last
    span_ns = frame.originating_ns - before.originating_ns
    share = (at_ns - before.originating_ns) / span_ns if span_ns > 0 else 0.0
    both = (before.joints[:, 3:] > 0) & (frame.joints[:, 3:] > 0)
    between = before.joints + (frame.joints - before.joints) * np.float32(share)
    joints = np.where(both, between, known).astype(np.float32)
    sure = np.minimum(before.joints[:, 3], frame.joints[:, 3])
    joints[:, 3] = np.where(sure > 0, sure, _GUESSED)
    return replace(before, joints=frozen(joints, (None, 4)))
