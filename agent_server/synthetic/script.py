"""Writes scripts: the movements of arms, trunk, head and feet that make up one action."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from agent_server.synthetic.performance import Frame, Reach
from agent_server.synthetic.person import Person, Placement
from agent_server.synthetic.trajectory import ORIGIN, Move, Oscillation, Vector

LEFT, RIGHT = 0, 1
Hands = tuple[int, ...]
BOTH: Hands = (LEFT, RIGHT)


@dataclass(frozen=True, slots=True)
class Script:
    """One action from rest to rest.

    Attributes:
        gesture: Its label.
        variant: Which way of doing it.
        onset_s: When the first movement starts.
        offset_s: When the body is back at rest.
        reaches: Of the left and the right wrist, in order.
        swings: Of the left and the right wrist.
        trunk: Pitch, roll and yaw, ending at 0.
        trunk_swings: The same, as oscillations.
        head: Pitch, roll and yaw, ending at 0.
        head_swings: The same, as oscillations.
        pelvis: Metres right, up and back.
        pelvis_swings: The same, as oscillations.
        feet: Metres outwards, up and back of the left and the right foot.
    """

    gesture: str
    variant: str
    onset_s: float
    offset_s: float
    reaches: tuple[tuple[Reach, ...], tuple[Reach, ...]]
    swings: tuple[tuple[Oscillation, ...], tuple[Oscillation, ...]]
    trunk: tuple[Move, ...]
    trunk_swings: tuple[Oscillation, ...]
    head: tuple[Move, ...]
    head_swings: tuple[Oscillation, ...]
    pelvis: tuple[Move, ...]
    pelvis_swings: tuple[Oscillation, ...]
    feet: tuple[tuple[Move, ...], tuple[Move, ...]]


class Pen:
    """Collects the movements of one action. It is thrown away once the script is written.

    Args:
        rng: Where the variation comes from.
        person: Who moves.
        placement: How they stand or sit.
        rest: Where the left and the right hand rest.
        start_s: When the action starts.
    """

    def __init__(
        self,
        rng: np.random.Generator,
        person: Person,
        placement: Placement,
        rest: tuple[Reach, Reach],
        start_s: float,
    ) -> None:
        self.rng = rng
        self.person = person
        self.placement = placement
        self.rest = rest
        self.start_s = start_s
        self.main = LEFT if (person.handedness == "left") != (rng.random() < 0.12) else RIGHT
        self._reaches: tuple[list[Reach], list[Reach]] = ([], [])
        self._swings: tuple[list[Oscillation], list[Oscillation]] = ([], [])
        self._turns: dict[str, list[Move]] = {"trunk": [], "head": [], "pelvis": []}
        self._sways: dict[str, list[Oscillation]] = {"trunk": [], "head": [], "pelvis": []}
        self._feet: tuple[list[Move], list[Move]] = ([], [])
        delay = rng.normal(0, 0.5 * person.asymmetry_s + 0.03)
        self._delay = (max(0.0, delay), max(0.0, -delay))

    # ------------------------------------------------------------------ drawing numbers

    def chance(self, probability: float) -> bool:
        """True with ``probability``."""
        return bool(self.rng.random() < probability)

    def uniform(self, low: float, high: float) -> float:
        """A number between both."""
        return float(self.rng.uniform(low, high))

    def around(self, centre: Vector, spread: Vector | float) -> Vector:
        """A point around ``centre``; ``spread`` is the standard deviation an axis."""
        offset = np.clip(self.rng.standard_normal(3), -2.0, 2.0) * spread
        x, y, z = np.asarray(centre) + offset
        return float(x), float(y), float(z)

    def seconds(self, median: float, spread: float = 0.22) -> float:
        """A duration of this person, log-normal around ``median``."""
        drawn = median * np.exp(np.clip(self.rng.normal(0, spread), -2 * spread, 2 * spread))
        return float(drawn / self.person.tempo)

    def hold(self) -> float:
        """How long a gesture is held: 0.6 to 4 s, mostly 1 to 2."""
        return float(np.clip(np.exp(self.rng.normal(np.log(1.4), 0.5)), 0.6, 4.0))

    # ------------------------------------------------------------------ hands

    def reach(
        self,
        side: int,
        start_s: float,
        duration_s: float,
        frame: Frame,
        point: Vector,
        pole: Vector,
        *,
        hand: Vector = ORIGIN,
        bow: Vector = ORIGIN,
    ) -> float:
        """Moves one wrist; returns when it arrives."""
        skew = float(np.clip(self.rng.normal(1.0, 0.12), 0.8, 1.3))
        reach = Reach(start_s, duration_s, frame, point, pole, hand, bow, skew)
        self._reaches[side].append(reach)
        return reach.end_s

    def raise_to(
        self,
        hands: Hands,
        frame: Frame,
        place: Callable[[int], tuple[Vector, Vector, Vector]],
        *,
        median_s: float = 0.85,
        start_s: float | None = None,
    ) -> float:
        """Brings hands from rest to where ``place(side)`` (point, pole, fingers) says.

        Now and then the hand hesitates on the way, or falls short and corrects itself.
        Returns when the last hand has arrived.
        """
        start = self.start_s if start_s is None else start_s
        duration = self.seconds(median_s)
        arrival = start
        for side in hands:
            point, pole, fingers = place(side)
            begin = start + (self._delay[side] if len(hands) > 1 else 0.0)
            mine = duration * self.uniform(0.93, 1.07)
            bow = self.around((0.05, 0.0, -0.09), (0.04, 0.03, 0.04))
            if self.chance(0.08):
                x, y, z = self.around((0.12, -0.28, -0.25), 0.05)
                stop = self.reach(side, begin, 0.7 * mine, "chest", (x, y, z), pole, bow=bow)
                begin = stop + self.uniform(-0.1, 0.3)
                mine *= 0.7
                bow = ORIGIN
            if self.chance(0.25):
                short = self.around(point, (0.02, 0.035, 0.02))
                stop = self.reach(side, begin, mine, frame, short, pole, hand=fingers, bow=bow)
                begin, mine = stop - 0.15 * mine, self.uniform(0.25, 0.4)
                bow = ORIGIN
            end = self.reach(side, begin, mine, frame, point, pole, hand=fingers, bow=bow)
            arrival = max(arrival, end)
        return arrival

    def bring(
        self,
        hands: Hands,
        frame: Frame,
        centre: Vector,
        spread: Vector | float,
        *,
        pole: Vector | None = None,
        fingers: Vector = ORIGIN,
        median_s: float = 0.85,
        start_s: float | None = None,
    ) -> float:
        """Brings hands near ``centre``, both to much the same place; returns the arrival."""
        shared = self.around(centre, spread)
        elbow = self.around(natural_pole(shared) if pole is None else pole, 0.15)

        def place(_: int) -> tuple[Vector, Vector, Vector]:
            return self.around(shared, 0.012), self.around(elbow, 0.05), self.around(fingers, 0.1)

        return self.raise_to(hands, frame, place, median_s=median_s, start_s=start_s)

    def lower(self, hands: Hands, start_s: float, *, median_s: float = 0.9) -> float:
        """Brings hands back to rest; returns when the last one is there."""
        duration = self.seconds(median_s)
        end = start_s
        for side in hands:
            rest = self.rest[side]
            begin = start_s + (self._delay[1 - side] if len(hands) > 1 else 0.0)
            mine = duration * self.uniform(0.9, 1.1)
            bow = self.around((0.04, 0.0, -0.07), 0.03)
            arrival = self.reach(
                side, begin, mine, rest.frame, rest.point, rest.pole, hand=rest.hand, bow=bow
            )
            end = max(end, arrival)
        return end

    def swing(
        self,
        side: int,
        start_s: float,
        stop_s: float,
        along: Vector,
        frequency_hz: float,
        *,
        across: Vector = ORIGIN,
        phase_rad: float = 0.0,
        ramp_s: float = 0.25,
        unevenness: float | None = None,
    ) -> None:
        """Lets one wrist swing about where it is, in the chest frame."""
        uneven = self.uniform(0.0, 0.35) if unevenness is None else unevenness
        ramp = min(ramp_s, 0.45 * (stop_s - start_s))
        self._swings[side].append(
            Oscillation(start_s, stop_s, ramp, along, across, frequency_hz, phase_rad, uneven)
        )

    # ------------------------------------------------------------------ the rest of the body

    def turn(self, part: str, start_s: float, duration_s: float, value: Vector) -> float:
        """Moves ``trunk``, ``head`` or ``pelvis``; returns when it has got there."""
        move = Move(start_s, duration_s, value)
        self._turns[part].append(move)
        return move.end_s

    def turn_and_back(
        self, part: str, start_s: float, stop_s: float, value: Vector, *, share: float = 0.35
    ) -> None:
        """Moves a part away at ``start_s`` and has it back at ``stop_s``."""
        duration = share * (stop_s - start_s)
        self.turn(part, start_s, duration, value)
        self.turn(part, stop_s - duration, duration, ORIGIN)

    def sway(
        self,
        part: str,
        start_s: float,
        stop_s: float,
        along: Vector,
        frequency_hz: float,
        *,
        across: Vector = ORIGIN,
        phase_rad: float = 0.0,
    ) -> None:
        """Lets ``trunk``, ``head`` or ``pelvis`` swing."""
        ramp = min(0.35, 0.4 * (stop_s - start_s))
        self._sways[part].append(
            Oscillation(start_s, stop_s, ramp, along, across, frequency_hz, phase_rad, 0.15)
        )

    def step(self, side: int, start_s: float, duration_s: float, value: Vector) -> float:
        """Moves a foot, metres outwards, up and back; returns when it is there."""
        move = Move(start_s, duration_s, value)
        self._feet[side].append(move)
        return move.end_s

    def script(self, gesture: str, variant: str) -> Script:
        """What has been written; the offset is the end of the last movement of a hand or part."""
        ends = [r.end_s for side in self._reaches for r in side]
        ends += [m.end_s for moves in self._turns.values() for m in moves]
        ends += [m.end_s for side in self._feet for m in side]
        starts = [r.start_s for side in self._reaches for r in side]
        starts += [m.start_s for moves in self._turns.values() for m in moves]
        starts += [m.start_s for side in self._feet for m in side]
        return Script(
            gesture=gesture,
            variant=variant,
            onset_s=min(starts, default=self.start_s),
            offset_s=max(ends, default=self.start_s),
            reaches=(tuple(self._reaches[LEFT]), tuple(self._reaches[RIGHT])),
            swings=(tuple(self._swings[LEFT]), tuple(self._swings[RIGHT])),
            trunk=tuple(self._turns["trunk"]),
            trunk_swings=tuple(self._sways["trunk"]),
            head=tuple(self._turns["head"]),
            head_swings=tuple(self._sways["head"]),
            pelvis=tuple(self._turns["pelvis"]),
            pelvis_swings=tuple(self._sways["pelvis"]),
            feet=(tuple(self._feet[LEFT]), tuple(self._feet[RIGHT])),
        )


def degrees(pitch: float, roll: float, yaw: float) -> Vector:
    """Three angles in radians."""
    p, r, y = np.radians((pitch, roll, yaw))
    return float(p), float(r), float(y)


def natural_pole(point: Vector) -> Vector:
    """Where the elbow points of its own accord when the wrist is at ``point``.

    It hangs below a hand in front of the body and turns outwards as the hand goes up.
    """
    high = float(np.clip((point[1] + 0.2) / 0.6, 0.0, 1.0))
    return 0.45 + 0.6 * high, -0.8 + 0.6 * high, 0.45 - 0.35 * high


Writer = Callable[[Pen], None]
"""Writes the movements of one action with a pen."""
