"""Long performances: one person does one thing after the other, without a cut."""

from dataclasses import dataclass

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.domain.gesture import IDLE
from agent_server.synthetic.body import BodyMotion
from agent_server.synthetic.clips import perform
from agent_server.synthetic.gestures import write_gesture
from agent_server.synthetic.idle import write_idle
from agent_server.synthetic.performance import Performance, Reach
from agent_server.synthetic.person import Person, Placement
from agent_server.synthetic.rest import sample_rest
from agent_server.synthetic.script import BOTH, Pen, Script

Rests = tuple[Reach, Reach]
CHUNK = 900
"""Instants that are computed at once; a long stream need not fit into memory as a whole."""
CALM = ("still", "look_about", "nod", "shift_weight")
"""Idle actions that nobody could take for a gesture."""


@dataclass(frozen=True, slots=True)
class Stretch:
    """A performance from 0 to ``duration_s``, as sensors want it."""

    performance: Performance
    duration_s: float

    def at(self, times_s: Float64) -> BodyMotion:
        """The clean body at ``times_s``, shape (T,), ascending."""
        parts = [
            self.performance.at(times_s[start : start + CHUNK])
            for start in range(0, len(times_s), CHUNK)
        ]
        return BodyMotion(
            times_s,
            *(
                np.concatenate([getattr(part, name) for part in parts])
                for name in ("joints", "chest", "head")
            ),
        )


class Timeline:
    """Writes what one person does, from the beginning on.

    Args:
        rng: Where all variation comes from.
        person: Who moves.
        placement: Where.
    """

    def __init__(self, rng: np.random.Generator, person: Person, placement: Placement) -> None:
        self._rng = rng
        self._person = person
        self._placement = placement
        self._first_rest = self._rest = sample_rest(rng, person, placement)
        self._scripts: list[Script] = []
        self.now_s = 0.0

    def act(self, gesture: str, variant: str | None = None, *, pause_s: float = 0.0) -> Script:
        """Adds a gesture, or an idle action, after a pause."""
        pen = self._pen(pause_s)
        if gesture == IDLE:
            return self._add(write_idle(pen, variant))
        return self._add(write_gesture(pen, gesture, variant))

    def idle_until(self, stop_s: float, *, calm: bool) -> None:
        """Fills the time with idle actions that end before ``stop_s``.

        Calm ones leave the hands alone. Otherwise all idle actions occur, hard negatives
        among them, and now and then the hands come to rest elsewhere.
        """
        while True:
            pause = float(self._rng.uniform(0.3, 1.5) if calm else self._rng.uniform(0.3, 3.5))
            state = self._rng.bit_generator.state
            if not calm and self._rng.random() < 0.12:
                script, rest = self._move_rest(pause)
            else:
                name = str(self._rng.choice(CALM)) if calm else None
                script, rest = write_idle(self._pen(pause), name), self._rest
            if script.offset_s > stop_s:
                self._rng.bit_generator.state = state
                self.now_s = stop_s
                return
            self._rest = rest
            self._add(script)

    def performance(self) -> Performance:
        """All that was written, as one motion."""
        return perform(
            self._rng, self._person, self._placement, self._first_rest, tuple(self._scripts)
        )

    def _pen(self, pause_s: float) -> Pen:
        start = self.now_s + pause_s
        return Pen(self._rng, self._person, self._placement, self._rest, start)

    def _add(self, script: Script) -> Script:
        self._scripts.append(script)
        self.now_s = script.offset_s
        return script

    def _move_rest(self, pause_s: float) -> tuple[Script, Rests]:
        rest = sample_rest(self._rng, self._person, self._placement)
        start = self.now_s + pause_s
        pen = Pen(self._rng, self._person, self._placement, self._rest, start)
        pen.settle(BOTH, rest)
        return pen.script(IDLE, "other_rest"), rest
