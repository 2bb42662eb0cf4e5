"""What somebody does over time, as data: scripts on one time line, rendered at any instant."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.synthetic.body import BodyMotion, Controls, move_body
from agent_server.synthetic.person import Person, Placement
from agent_server.synthetic.trajectory import (
    ORIGIN,
    Drift,
    Move,
    Oscillation,
    Vector,
    blend,
    drift,
    oscillate,
    progress,
)

Frame = Literal["chest", "upright", "head", "pelvis"]
FRAMES: tuple[Frame, ...] = ("chest", "upright", "head", "pelvis")


@dataclass(frozen=True, slots=True)
class Reach:
    """A movement of one wrist to a place.

    Attributes:
        start_s: When it starts.
        duration_s: How long it takes.
        frame: What the place is tied to: ``chest`` and ``upright`` (the vertical) count from
            the neck's base, ``head`` from the middle of the head, ``pelvis`` from the pelvis.
        point: Metres outwards, up and back, for the reference stature.
        swivel_rad: How far the elbow is turned outwards about the line from shoulder to wrist:
            0 hangs below it, a quarter turn points sideways. See ``body.elbow_direction``.
        hand: Direction added to the forearm's for the fingers, in the chest frame.
        bow: Deviation of the path from the straight one in its middle, in the chest frame.
        late: How much more of the bow lies on the second half of the path (up to 1) than on the
            first half (down to -1); forearms swing ahead before they fold up.
        skew: Exponent on the relative time.
    """

    start_s: float
    duration_s: float
    frame: Frame
    point: Vector
    swivel_rad: float
    hand: Vector = ORIGIN
    bow: Vector = ORIGIN
    skew: float = 1.0
    late: float = 0.0

    @property
    def end_s(self) -> float:
        """When it ends."""
        return self.start_s + self.duration_s


@dataclass(frozen=True, slots=True)
class Track:
    """A value that moves, swings and trembles. See :mod:`trajectory`."""

    moves: tuple[Move, ...] = ()
    swings: tuple[Oscillation, ...] = ()

    def at(self, times_s: Float64) -> Float64:
        """Shape (T, 3)."""
        return blend(self.moves, times_s) + oscillate(self.swings, times_s)


@dataclass(frozen=True, slots=True)
class Arm:
    """Where one wrist goes; ``swings`` are in the chest frame, outwards, up and back."""

    reaches: tuple[Reach, ...]
    swings: tuple[Oscillation, ...] = ()


@dataclass(frozen=True, slots=True)
class Performance:
    """All that a body does on one time line.

    Attributes:
        person: Who.
        placement: Where.
        arms: Left and right; each begins with the place where the hand rests.
        trunk: Pitch, roll and yaw, in radians.
        head: Pitch, roll and yaw against the chest, in radians.
        pelvis: Metres right, up and back.
        feet: Left and right, metres outwards, up and back.
        involuntary: Drift of pelvis, trunk, head, left and right wrist.
        breath_hz: Breaths a second.
    """

    person: Person
    placement: Placement
    arms: tuple[Arm, Arm]
    trunk: Track
    head: Track
    pelvis: Track
    feet: tuple[Track, Track]
    involuntary: tuple[Drift, Drift, Drift, Drift, Drift]
    breath_hz: float

    def at(self, times_s: Float64) -> BodyMotion:
        """The clean body at ``times_s``, shape (T,), ascending."""
        pelvis, trunk, head, *wrists = (drift(one, times_s) for one in self.involuntary)
        trunk = trunk + self.trunk.at(times_s)
        trunk[:, 0] += 0.006 * np.sin(2 * np.pi * self.breath_hz * times_s)
        parts = [_arm(arm, wrist, times_s) for arm, wrist in zip(self.arms, wrists, strict=True)]
        points, weights, swivels, hands = (np.stack(part) for part in zip(*parts, strict=True))
        controls = Controls(
            pelvis=pelvis + self.pelvis.at(times_s),
            trunk=trunk,
            head=head + self.head.at(times_s),
            chest_points=points[:, 0],
            upright_points=points[:, 1],
            head_points=points[:, 2],
            pelvis_points=points[:, 3],
            weights=weights,
            swivels=swivels,
            hands=hands,
            feet=np.stack([foot.at(times_s) for foot in self.feet]),
        )
        return move_body(self.person, self.placement, controls, times_s)


def _arm(
    arm: Arm, involuntary: Float64, times_s: Float64
) -> tuple[Float64, Float64, Float64, Float64]:
    """Wrist parts (4, T, 3) a frame, weights (T, 4), elbow swivel (T,) and fingers (T, 3)."""
    reaches = _in_play(arm.reaches, times_s)
    shares = np.stack([progress(r.start_s, r.duration_s, r.skew, times_s) for r in reaches])
    shares[0] = 1.0
    held = shares.copy()
    held[:-1] -= shares[1:]
    points = np.array([r.point for r in reaches])
    parts = np.zeros((len(FRAMES), len(times_s), 3))
    weights = np.zeros((len(times_s), len(FRAMES)))
    for index, frame in enumerate(FRAMES):
        mine = [i for i, r in enumerate(reaches) if r.frame == frame]
        if mine:
            parts[index] = held[mine].T @ points[mine]
            weights[:, index] = held[mine].sum(axis=0)
    bows = np.array([r.bow for r in reaches])
    late = np.array([r.late for r in reaches])[:, None]
    parts[0] += (4 * shares * (1 - shares) * (1 + late * (2 * shares - 1))).T @ bows
    parts[0] += involuntary + oscillate(arm.swings, times_s)
    swivels = held.T @ np.array([r.swivel_rad for r in reaches])
    hands = held.T @ np.array([r.hand for r in reaches])
    return parts, weights, swivels, hands


def _in_play(reaches: tuple[Reach, ...], times_s: Float64) -> list[Reach]:
    """Drops what is over before the first instant or begins after the last one."""
    first, over = 0, -np.inf
    for index, reach in enumerate(reaches):
        over = max(over, reach.end_s)
        if over <= times_s[0]:
            first = index
    return [
        r for i, r in enumerate(reaches) if i == first or (i > first and r.start_s < times_s[-1])
    ]
