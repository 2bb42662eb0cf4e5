"""How fast a client is read."""

from agent_server.domain.stamp import NS_PER_MS, NS_PER_S

TURN_NS = 2 * NS_PER_MS
"""Who sent something less than this ago lets others have their turn."""


class Pace:
    """Lets a second's worth of messages through at once, and then one after the other.

    Nothing is refused: who sends faster waits in its own connection, whose buffers fill.

    Args:
        per_s: Messages a second.
    """

    def __init__(self, per_s: int) -> None:
        self._gap_ns = NS_PER_S // per_s
        self._due_ns = 0
        self._last_ns = 0

    def wait_ns(self, now_ns: int) -> int | None:
        """Take note of a message; how long to wait before the next one is read.

        Returns:
            None for a message after a pause; 0 for one of a burst, so that others may have
            their turn.
        """
        is_first = now_ns - self._last_ns >= TURN_NS
        self._last_ns = now_ns
        self._due_ns = max(self._due_ns, now_ns - NS_PER_S) + self._gap_ns
        wait_ns = max(0, self._due_ns - now_ns)
        return None if is_first and not wait_ns else wait_ns
