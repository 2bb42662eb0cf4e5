"""What sensors do: noise, hidden joints, another rate, no face, somebody else in the picture."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from agent_server.domain.arrays import Float32, frozen
from agent_server.domain.skeleton import CoreJoint, SkeletonFrame
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.qa.faults.base import Arrival
from agent_server.skeleton.formats import get_format


@dataclass(frozen=True, slots=True)
class Noise:
    """Every coordinate of every joint is off by chance.

    Attributes:
        mm: Standard deviation.
    """

    mm: float

    @property
    def name(self) -> str:
        """What goes wrong."""
        return f"{self.mm:g} mm of noise on each coordinate"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """Shake the joints."""

        def shake(frame: SkeletonFrame, joints: Float32) -> None:
            unit_m = get_format(frame.format).unit_m
            joints[:, :3] += rng.normal(0, self.mm / 1000 / unit_m, joints[:, :3].shape)

        return [_changed(arrival, shake) for arrival in arrivals]


@dataclass(frozen=True, slots=True)
class Occlusion:
    """A joint is hidden for a while, again and again.

    Attributes:
        joint: Which of the nine core joints.
        hidden_s: How long it is hidden ...
        every_s: ... in each stretch of this length, at a time of chance.
    """

    joint: CoreJoint = CoreJoint.RIGHT_WRIST
    hidden_s: float = 1.0
    every_s: float = 3.0

    @property
    def name(self) -> str:
        """What goes wrong."""
        joint = self.joint.name.lower().replace("_", " ")
        return f"{joint} hidden {self.hidden_s:g} s in {self.every_s:g} s"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """Take the confidence of the joint away."""
        spans = _spans(arrivals, rng, self.hidden_s, self.every_s)

        def hide(frame: SkeletonFrame, joints: Float32) -> None:
            table = get_format(frame.format)
            for name, _ in table.core[self.joint]:
                joints[table.names.index(name), 3] = 0.0

        return [_changed(a, hide) if _lies_in(a.at_ns, spans) else a for a in arrivals]


@dataclass(frozen=True, slots=True)
class FrameRate:
    """The body's sensor gives fewer frames.

    Attributes:
        hz: Frames a second of each body, at most.
    """

    hz: float

    @property
    def name(self) -> str:
        """What goes wrong."""
        return f"body at {self.hz:g} Hz"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """Keep the first frame of each period."""
        del rng
        seen: dict[int, int] = {}
        kept = []
        for arrival in arrivals:
            if isinstance(arrival.value, SkeletonFrame):
                period = int(arrival.at_ns * self.hz / NS_PER_S)
                if seen.get(arrival.value.body_id) == period:
                    continue
                seen[arrival.value.body_id] = period
            kept.append(arrival)
        return kept


@dataclass(frozen=True, slots=True)
class FaceLoss:
    """The face is not found for a while, again and again.

    Attributes:
        lost_s: How long it is lost ...
        every_s: ... in each stretch of this length, at a time of chance.
    """

    lost_s: float = 2.0
    every_s: float = 4.0

    @property
    def name(self) -> str:
        """What goes wrong."""
        return f"face lost {self.lost_s:g} s in {self.every_s:g} s"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """Leave the faces out."""
        spans = _spans(arrivals, rng, self.lost_s, self.every_s)
        return [a for a in arrivals if not (a.is_face and _lies_in(a.at_ns, spans))]


@dataclass(frozen=True, slots=True)
class SecondBody:
    """Somebody else does the same a while later, beside the person and farther away.

    Attributes:
        lag_ms: How much later.
        aside_m: How far beside.
        behind_m: How far behind.
    """

    lag_ms: int = 1500
    aside_m: float = 0.8
    behind_m: float = 0.6

    @property
    def name(self) -> str:
        """What goes wrong."""
        return f"a second body {self.behind_m:g} m behind"

    def apply(self, arrivals: list[Arrival], rng: Generator) -> list[Arrival]:
        """Add the other one's frames."""
        del rng
        by_ns = self.lag_ms * NS_PER_MS
        taken = [a.value.body_id for a in arrivals if isinstance(a.value, SkeletonFrame)]
        other_id = max(taken, default=0) + 1
        others = []
        for arrival in arrivals:
            if not isinstance(arrival.value, SkeletonFrame):
                continue
            frame = arrival.value
            table = get_format(frame.format)
            joints = frame.joints.copy()
            joints[:, 0] += self.aside_m / table.unit_m
            joints[:, 2] += self.behind_m / table.unit_m
            moved = SkeletonFrame(
                frame.originating_ns + by_ns, other_id, frame.format, frozen(joints, (None, 4))
            )
            others.append(Arrival(arrival.at_ns + by_ns, moved))
        return [*arrivals, *others]


def _changed(arrival: Arrival, change: Callable[[SkeletonFrame, Float32], None]) -> Arrival:
    """An arrival whose joints, if it has any, were changed in place on a copy."""
    frame = arrival.value
    if not isinstance(frame, SkeletonFrame):
        return arrival
    joints = frame.joints.copy()
    change(frame, joints)
    return replace(arrival, value=replace(frame, joints=frozen(joints, (None, 4))))


def _spans(
    arrivals: list[Arrival], rng: Generator, length_s: float, every_s: float
) -> list[tuple[float, float]]:
    """One stretch a period, in ns."""
    end_ns = max((arrival.at_ns for arrival in arrivals), default=0)
    periods = np.arange(0, end_ns, every_s * NS_PER_S)
    starts = periods + rng.uniform(0, every_s - length_s, len(periods)) * NS_PER_S
    return [(start, start + length_s * NS_PER_S) for start in starts.tolist()]


def _lies_in(at_ns: int, spans: list[tuple[float, float]]) -> bool:
    return any(start <= at_ns < end for start, end in spans)
