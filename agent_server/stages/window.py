"""From a 25 Hz stream to overlapping windows of one second."""

from collections import deque

import numpy as np

from agent_server.domain.motion import FRAME_NS, SEEN_FRAMES, Window
from agent_server.domain.skeleton import CoreFrame
from agent_server.skeleton.mirror import MirrorDetector
from agent_server.skeleton.quality import assess


class WindowStage:
    """Collects frames and gives a window every ``hop`` frames once 25 have come.

    Args:
        hop: Frames between two windows, 1 to 25.
    """

    def __init__(self, hop: int) -> None:
        self._hop = hop
        self._frames: deque[CoreFrame] = deque(maxlen=SEEN_FRAMES)
        self._until_next = self._fresh = SEEN_FRAMES
        self._next_index = 0
        self._mirror = MirrorDetector()

    def reset(self) -> None:
        """Forget the frames, after a gap or when another body is followed."""
        self._frames.clear()
        self._until_next = self._fresh = SEEN_FRAMES

    def push(self, frame: CoreFrame) -> Window | None:
        """Take the next frame on the 40 ms grid.

        Returns:
            A window that ends with this frame, or None.
        """
        self._frames.append(frame)
        self._until_next -= 1
        if self._until_next:
            return None
        positions = np.stack([f.positions for f in self._frames])
        confidence = np.stack([f.confidence for f in self._frames])
        positions.flags.writeable = False
        confidence.flags.writeable = False
        # Only what the last window did not show is new evidence.
        mirrored = self._mirror.update(positions[-self._fresh :], confidence[-self._fresh :])
        self._until_next = self._fresh = self._hop
        index, self._next_index = self._next_index, self._next_index + 1
        return Window(
            index=index,
            body_id=frame.body_id,
            start_ns=frame.stamp_ns - (SEEN_FRAMES - 1) * FRAME_NS,
            end_ns=frame.stamp_ns,
            positions=positions,
            confidence=confidence,
            quality=assess(positions, confidence, mirrored=mirrored),
        )
