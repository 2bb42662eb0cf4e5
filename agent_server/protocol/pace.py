"""How fast a client is read."""

from agent_server.domain.stamp import NS_PER_S


class Pace:
    """Lets a second's worth of messages through at once, and then one after the other.

    Nothing is refused: who sends faster waits in its own connection, whose buffers fill.

    Args:
        per_s: Messages a second.
    """

    def __init__(self, per_s: int) -> None:
        self._gap_ns = NS_PER_S // per_s
        self._due_ns = 0

    def wait_ns(self, now_ns: int) -> int | None:
        """Take note of a message; how long to wait before the next one is read.

        Returns:
            None for who keeps the pace; 0 for who has sent some messages in a hurry, so that
            others may have their turn.
        """
        earliest_ns = now_ns - NS_PER_S
        if self._due_ns <= earliest_ns:
            self._due_ns = earliest_ns + self._gap_ns
            return None
        self._due_ns += self._gap_ns
        return max(0, self._due_ns - now_ns)
