"""What clocks do: the body's sensor runs fast, or its time jumps. Arrivals stay as they are."""

from dataclasses import dataclass, replace

from numpy.random import Generator

from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.qa.faults.base import Arrival


@dataclass(frozen=True, slots=True)
class ClockDrift:
    """The clock of the body's sensor runs away from that of the face.

    Attributes:
        ppm: Parts in a million by which it is fast.
    """

    ppm: float

    @property
    def name(self) -> str:
        """What goes wrong."""
        return f"body's clock {self.ppm:g} ppm fast"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """Stretch the stamps."""
        del rng
        return [_moved(a, round(a.at_ns * self.ppm / 1e6)) for a in arrivals]


@dataclass(frozen=True, slots=True)
class ClockJump:
    """The clock of the body's sensor jumps, once, and stays there.

    Attributes:
        ms: How far; negative for back.
        at_s: When, in seconds of the recording.
    """

    ms: int
    at_s: float = 3.0

    @property
    def name(self) -> str:
        """What goes wrong."""
        return f"body's clock jumps {self.ms:+d} ms"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """Move the stamps from the jump on."""
        del rng
        start_ns = self.at_s * NS_PER_S
        return [_moved(a, self.ms * NS_PER_MS) if a.at_ns >= start_ns else a for a in arrivals]


def _moved(arrival: Arrival, by_ns: int) -> Arrival:
    value = arrival.value
    if not isinstance(value, SkeletonFrame):
        return arrival
    stamp_ns = max(value.originating_ns + by_ns, 0)
    return replace(arrival, value=replace(value, originating_ns=stamp_ns))
