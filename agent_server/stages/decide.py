"""From probabilities to gestures: hysteresis and cool-down, one decision a gesture."""

from collections.abc import Collection
from dataclasses import dataclass
from enum import Enum, auto

from agent_server.config import DecideSettings
from agent_server.domain.gesture import IDLE, Classification
from agent_server.domain.stamp import to_ns


class Phase(Enum):
    """Where the tracker stands after a window."""

    IDLE = auto()
    """Nothing is going on."""
    UNSURE = auto()
    """Something may be starting, or is not clear enough."""
    COOLING_DOWN = auto()
    """A gesture is seen again too soon after it ended."""
    ACTIVE = auto()
    """A gesture is going on and nothing was done about it yet."""
    HANDLED = auto()
    """A gesture is going on and was answered."""


@dataclass(frozen=True, slots=True)
class Tracking:
    """What the tracker holds after a window.

    Attributes:
        phase: Where it stands.
        gesture: The gesture that is going on, or the candidate; ``idle`` if there is none.
    """

    phase: Phase
    gesture: str


class GestureTracker:
    """Turns a stream of probabilities into gestures that start and end.

    A gesture starts when it has been a candidate (the most probable, and over ``enter``) for
    ``enter_windows`` windows in a row, also while another one is going on, and ends after
    ``leave_windows`` windows below ``leave``. It then cannot start again for ``cooldown_s``.

    Args:
        settings: Thresholds and times.
        ungated: Gestures that no face has to confirm; they must be surer.
        enter_windows: Overrides the setting; the thesis's grid decides on one window.
    """

    def __init__(
        self,
        settings: DecideSettings,
        ungated: Collection[str] = (),
        enter_windows: int | None = None,
    ) -> None:
        self._settings = settings
        self._ungated = frozenset(ungated)
        self._enter_windows = enter_windows or settings.enter_windows
        self._leave_windows = min(settings.leave_windows, self._enter_windows)
        self._cooldown_ns = to_ns(settings.cooldown_s)
        self._active: str | None = None
        self._handled = False
        self._candidate: str | None = None
        self._streak = 0
        self._weak = 0
        self._cool_until: dict[str, int] = {}

    def push(self, classification: Classification, now_ns: int) -> Tracking:
        """Take the probabilities of the window that ends at ``now_ns``."""
        candidate = self._candidate_of(classification)
        self._streak = self._streak + 1 if candidate == self._candidate else 1
        self._candidate = candidate
        self._follow_active(classification, now_ns)
        cooling = candidate is not None and now_ns < self._cool_until.get(candidate, 0)
        if (
            candidate is not None
            and candidate != self._active
            and self._streak >= self._enter_windows
            and not cooling
        ):
            if self._active is not None:
                self._end(now_ns)
            self._active, self._handled, self._weak = candidate, False, 0
        if self._active is not None:
            return Tracking(Phase.HANDLED if self._handled else Phase.ACTIVE, self._active)
        if candidate is not None:
            return Tracking(Phase.COOLING_DOWN if cooling else Phase.UNSURE, candidate)
        return Tracking(Phase.IDLE if classification.best == IDLE else Phase.UNSURE, IDLE)

    def mark_handled(self) -> None:
        """Note that the gesture that is going on was answered."""
        self._handled = True

    def reset(self, now_ns: int) -> None:
        """The body has left: whatever was going on has ended."""
        if self._active is not None:
            self._end(now_ns)
        self._candidate, self._streak = None, 0

    def _candidate_of(self, classification: Classification) -> str | None:
        best = classification.best
        settings = self._settings
        enter = settings.enter_ungated if best in self._ungated else settings.enter
        if best == IDLE or float(classification.probabilities.max()) < enter:
            return None
        return best

    def _follow_active(self, classification: Classification, now_ns: int) -> None:
        if self._active is None:
            return
        level = classification.probabilities[classification.labels.index(self._active)]
        self._weak = self._weak + 1 if level < self._settings.leave else 0
        if self._weak >= self._leave_windows:
            self._end(now_ns)

    def _end(self, now_ns: int) -> None:
        if self._active is not None and self._handled:
            self._cool_until[self._active] = now_ns + self._cooldown_ns
        self._active, self._handled, self._weak = None, False, 0
