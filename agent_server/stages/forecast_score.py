"""How good the forecasts were, told when the truth has arrived.

A forecast of two seconds is scored when those two seconds have been seen: the mean distance of
the joints, beside that of a body which simply stands still (zero velocity), the least that a
forecast must beat. One forecast a second is; those in between look at nearly the same two seconds.
What comes out is for those who look after a server; no decision sees it.
"""

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import (
    FRAME_NS,
    PREDICTED_FRAMES,
    RATE_HZ,
    SEEN_FRAMES,
    Forecast,
    ForecastFigures,
    Window,
)
from agent_server.domain.skeleton import CORE_JOINTS
from agent_server.domain.stamp import NS_PER_S

ROLLING_NS = 60 * NS_PER_S
ENOUGH = 20
"""Fewer scored forecasts than these, a third of a minute's, say nothing yet."""
MARGIN = 1.1
MARGIN_MM = 5.0
"""Forecasts drift when their error is over ``MARGIN`` times that of zero velocity and
``MARGIN_MM`` more: where nobody moves, a sensor's noise alone makes any forecast a little worse.
In no minute of the recorded streams, which are synthetic, is the error over 1.00 times that of zero
velocity."""

_KEPT = PREDICTED_FRAMES + SEEN_FRAMES
"""Frames that are remembered: a forecast's, and as many as a window may bring."""


@dataclass(frozen=True, slots=True)
class _Open:
    """A forecast whose truth has not come yet; ``end`` counts the frames up to its window's end."""

    end: int
    positions: Float32
    last: Float32


class ForecastScore:
    """Scores one session's forecasts."""

    def __init__(self) -> None:
        self._positions = np.zeros((_KEPT, CORE_JOINTS, 3), np.float32)
        self._measured: NDArray[np.bool_] = np.zeros((_KEPT, CORE_JOINTS), np.bool_)
        self._body_id = -1
        self._end_ns = 0
        self._frames = 0
        self._open: deque[_Open] = deque()
        self._scores: deque[tuple[int, float, float]] = deque()
        self._sums = np.zeros(2)
        self._is_drifting = False

    def push(self, window: Window, forecast: Forecast) -> bool:
        """Take the next window and its forecast.

        Returns:
            Whether the forecasts have begun to drift with it.
        """
        self._see(window)
        is_due = not self._open or self._frames - self._open[-1].end >= RATE_HZ
        if is_due and forecast.failure is None:
            self._open.append(_Open(self._frames, forecast.positions, window.positions[-1]))
        while self._open and self._frames - self._open[0].end >= PREDICTED_FRAMES:
            self._score(self._open.popleft(), window.end_ns)
        while self._scores and window.end_ns - self._scores[0][0] > ROLLING_NS:
            _, error, still = self._scores.popleft()
            self._sums -= (error, still)
        was_drifting = self._is_drifting
        if len(self._scores) >= ENOUGH:
            error_mm, still_mm = self._sums / len(self._scores)
            self._is_drifting = bool(error_mm > MARGIN * still_mm + MARGIN_MM)
        return self._is_drifting and not was_drifting

    def figures(self) -> ForecastFigures | None:
        """The last minute, or None where no truth has come."""
        if not self._scores:
            return None
        count = len(self._scores)
        error_mm, still_mm = (self._sums / count).tolist()
        return ForecastFigures(abs(round(error_mm, 1)), abs(round(still_mm, 1)), count)

    def _see(self, window: Window) -> None:
        """Append the frames that are new; after a gap, or with another body, begin anew."""
        fresh, odd_ns = divmod(window.end_ns - self._end_ns, FRAME_NS)
        if odd_ns or not 0 < fresh <= SEEN_FRAMES or window.body_id != self._body_id:
            self._open.clear()
            fresh = SEEN_FRAMES
        self._body_id, self._end_ns = window.body_id, window.end_ns
        self._frames += fresh
        self._positions = np.concatenate((self._positions[fresh:], window.positions[-fresh:]))
        measured = window.confidence[-fresh:] > 0.0
        self._measured = np.concatenate((self._measured[fresh:], measured))

    def _score(self, forecast: _Open, now_ns: int) -> None:
        late = self._frames - forecast.end - PREDICTED_FRAMES
        rows = slice(_KEPT - late - PREDICTED_FRAMES, _KEPT - late)
        truth, measured = self._positions[rows], self._measured[rows]
        if not measured.any():
            return
        offsets = np.stack((truth - forecast.positions, truth - forecast.last))
        lengths = np.sqrt(np.einsum("ktji,ktji->ktj", offsets, offsets))
        means_mm = lengths[:, measured].mean(axis=1, dtype=np.float64) * 1000.0
        self._sums += means_mm
        self._scores.append((now_ns, *means_mm.tolist()))
