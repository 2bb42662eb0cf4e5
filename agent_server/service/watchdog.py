"""A thread that looks whether the event loop and the models get on, and says so when not.

A stuck loop cannot say so itself. The server is not ready while something is stuck, and for a
moment after: whoever looks after it can send new sessions elsewhere, or start it anew.
"""

import logging
import sys
import threading
import time
import traceback
from collections.abc import Callable

log = logging.getLogger(__name__)

RECOVERY_S = 5.0
"""After a stall the server is ready again when there was none for this long."""
LOOKS = 4
"""How often it looks while something would come to count as stuck."""


class Watchdog:
    """Watches one event loop and one inference thread.

    Args:
        stuck_s: For how long something must not get on to count as stuck.
        busy_s: Since when, on ``time.monotonic``, the models have been at their present batch;
            None while they are idle.

    Attributes:
        loop_stalls: How often the loop was stuck.
        inference_stalls: How often the models were.
    """

    def __init__(self, stuck_s: float, busy_s: Callable[[], float | None]) -> None:
        self._stuck_s = stuck_s
        self._busy_s = busy_s
        self._beat_s = time.monotonic()
        self._well_from_s = 0.0
        self._stop = threading.Event()
        self._loop_thread = threading.get_ident()
        self._thread = threading.Thread(target=self._watch, name="watchdog", daemon=True)
        self.loop_stalls = 0
        self.inference_stalls = 0

    def start(self) -> None:
        """Begin, called from the loop's thread."""
        self._loop_thread = threading.get_ident()
        self.beat()
        self._thread.start()

    def stop(self) -> None:
        """End; nothing is looked at any more."""
        self._stop.set()

    def beat(self) -> None:
        """The loop is alive."""
        self._beat_s = time.monotonic()

    @property
    def is_well(self) -> bool:
        """Whether nothing is stuck, nor was a moment ago."""
        return time.monotonic() >= self._well_from_s

    def _watch(self) -> None:
        is_loop_stuck = is_inference_stuck = False
        while not self._stop.wait(self._stuck_s / LOOKS):
            now_s = time.monotonic()
            silent_s = now_s - self._beat_s
            if silent_s > self._stuck_s and not is_loop_stuck:
                self.loop_stalls += 1
                log.error("the event loop is stuck for %.1f s at:\n%s", silent_s, self._place())
            elif is_loop_stuck and silent_s <= self._stuck_s:
                log.warning("the event loop goes on")
            is_loop_stuck = silent_s > self._stuck_s
            began_s = self._busy_s()
            busy_s = 0.0 if began_s is None else now_s - began_s
            if busy_s > self._stuck_s and not is_inference_stuck:
                self.inference_stalls += 1
                log.error("the models are at one batch for %.1f s; sessions wait", busy_s)
            elif is_inference_stuck and busy_s <= self._stuck_s:
                log.warning("the models go on")
            is_inference_stuck = busy_s > self._stuck_s
            if is_loop_stuck or is_inference_stuck:
                self._well_from_s = now_s + RECOVERY_S

    def _place(self) -> str:
        """Where the loop's thread is."""
        frame = sys._current_frames().get(self._loop_thread)
        return "".join(traceback.format_stack(frame)) if frame is not None else "nowhere"
