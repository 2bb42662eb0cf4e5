"""Learning rates."""

import math


def warm_cosine(step: int, steps: int, warm: int = 200) -> float:
    """Factor on the learning rate: up in ``warm`` steps, then down along a cosine to zero."""
    if step < warm:
        return (step + 1) / warm
    return 0.5 * (1 + math.cos(math.pi * (step - warm) / max(1, steps - warm)))
