"""Everything that is not a gesture, above all what looks like one for a moment."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from agent_server.domain.gesture import IDLE
from agent_server.errors import InvalidInput
from agent_server.synthetic.armwork import ARMWORK
from agent_server.synthetic.everyday import EVERYDAY
from agent_server.synthetic.locomotion import LOCOMOTION
from agent_server.synthetic.script import Pen, Script, Writer

ACTIONS: Mapping[str, tuple[float, Writer]] = MappingProxyType(
    {**EVERYDAY, **LOCOMOTION, **ARMWORK}
)
"""Action -> (how often, what writes it)."""

ON_FOOT = frozenset({"walk", "jog", "duck", "kick", "lunge", "jump", "bow"})
"""Actions that nobody does seated."""


def write_idle(pen: Pen, variant: str | None = None) -> Script:
    """Writes an idle action; without ``variant`` one that fits the posture is drawn.

    Raises:
        InvalidInput: If there is no such action.
    """
    if variant is None:
        names = [n for n in ACTIONS if not (pen.placement.seated and n in ON_FOOT)]
        weights = np.array([ACTIONS[name][0] for name in names])
        variant = str(pen.rng.choice(names, p=weights / weights.sum()))
    if variant not in ACTIONS:
        raise InvalidInput(
            f"variant is '{variant}', expected one of {', '.join(ACTIONS)} for '{IDLE}'",
            field="variant",
        )
    ACTIONS[variant][1](pen)
    return pen.script(IDLE, variant)
