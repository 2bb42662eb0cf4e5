"""One time line for a session: the clock of its first sensor.

A session with one sensor keeps that sensor's stamps untouched, which is what makes a live
decision log equal to a replayed one. Any other connection is mapped onto the time line when
its first stamp arrives. Between messages the session's time goes on with the server's clock.
"""


class Timeline:
    """Maps stamps of several connections and the server's clock onto one line."""

    def __init__(self) -> None:
        self._offsets: dict[int, int] = {}
        self._last_ns: int | None = None
        self._last_arrival_ns = 0

    def map(self, connection: int, stamp_ns: int, arrival_ns: int) -> int:
        """Bring a connection's stamp onto the session's time line.

        Args:
            connection: Identity of the connection.
            stamp_ns: Stamp on the sender's clock.
            arrival_ns: Server's monotonic clock at arrival.
        """
        offset = self._offsets.get(connection)
        if offset is None:
            is_first = self._last_ns is None
            offset = 0 if is_first else self.now(arrival_ns) - stamp_ns
            self._offsets[connection] = offset
        mapped = stamp_ns + offset
        if self._last_ns is None or mapped > self._last_ns:
            self._last_ns = mapped
            self._last_arrival_ns = arrival_ns
        return mapped

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
