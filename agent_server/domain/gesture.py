"""Gestures (the thesis's Table 5.1) and the probabilities that a classifier gives them."""

from dataclasses import dataclass

from agent_server.domain.arrays import Float32

IDLE = "idle"
HELLO = "hello"
DISCOMFORTS: tuple[str, ...] = ("cold", "hot", "loud", "smell", "bright")
GESTURES: tuple[str, ...] = (*DISCOMFORTS, HELLO, IDLE)
"""The seven built-in gestures. A bundle's manifest may name others."""


@dataclass(frozen=True, slots=True)
class Classification:
    """What the classifier makes of a window and its forecast.

    Attributes:
        labels: One name a class.
        probabilities: Shape (C,), read-only, sum 1.
    """

    labels: tuple[str, ...]
    probabilities: Float32

    @property
    def best(self) -> str:
        """The most probable label."""
        return self.labels[int(self.probabilities.argmax())]
