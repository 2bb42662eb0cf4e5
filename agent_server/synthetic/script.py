"""Writes scripts: the movements of arms, trunk, head and feet that make up one action."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike

from agent_server.synthetic.paths import detour, from_neck, natural_swivel
from agent_server.synthetic.performance import Frame, Reach
from agent_server.synthetic.person import Person, Placement
from agent_server.synthetic.trajectory import ORIGIN, Move, Oscillation, Vector

LEFT, RIGHT = 0, 1
Hands = tuple[int, ...]
BOTH: Hands = (LEFT, RIGHT)
HOMEWARDS: Vector = (0.07, 0.0, -0.13)
"""How far the way back to rest typically swings out."""
SECONDS_PER_METRE = 0.36
"""Nobody moves a hand faster: a minimum-jerk peak of 1.875 / 0.36 = 5.2 m/s."""
LOOSE_SHARE = 0.15
"""How often both hands do not move as one: people's hands mostly start within 40 ms."""


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
        self.pace = person.tempo * float(np.exp(np.clip(rng.normal(0, 0.15), -0.3, 0.3)))
        loose = 4.0 if rng.random() < LOOSE_SHARE else 1.0
        delay = loose * rng.normal(0, 0.3 * person.asymmetry_s + 0.012)
        self._delay = (max(0.0, delay), max(0.0, -delay))

    # ------------------------------------------------------------------ drawing numbers

    def chance(self, probability: float) -> bool:
        """True with ``probability``."""
        return bool(self.rng.random() < probability)

    def uniform(self, low: float, high: float) -> float:
        """A number between both."""
        return float(self.rng.uniform(low, high))

    def around(self, centre: ArrayLike, spread: Vector | float) -> Vector:
        """A point around ``centre``; ``spread`` is the standard deviation an axis."""
        offset = np.clip(self.rng.standard_normal(3), -2.0, 2.0) * spread
        x, y, z = np.asarray(centre) + offset
        return float(x), float(y), float(z)

    def seconds(self, median: float, spread: float = 0.25) -> float:
        """A duration of this person, log-normal around ``median``."""
        drawn = median * np.exp(np.clip(self.rng.normal(0, spread), -2 * spread, 2 * spread))
        return float(drawn / self.pace)

    def hold(self) -> float:
        """How long a gesture is held: 0.6 to 4 s, mostly 1 to 2."""
        return float(np.clip(np.exp(self.rng.normal(np.log(1.3), 0.5)), 0.6, 4.0))

    # ------------------------------------------------------------------ hands

    def reach(
        self,
        side: int,
        start_s: float,
        duration_s: float,
        frame: Frame,
        point: Vector,
        swivel: float | None = None,
        *,
        hand: Vector = ORIGIN,
        bow: Vector = ORIGIN,
        late: float = 0.0,
    ) -> float:
        """Moves one wrist; returns when it arrives.

        Args:
            side: ``LEFT`` or ``RIGHT``.
            start_s: When it starts.
            duration_s: How long it takes; longer if the way is too long for that.
            frame: What the place is tied to, see ``performance.Reach``.
            point: Metres outwards, up and back.
            swivel: Degrees by which the elbow is turned outwards; None lets it hang naturally.
            hand: Direction of the fingers beside the forearm's.
            bow: How far the path swings out, in the chest frame.
            late: Whether it does so on its second half, see ``performance.Reach``.
        """
        before = self._reaches[side][-1] if self._reaches[side] else self.rest[side]
        here, there = from_neck(before.frame, before.point), from_neck(frame, point)
        bow = detour(here, there, bow)
        way = float(np.linalg.norm(there - here) + np.linalg.norm(bow))
        duration_s = max(duration_s, way * SECONDS_PER_METRE)
        turned = natural_swivel(frame, point) if swivel is None else swivel
        turned += float(np.clip(self.rng.normal(0, 4), -8, 8))
        skew = float(np.clip(self.rng.normal(1.0, 0.12), 0.8, 1.3))
        swivel_rad = float(np.radians(turned))
        reach = Reach(start_s, duration_s, frame, point, swivel_rad, hand, bow, skew, late)
        self._reaches[side].append(reach)
        return reach.end_s

    def bring(
        self,
        hands: Hands,
        frame: Frame,
        centre: Vector,
        spread: Vector | float,
        swivel: tuple[float, float] | None = None,
        *,
        fingers: Vector = ORIGIN,
        median_s: float = 0.85,
        start_s: float | None = None,
        bow: Vector = (0.07, 0.0, -0.11),
        apart: Mapping[int, Vector] = MappingProxyType({}),
    ) -> float:
        """Brings hands to much the same place on both sides; returns when the last is there.

        Now and then a hand hesitates on the way, or falls short and corrects itself.

        Args:
            hands: Which ones.
            frame: What the place is tied to.
            centre: Mean place, metres outwards, up and back.
            spread: Its standard deviation.
            swivel: Mean and standard deviation of the elbows' turn, in degrees.
            fingers: Direction of the fingers beside the forearm's.
            median_s: Typical duration.
            start_s: When it starts; the action's start if None.
            bow: How far the path typically swings out.
            apart: What one side adds to the common place.
        """
        shared = self.around(centre, spread)
        mean = natural_swivel(frame, shared) if swivel is None else swivel[0]
        turned = float(np.clip(self.rng.normal(mean, swivel[1] if swivel else 8.0), -30, 130))
        path = self.around(bow, (0.05 + 0.3 * bow[0], 0.04, 0.06))
        start = self.start_s if start_s is None else start_s
        duration = self.seconds(median_s)
        arrival = start
        late = float(np.clip(self.rng.normal(0.6, 0.4), -0.4, 1.0))
        pause = self.around((0.14, -0.28, -0.27), 0.05) if self.chance(0.07) else None
        stay = self.uniform(-0.1, 0.3)
        for side in hands:
            point = self.around(np.add(shared, apart.get(side, ORIGIN)), 0.012)
            hand = self.around(fingers, 0.12)
            curve = self.around(path, 0.015)
            begin = start + (self._delay[side] if len(hands) > 1 else 0.0)
            mine = duration * self.uniform(0.98, 1.02)
            if pause is not None:
                stop = self.reach(side, begin, 0.7 * mine, "chest", pause, bow=curve)
                begin = stop + stay
                mine *= 0.7
                curve = ORIGIN
            if self.chance(0.25):
                short = self.around(point, (0.02, 0.035, 0.02))
                stop = self.reach(
                    side, begin, mine, frame, short, turned, hand=hand, bow=curve, late=late
                )
                begin, mine = stop - 0.15 * mine, self.uniform(0.25, 0.4)
                curve = ORIGIN
            end = self.reach(
                side, begin, mine, frame, point, turned, hand=hand, bow=curve, late=late
            )
            arrival = max(arrival, end)
        return arrival

    def through(
        self, hands: Hands, spots: Sequence[Vector], median_s: float, *, spread: float = 0.05
    ) -> float:
        """Leads hands through places of the chest frame without stopping; returns the end."""
        at = end = self.start_s
        duration = self.seconds(median_s)
        for spot in spots:
            shared = self.around(spot, spread)
            end = at
            for side in hands:
                own = self.around(shared, 0.02)
                bow = self.around(ORIGIN, 0.03)
                end = max(end, self.reach(side, at, duration, "chest", own, bow=bow))
            at += 0.85 * (end - at)
        return end

    def lower(
        self, hands: Hands, start_s: float, *, median_s: float = 0.85, bow: Vector = HOMEWARDS
    ) -> float:
        """Brings hands back to rest; returns when the last one is there.

        Args:
            hands: Which ones.
            start_s: When they set out.
            median_s: Typical duration.
            bow: How far the path typically swings out.
        """
        return self._rest_at(hands, self.rest, start_s, self.seconds(median_s), bow)

    def settle(self, hands: Hands, rest: tuple[Reach, Reach]) -> float:
        """Lets hands come to rest elsewhere; returns when the last one is there."""
        return self._rest_at(hands, rest, self.start_s, self.seconds(1.1), HOMEWARDS)

    def _rest_at(
        self,
        hands: Hands,
        rests: tuple[Reach, Reach],
        start_s: float,
        duration_s: float,
        bow: Vector,
    ) -> float:
        path = self.around(bow, (0.04 + 0.3 * bow[0], 0.03, 0.05))
        late = float(np.clip(self.rng.normal(-0.4, 0.4), -1.0, 0.4))
        end = start_s
        for side in hands:
            rest = rests[side]
            begin = start_s + (self._delay[1 - side] if len(hands) > 1 else 0.0)
            mine = duration_s * self.uniform(0.9, 1.1)
            curve = self.around(path, 0.02)
            swivel = float(np.degrees(rest.swivel_rad))
            arrival = self.reach(
                side,
                begin,
                mine,
                rest.frame,
                rest.point,
                swivel,
                hand=rest.hand,
                bow=curve,
                late=late,
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
        arc: Vector = ORIGIN,
    ) -> None:
        """Lets one wrist swing about where it is, in the chest frame."""
        uneven = self.uniform(0.0, 0.35) if unevenness is None else unevenness
        ramp = min(ramp_s, 0.45 * (stop_s - start_s))
        self._swings[side].append(
            Oscillation(start_s, stop_s, ramp, along, across, frequency_hz, phase_rad, uneven, arc)
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


def flinch(pen: Pen, start_s: float, stop_s: float, pitch: float, spread: float = 6) -> None:
    """Head and trunk give way while the hands are up: often, but not always.

    Args:
        pen: What writes it.
        start_s: When they begin to.
        stop_s: When they are back.
        pitch: Mean pitch of the head, in degrees.
        spread: Its standard deviation.
    """
    if pen.chance(0.6):
        yaw = pen.rng.normal(0, 7)
        roll = pen.rng.normal(0, 3)
        turn = degrees(pen.rng.normal(pitch, spread), roll, yaw)
        pen.turn_and_back("head", start_s, stop_s, turn, share=pen.uniform(0.2, 0.4))
    if pen.chance(0.4):
        turn = degrees(pen.rng.normal(0.4 * pitch, 4), pen.rng.normal(0, 2), pen.rng.normal(0, 5))
        pen.turn_and_back("trunk", start_s, stop_s, turn, share=pen.uniform(0.2, 0.4))


Writer = Callable[[Pen], None]
"""Writes the movements of one action with a pen."""
