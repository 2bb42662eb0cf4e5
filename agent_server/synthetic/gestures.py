"""The six gestures of the thesis's Table 5.1, in all the ways in which people do them."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from agent_server.errors import InvalidInput
from agent_server.synthetic.covering import COVERING
from agent_server.synthetic.repeating import REPEATING
from agent_server.synthetic.script import Pen, Script, Writer
from agent_server.synthetic.waving import WAVING

VARIANTS: Mapping[str, Mapping[str, tuple[float, Writer]]] = MappingProxyType(
    {**COVERING, **REPEATING, **WAVING}
)
"""Gesture -> variant -> (how often, what writes it)."""


def write_gesture(pen: Pen, gesture: str, variant: str | None = None) -> Script:
    """Writes one of the six gestures; without ``variant`` one is drawn.

    Raises:
        InvalidInput: If there is no such gesture or variant.
    """
    if gesture not in VARIANTS:
        raise InvalidInput(
            f"gesture is '{gesture}', expected one of {', '.join(VARIANTS)}", field="gesture"
        )
    ways = VARIANTS[gesture]
    if variant is None:
        weights = np.array([weight for weight, _ in ways.values()])
        variant = str(pen.rng.choice(list(ways), p=weights / weights.sum()))
    if variant not in ways:
        raise InvalidInput(
            f"variant is '{variant}', expected one of {', '.join(ways)} for '{gesture}'",
            field="variant",
        )
    ways[variant][1](pen)
    return pen.script(gesture, variant)
