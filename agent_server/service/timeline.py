"""One time line for a session: the clock of its first sensor.

A session with one sensor keeps that sensor's stamps untouched, which is what makes a live
decision log equal to a replayed one. Any other connection is mapped onto the time line when
its first stamp arrives. Between messages the session's time goes on with the server's clock.
"""

from agent_server.domain.stamp import MAX_STAMP_NS, NS_PER_S
from agent_server.errors import InvalidInput

MAX_LEAD_NS = 60 * NS_PER_S
"""How far a stamp may be ahead of the session's time: a recording may be sent faster than it was
made, but a clock that is wrong by hours must not carry the session away."""


class Timeline:
    """Maps stamps of several connections and the server's clock onto one line."""

    def __init__(self) -> None:
        self._offsets: dict[int, int] = {}
        self._last_ns: int | None = None
        self._last_arrival_ns = 0

    def resume(self, stamp_ns: int, arrival_ns: int) -> None:
        """Go on from ``stamp_ns`` after a restart: every sensor is mapped onto the line then."""
        self._last_ns = stamp_ns
        self._last_arrival_ns = arrival_ns

    def map(self, connection: int, stamp_ns: int, arrival_ns: int) -> int:
        """Where a connection's stamp lies on the session's time line; changes nothing.

        Args:
            connection: Identity of the connection.
            stamp_ns: Stamp on the sender's clock.
            arrival_ns: Server's monotonic clock at arrival.

        Raises:
            InvalidInput: If it lies before the session's start, or too far ahead.
        """
        if self._last_ns is None:
            return stamp_ns
        now_ns = self.now(arrival_ns)
        offset = self._offsets.get(connection)
        mapped = now_ns if offset is None else stamp_ns + offset
        if not 0 <= mapped <= min(MAX_STAMP_NS, now_ns + MAX_LEAD_NS):
            raise InvalidInput(
                f"originating_ns is {stamp_ns}, {(mapped - now_ns) / NS_PER_S:.0f} s from the "
                "session's time: send capture times of one monotonic clock, in nanoseconds",
                field="originating_ns",
                code="out_of_range",
            )
        return mapped

    def accept(self, connection: int, stamp_ns: int, mapped_ns: int, arrival_ns: int) -> None:
        """Let time go on to a stamp that was mapped and whose message was taken."""
        self._offsets.setdefault(connection, mapped_ns - stamp_ns)
        if self._last_ns is None or mapped_ns > self._last_ns:
            self._last_ns = mapped_ns
            self._last_arrival_ns = arrival_ns

    def forget(self, connection: int) -> None:
        """A connection has closed."""
        self._offsets.pop(connection, None)

    def now(self, arrival_ns: int) -> int:
        """The session's time when the server's clock shows ``arrival_ns``; 0 before it starts."""
        if self._last_ns is None:
            return 0
        return self._last_ns + max(0, arrival_ns - self._last_arrival_ns)

    def idle_ns(self, arrival_ns: int) -> int:
        """How long nothing stamped has arrived; 0 before the first."""
        return 0 if self._last_ns is None else arrival_ns - self._last_arrival_ns
