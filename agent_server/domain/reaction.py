"""Reactions that a model makes while they play: what it has learnt from, and what it makes."""

from dataclasses import dataclass

from agent_server.domain.arrays import Float32

Place = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class TrainingRange:
    """What the motions are like that a generator of reactions was trained on.

    Limits are of head, neck, torso, shoulders, elbows and hands.
    Poses are 15 places in metres, y up, in the frame of the pair: origin in the middle between
    both torsos, x from who acts to who reacts.

    Attributes:
        action: How who acts begins: the mean, with bones of median length.
        reaction: How who reacts begins.
        bones: Relative deviation of each bone from its length in ``reaction``: neck, head, then
            shoulder, upper arm and forearm, left and right.
        speed_m_s: Speed of the fastest of these joints, in metres a second.
        acceleration_m_s2: Acceleration of the one that has most, in metres a second squared.
        reach_m: Distances from the torso of left elbow and hand, right elbow and hand, in metres.
    """

    action: tuple[Place, ...]
    reaction: tuple[Place, ...]
    bones: tuple[float, ...]
    speed_m_s: float
    acceleration_m_s2: float
    reach_m: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Stretch:
    """A few frames of a reaction at 25 Hz.

    Attributes:
        first_frame: Index of the first of them; frame 0 is the end of the window that was seen.
        positions: Shape (T, 15, 3), read-only, metres: right-handed, y up, z forward out of the
            agent, origin on the floor below its torso's place at the start. T may be 0.
        is_last: Whether the reaction ends with it.
        refused: Why the rest is not to be played, or None.
    """

    first_frame: int
    positions: Float32
    is_last: bool = False
    refused: str | None = None
