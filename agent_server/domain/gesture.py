"""Gestures (the thesis's Table 5.1) and the probabilities that a classifier gives them."""

from dataclasses import dataclass

from agent_server.domain.arrays import Float32

IDLE = "idle"
HELLO = "hello"
DISCOMFORTS: tuple[str, ...] = ("cold", "hot", "loud", "smell", "bright")
GESTURES: tuple[str, ...] = (*DISCOMFORTS, HELLO, IDLE)
"""The seven built-in gestures. A bundle's manifest may name others."""


@dataclass(frozen=True, slots=True)
class Spread:
    """How far the futures of one window disagree.

    Attributes:
        futures: How many were classified, the forecast among them.
        left_out: How many were drawn and left out for their quality.
        deviations: Shape (C,), read-only: standard deviation of each class's probability.
    """

    futures: int
    left_out: int
    deviations: Float32


@dataclass(frozen=True, slots=True)
class Classification:
    """What the classifier makes of a window and its forecast, or of several futures on average.

    Attributes:
        labels: One name a class.
        probabilities: Shape (C,), read-only, sum 1.
        spread: How far several futures disagree, or None where there is the forecast alone.
    """

    labels: tuple[str, ...]
    probabilities: Float32
    spread: Spread | None = None

    @property
    def best(self) -> str:
        """The most probable label."""
        return self.labels[int(self.probabilities.argmax())]
