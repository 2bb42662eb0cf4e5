"""How long to wait before the next attempt to connect (docs/clients.md)."""

from collections.abc import Callable

BASE_S = 0.25
EARLY_CAP_S = 1.5
"""While an outage is young: a server that restarts is found within two seconds."""
EARLY_S = 20.0
CAP_S = 15.0


class Backoff:
    """Full jitter: uniform between nothing and a bound that doubles with each failed attempt.

    Args:
        random: Gives uniform numbers in [0, 1).
    """

    def __init__(self, random: Callable[[], float]) -> None:
        self._random = random
        self._bound_s = BASE_S
        self._since_s: float | None = None

    def next_s(self, now_s: float) -> float:
        """Seconds to wait after an attempt or a connection has ended at ``now_s``."""
        if self._since_s is None:
            self._since_s = now_s
        delay_s = self._random() * self._bound_s
        is_young = now_s - self._since_s < EARLY_S
        self._bound_s = min(self._bound_s * 2, EARLY_CAP_S if is_young else CAP_S)
        return delay_s

    def reset(self) -> None:
        """A connection is live."""
        self._bound_s = BASE_S
        self._since_s = None
