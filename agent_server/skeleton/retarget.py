"""From a sensor's joints to the nine core joints in the canonical camera frame."""

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32
from agent_server.domain.skeleton import CORE_JOINTS, CoreFrame, CoreJoint, SkeletonFrame
from agent_server.domain.stamp import NS_PER_S
from agent_server.skeleton.formats import get_format

_CONFIDENCE = 3
_FORGET_NS = NS_PER_S


@dataclass(frozen=True, slots=True)
class _CoreMap:
    """A format's linear map to the core joints, as arrays.

    Attributes:
        sources: Shape (9, K): the joints that make up each core joint; a core joint with
            fewer than K repeats its last one.
        weights: Shape (9, K): their weights, 0 for a repeated one; None when K is 1.
        scale: Shape (4,): unit and sign of x, y, z, then 1; None where all are 1.
        navel: The joints that make up the navel, and what one unit of each one's z adds to the
            navel's, in metres.
    """

    sources: NDArray[np.intp]
    weights: Float32 | None
    scale: Float32 | None
    navel: tuple[tuple[int, float], ...]


@lru_cache(maxsize=64)
def _core_map(name: str) -> _CoreMap:
    table = get_format(name)
    at = {joint: index for index, joint in enumerate(table.names)}
    width = max(map(len, table.core))
    rows = [[*shares, *[(shares[-1][0], 0.0)] * (width - len(shares))] for shares in table.core]
    sources = np.array([[at[joint] for joint, _ in row] for row in rows], dtype=np.intp)
    weights = np.array([[weight for _, weight in row] for row in rows], dtype=np.float32)
    scale = np.array([*(sign * table.unit_m for sign in table.axes), 1.0], dtype=np.float32)
    return _CoreMap(
        sources=sources if width > 1 else sources[:, 0],
        weights=weights if width > 1 else None,
        scale=scale if (scale != 1.0).any() else None,
        navel=tuple(
            (at[joint], weight * table.axes[2] * table.unit_m)
            for joint, weight in table.core[CoreJoint.NAVEL]
        ),
    )


def retarget(frame: SkeletonFrame) -> Float32:
    """The core joints of one frame, as measured.

    A core joint that is a mean is as certain as the least certain joint of the mean.

    Args:
        frame: A body in any known format.

    Returns:
        Shape (9, 4): x, y, z in metres in the camera frame, then the confidence. Nothing is
        filled in: the position of a joint of confidence 0 means nothing, and numbers that are
        not finite stay so.

    Raises:
        InvalidInput: If the format is not known.
    """
    core_map = _core_map(frame.format)
    core: Float32 = frame.joints.take(core_map.sources, axis=0)
    if core_map.weights is not None:
        confidence = core[:, :, _CONFIDENCE].min(axis=1)
        core = np.einsum("jk,jkd->jd", core_map.weights, core)
        core[:, _CONFIDENCE] = confidence
    if core_map.scale is not None:
        core *= core_map.scale
    return core


def navel_distance(frame: SkeletonFrame) -> float:
    """How far in front of the sensor a body is.

    Returns:
        z of the navel in metres; infinite where it is not tracked. A format whose origin moves
        with the body gives about 0 for everybody.

    Raises:
        InvalidInput: If the format is not known.
    """
    joints, distance = frame.joints, 0.0
    for joint, share_m in _core_map(frame.format).navel:
        if not joints.item(joint, _CONFIDENCE) > 0.0:
            return math.inf
        distance += share_m * joints.item(joint, 2)
    return distance if math.isfinite(distance) else math.inf


class Retargeter:
    """Retargets one body's frames and stands in for joints that are not tracked.

    A joint of confidence 0, or with a number that is not finite, keeps its last known position
    with confidence 0. Another body or another format starts from nothing, and so does a body that
    comes back after more than a second: it may be anywhere by then.
    """

    __slots__ = ("_last", "_source", "_stamp_ns", "_unseen")

    def __init__(self) -> None:
        self._source: tuple[str, int] | None = None
        self._stamp_ns = 0
        self._last: Float32 = np.zeros((CORE_JOINTS, 4), dtype=np.float32)
        self._unseen: NDArray[np.bool_] | None = None

    def push(self, frame: SkeletonFrame) -> CoreFrame | None:
        """Take the body's next frame.

        Returns:
            The core joints, or None as long as some joint has never been tracked.

        Raises:
            InvalidInput: If the format is not known.
        """
        core = retarget(frame)
        source = (frame.format, frame.body_id)
        stamp_ns = frame.originating_ns
        if source != self._source or stamp_ns - self._stamp_ns > _FORGET_NS:
            self._source = source
            self._unseen = np.ones(CORE_JOINTS, dtype=np.bool_)
        self._stamp_ns = stamp_ns
        # On so few numbers Python's own arithmetic is faster than an array call; their sum is
        # finite only where every one is.
        numbers = core.ravel().tolist()
        if not (min(numbers[_CONFIDENCE::4]) > 0.0 and math.isfinite(sum(numbers))):
            core = self._fill(core)
        elif self._unseen is not None:
            self._unseen = None
        core.flags.writeable = False
        self._last = core
        if self._unseen is not None:
            return None
        return CoreFrame(stamp_ns, frame.body_id, core[:, :3], core[:, _CONFIDENCE])

    def _fill(self, core: Float32) -> Float32:
        tracked = np.isfinite(core).all(axis=1) & (core[:, _CONFIDENCE] > 0.0)
        if self._unseen is not None:
            unseen = self._unseen & ~tracked
            self._unseen = unseen if unseen.any() else None
        filled = np.where(tracked[:, None], core, self._last)
        filled[~tracked, _CONFIDENCE] = 0.0
        return filled
