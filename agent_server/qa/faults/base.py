"""What a fault is."""

from dataclasses import dataclass
from typing import Protocol

from numpy.random import Generator

from agent_server.domain.affect import AffectSample
from agent_server.domain.face import FaceBlendshapes, FaceLandmarks
from agent_server.domain.inputs import SensorInput
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.skeleton import SkeletonFrame

Face = FaceLandmarks | FaceBlendshapes | AffectSample


@dataclass(frozen=True, slots=True)
class Arrival:
    """An input and when it comes in.

    Attributes:
        at_ns: On the undisturbed time line of the recording; without a fault its capture.
        value: The input; its own stamp is what the sensor's clock said.
    """

    at_ns: int
    value: SensorInput | ObjectChanged

    @property
    def is_body(self) -> bool:
        """Whether it is a skeleton."""
        return isinstance(self.value, SkeletonFrame)

    @property
    def is_face(self) -> bool:
        """Whether it tells how the face looks."""
        return isinstance(self.value, Face)


class Fault(Protocol):
    """Something that goes wrong; the same generator gives the same fault."""

    @property
    def name(self) -> str:
        """What goes wrong and how much, for a table."""
        ...

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """What comes in instead.

        Args:
            arrivals: Inputs in the order in which they come in.
            rng: All chance comes from it.

        Returns:
            What comes in then; whoever plays it sorts it by arrival.
        """
        ...


class NoFault:
    """Nothing goes wrong: what a table of faults is compared with."""

    name = "none"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """The same."""
        del rng
        return arrivals
