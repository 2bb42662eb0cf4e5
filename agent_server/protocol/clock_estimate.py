"""The other side's clock, as pings and pongs tell it (docs/clients.md)."""

from collections import deque
from dataclasses import dataclass

from agent_server.domain.stamp import NS_PER_MS

SAMPLES = 8
GAIN = 4
"""The estimate follows the best sample by one part in so many."""
TOLERANCE_NS = 50 * NS_PER_MS
OUTLIERS = 3
"""So many samples in a row beyond the tolerance, to the same side, are a jump."""


@dataclass(frozen=True, slots=True)
class _Sample:
    round_trip_ns: int
    offset_ns: int


class ClockEstimate:
    """Round trip and offset of one connection, smoothed; Cristian's estimate, best of the last 8.

    Attributes:
        offset_ns: The other side's clock less this one's, or None before the first pong.
        round_trip_ns: Smallest round trip of late, or None before the first pong.
        jumps: How often one of the clocks has jumped.
    """

    def __init__(self) -> None:
        self.offset_ns: int | None = None
        self.round_trip_ns: int | None = None
        self.jumps = 0
        self._first_offset_ns = 0
        self._samples: deque[_Sample] = deque(maxlen=SAMPLES)
        self._outliers = 0

    def push(self, sent_ns: int, time_ns: int, now_ns: int) -> int | None:
        """Take a pong.

        Args:
            sent_ns: This side's clock when it pinged.
            time_ns: The other side's clock when it answered.
            now_ns: This side's clock now.

        Returns:
            By how much the offset has jumped, in nanoseconds, or None if it has not. A pong from
            before its ping, or from after now, is passed over.
        """
        round_trip_ns = now_ns - sent_ns
        if round_trip_ns < 0:
            return None
        sample = _Sample(round_trip_ns, time_ns + round_trip_ns // 2 - now_ns)
        if self.offset_ns is None:
            self._begin(sample)
            return None
        away_ns = sample.offset_ns - self.offset_ns
        if abs(away_ns) <= TOLERANCE_NS + round_trip_ns // 2 + self._off_by_ns:
            self._outliers = 0
            self._follow(sample)
            return None
        is_same_side = (away_ns > 0) == (self._outliers > 0)
        side = 1 if away_ns > 0 else -1
        self._outliers = self._outliers + side if is_same_side else side
        if abs(self._outliers) < OUTLIERS:
            return None
        self.jumps += 1
        self._begin(sample)
        return away_ns

    @property
    def _off_by_ns(self) -> int:
        """How far the estimate may be off, by the sample that it goes by."""
        return 0 if self.round_trip_ns is None else self.round_trip_ns // 2

    @property
    def drift_ns(self) -> int:
        """By how much the offset has changed since the first pong, or the last jump."""
        return 0 if self.offset_ns is None else self.offset_ns - self._first_offset_ns

    def _begin(self, sample: _Sample) -> None:
        self._outliers = 0
        self._samples.clear()
        self._samples.append(sample)
        self.offset_ns, self.round_trip_ns = sample.offset_ns, sample.round_trip_ns
        self._first_offset_ns = sample.offset_ns

    def _follow(self, sample: _Sample) -> None:
        self._samples.append(sample)
        best = min(self._samples, key=lambda one: one.round_trip_ns)
        assert self.offset_ns is not None  # noqa: S101 - samples follow a first one
        self.round_trip_ns = best.round_trip_ns
        followed_ns = self.offset_ns + (best.offset_ns - self.offset_ns) // GAIN
        lowest_ns, highest_ns = best.offset_ns - self._off_by_ns, best.offset_ns + self._off_by_ns
        self.offset_ns = min(max(followed_ns, lowest_ns), highest_ns)
