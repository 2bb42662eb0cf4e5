"""Time as the product sees it: integer nanoseconds on a monotonic clock."""

import time
from datetime import UTC, datetime
from typing import Protocol


class Clock(Protocol):
    """Where a shell reads the time; the synchronous core never does."""

    def now_ns(self) -> int:
        """Nanoseconds on a monotonic clock with an arbitrary zero."""
        ...

    def wall(self) -> str:
        """Wall-clock time as an ISO 8601 string in UTC, for people and logs only."""
        ...

    def wall_ns(self) -> int:
        """Wall-clock time in nanoseconds since 1970; it may be set, and jump.

        It only tells how long a server was away.
        """
        ...


class SystemClock:
    """The machine's monotonic clock."""

    def now_ns(self) -> int:
        """Nanoseconds since some moment in the past."""
        return time.monotonic_ns()

    def wall(self) -> str:
        """Now, in UTC."""
        return datetime.now(UTC).isoformat(timespec="milliseconds")

    def wall_ns(self) -> int:
        """Now, since 1970."""
        return time.time_ns()


class ManualClock:
    """A clock that stands still until it is told to move.

    Args:
        now_ns: Where it starts.
    """

    def __init__(self, now_ns: int = 0) -> None:
        self._now_ns = now_ns

    def now_ns(self) -> int:
        """Where it stands."""
        return self._now_ns

    def wall(self) -> str:
        """Where it stands, counted from 1970."""
        return datetime.fromtimestamp(self._now_ns / 1e9, UTC).isoformat(timespec="milliseconds")

    def wall_ns(self) -> int:
        """Where it stands."""
        return self._now_ns

    def advance(self, by_ns: int) -> None:
        """Move forward by ``by_ns`` nanoseconds.

        Raises:
            ValueError: If ``by_ns`` is negative.
        """
        if by_ns < 0:
            raise ValueError(f"a clock cannot go back, got {by_ns} ns")
        self._now_ns += by_ns
