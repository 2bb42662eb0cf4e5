"""From a sensor's irregular frames to the exact 25 Hz of the models."""

import numpy as np

from agent_server.domain.motion import FRAME_NS
from agent_server.domain.skeleton import CoreFrame
from agent_server.domain.stamp import NS_PER_MS
from agent_server.errors import InvalidInput


class Resampler:
    """Streaming linear interpolation of one body's frames onto a grid of 40 ms.

    The grid starts at the stamp of the first frame and holds whole nanoseconds, so that it does
    not drift. A frame on the grid is given back as it came. Between two frames the
    confidence is the lower of the two.

    A pause of more than ``max_gap_ns``, or another body, starts a new grid: nothing is made up
    in between. The next frame's stamp then is not ``FRAME_NS`` after the one before, or its
    body is another one.

    Args:
        max_gap_ns: The longest pause between two frames that is still interpolated.

    Attributes:
        gaps: How many pauses of one body were too long.
    """

    __slots__ = ("_last", "_max_gap_ns", "_next_ns", "gaps")

    def __init__(self, max_gap_ns: int = 250 * NS_PER_MS) -> None:
        self._max_gap_ns = max_gap_ns
        self._last: CoreFrame | None = None
        self._next_ns = 0
        self.gaps = 0

    def push(self, frame: CoreFrame) -> list[CoreFrame]:
        """Take the next frame.

        Returns:
            The frames on the grid after the last one given, up to this frame's stamp.

        Raises:
            InvalidInput: If the frame is not later than the one before (code
                ``out_of_order``). It is left out, and the stream can go on.
        """
        last, now = self._last, frame.stamp_ns
        if last is None:
            return self._restart(frame)
        if frame.body_id != last.body_id:
            return self._restart(frame)
        step = now - last.stamp_ns
        if step <= 0:
            raise InvalidInput(
                f"originating_ns is {now}, and {last.stamp_ns} has been seen: send each frame "
                "once, in the order of capture",
                field="originating_ns",
                code="out_of_order",
            )
        if step > self._max_gap_ns:
            self.gaps += 1
            return self._restart(frame)
        self._last = frame
        at = self._next_ns
        if at > now:
            return []
        frames = []
        if at < now:
            move = frame.positions - last.positions
            confidence = np.minimum(last.confidence, frame.confidence)
            confidence.flags.writeable = False
            while at < now:
                positions = move * ((at - last.stamp_ns) / step)
                positions += last.positions
                positions.flags.writeable = False
                frames.append(CoreFrame(at, frame.body_id, positions, confidence))
                at += FRAME_NS
        if at == now:
            frames.append(frame)
            at += FRAME_NS
        self._next_ns = at
        return frames

    def _restart(self, frame: CoreFrame) -> list[CoreFrame]:
        self._last = frame
        self._next_ns = frame.stamp_ns + FRAME_NS
        return [frame]
