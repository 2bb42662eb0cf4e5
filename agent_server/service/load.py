"""How loaded the server is, and what it leaves out for that: telemetry, then every other window.

Commands are never left out. Load is the lateness of the event loop, which everybody waits for.
"""

from enum import IntEnum

SMOOTHING = 0.1
"""Weight of a new measurement; at ten a second the average is over about a second."""
LARGEST_S = 0.5
"""More than this is not believed of one measurement: a hiccup is no load."""
TELEMETRY_S = (0.1, 0.05)
"""Telemetry is left out from this average lateness on, until it is below the second one."""
WINDOWS_S = (0.25, 0.12)
"""... and every other window, and no new session is opened."""


class Load(IntEnum):
    """What is left out; each stage leaves out what those before it do."""

    NONE = 0
    TELEMETRY = 1
    WINDOWS = 2


class LoadGauge:
    """Knows the load from how late the event loop was.

    Attributes:
        load: What is left out now.
    """

    def __init__(self) -> None:
        self.load = Load.NONE
        self._average_s = 0.0

    def push(self, lag_s: float) -> bool:
        """Take a measurement; tells whether the load is another one now."""
        self._average_s += SMOOTHING * (min(lag_s, LARGEST_S) - self._average_s)
        before = self.load
        if self._is_over(WINDOWS_S, Load.WINDOWS):
            self.load = Load.WINDOWS
        elif self._is_over(TELEMETRY_S, Load.TELEMETRY):
            self.load = Load.TELEMETRY
        else:
            self.load = Load.NONE
        return self.load is not before

    def _is_over(self, limits_s: tuple[float, float], load: Load) -> bool:
        enter_s, leave_s = limits_s
        return self._average_s > (leave_s if self.load >= load else enter_s)
