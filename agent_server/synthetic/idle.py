"""Everything that is not a gesture, above all what looks like one for a moment."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from agent_server.domain.gesture import IDLE
from agent_server.synthetic.script import Pen, Script, degrees

Writer = Callable[[Pen], None]


def _still(pen: Pen) -> None:
    end = pen.start_s + pen.uniform(2.5, 5.0)
    if pen.chance(0.6):
        look = degrees(pen.rng.normal(0, 8), pen.rng.normal(0, 3), pen.rng.normal(0, 25))
        pen.turn_and_back("head", pen.start_s, end, look, share=0.25)


ACTIONS: Mapping[str, tuple[float, Writer]] = MappingProxyType({"still": (1.0, _still)})


def write_idle(pen: Pen, variant: str | None = None) -> Script:
    weights = np.array([weight for weight, _ in ACTIONS.values()])
    if variant is None:
        variant = str(pen.rng.choice(list(ACTIONS), p=weights / weights.sum()))
    ACTIONS[variant][1](pen)
    return pen.script(IDLE, variant)
