"""What networks do: frames are lost, late, out of order, or come twice. Stamps stay right."""

from dataclasses import dataclass, replace

from numpy.random import Generator

from agent_server.domain.stamp import NS_PER_MS
from agent_server.qa.faults.base import Arrival


@dataclass(frozen=True, slots=True)
class Drop:
    """Skeletons are lost, each for itself.

    Attributes:
        share: Of them, in [0, 1].
    """

    share: float

    @property
    def name(self) -> str:
        """What goes wrong."""
        return f"{self.share:.0%} of the frames lost"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """Leave some out."""
        lost = rng.random(len(arrivals)) < self.share
        return [a for a, gone in zip(arrivals, lost, strict=True) if not (a.is_body and gone)]


@dataclass(frozen=True, slots=True)
class Delay:
    """Skeletons come late, all by the same time; faces do not.

    Attributes:
        ms: By how much.
    """

    ms: int

    @property
    def name(self) -> str:
        """What goes wrong."""
        return f"body {self.ms} ms late"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """Move the skeletons."""
        del rng
        return [
            replace(a, at_ns=a.at_ns + self.ms * NS_PER_MS) if a.is_body else a for a in arrivals
        ]


@dataclass(frozen=True, slots=True)
class Jitter:
    """Everything comes late by chance, but in order, as over TCP.

    Attributes:
        ms: Mean of the exponential delay.
    """

    ms: int

    @property
    def name(self) -> str:
        """What goes wrong."""
        return f"{self.ms} ms of jitter"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """Delay each; what overtakes waits."""
        delays = rng.exponential(self.ms * NS_PER_MS, len(arrivals))
        late, reached = [], 0
        for arrival, delay in zip(arrivals, delays.tolist(), strict=True):
            reached = max(reached, arrival.at_ns + round(delay))
            late.append(replace(arrival, at_ns=reached))
        return late


@dataclass(frozen=True, slots=True)
class Reorder:
    """Some inputs come after their successors, as over UDP.

    Attributes:
        share: Of them, in [0, 1].
        ms: How late these come.
    """

    share: float
    ms: int = 60

    @property
    def name(self) -> str:
        """What goes wrong."""
        return f"{self.share:.0%} come {self.ms} ms late, out of order"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """Move some back."""
        late = rng.random(len(arrivals)) < self.share
        return [
            replace(a, at_ns=a.at_ns + self.ms * NS_PER_MS) if is_late else a
            for a, is_late in zip(arrivals, late, strict=True)
        ]


@dataclass(frozen=True, slots=True)
class Duplicate:
    """Some inputs come twice.

    Attributes:
        share: Of them, in [0, 1].
        ms: How long after the first one the second comes.
    """

    share: float
    ms: int = 10

    @property
    def name(self) -> str:
        """What goes wrong."""
        return f"{self.share:.0%} come twice"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """Add the copies."""
        again = rng.random(len(arrivals)) < self.share
        copies = [
            replace(a, at_ns=a.at_ns + self.ms * NS_PER_MS)
            for a, twice in zip(arrivals, again, strict=True)
            if twice
        ]
        return [*arrivals, *copies]
