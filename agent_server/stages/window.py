"""From a 25 Hz stream to overlapping windows of one second."""

import numpy as np

from agent_server.domain.motion import FRAME_NS, SEEN_FRAMES, Window
from agent_server.domain.skeleton import CORE_JOINTS, CoreFrame
from agent_server.skeleton.mirror import MirrorDetector
from agent_server.skeleton.quality import assess

_ROOM = 10 * SEEN_FRAMES
"""Frames that are taken in before the newest second is moved back to the start."""


class WindowStage:
    """Collects frames and gives a window every ``hop`` frames once 25 have come.

    Args:
        hop: Frames between two windows, 1 to 25.
    """

    def __init__(self, hop: int) -> None:
        self._hop = hop
        self._positions = np.empty((_ROOM, CORE_JOINTS, 3), np.float32)
        self._confidence = np.empty((_ROOM, CORE_JOINTS), np.float32)
        self._end = 0
        self._until_next = self._fresh = SEEN_FRAMES
        self._next_index = 0
        self._mirror = MirrorDetector()

    def reset(self) -> None:
        """Forget the frames, after a gap or when another body is followed."""
        self._end = 0
        self._until_next = self._fresh = SEEN_FRAMES

    def push(self, frame: CoreFrame) -> Window | None:
        """Take the next frame on the 40 ms grid.

        Returns:
            A window that ends with this frame, or None.
        """
        if self._end == _ROOM:
            self._positions[: SEEN_FRAMES - 1] = self._positions[1 - SEEN_FRAMES :]
            self._confidence[: SEEN_FRAMES - 1] = self._confidence[1 - SEEN_FRAMES :]
            self._end = SEEN_FRAMES - 1
        self._positions[self._end] = frame.positions
        self._confidence[self._end] = frame.confidence
        self._end += 1
        self._until_next -= 1
        return self._cut(frame) if self._until_next == 0 else None

    def _cut(self, last: CoreFrame) -> Window:
        positions = self._positions[self._end - SEEN_FRAMES : self._end].copy()
        confidence = self._confidence[self._end - SEEN_FRAMES : self._end].copy()
        positions.flags.writeable = False
        confidence.flags.writeable = False
        # Only what the last window did not show is new evidence.
        mirrored = self._mirror.update(positions[-self._fresh :], confidence[-self._fresh :])
        self._until_next = self._fresh = self._hop
        index, self._next_index = self._next_index, self._next_index + 1
        return Window(
            index=index,
            body_id=last.body_id,
            start_ns=last.stamp_ns - (SEEN_FRAMES - 1) * FRAME_NS,
            end_ns=last.stamp_ns,
            positions=positions,
            confidence=confidence,
            quality=assess(positions, confidence, mirrored=mirrored),
        )
