"""How a face looks: valence and arousal."""

from dataclasses import dataclass

AFFECT_LIMIT = 10.0
"""Valence and arousal lie in [-10, 10], as in AFEW-VA."""


@dataclass(frozen=True, slots=True)
class AffectSample:
    """One estimate of a person's affect.

    Attributes:
        originating_ns: Capture time on the session's time line.
        valence: Unpleasant to pleasant, in [-10, 10].
        arousal: Calm to excited, in [-10, 10].
        valence_sd: Standard deviation of the valence, or None where the client gave it.
        arousal_sd: Standard deviation of the arousal, or None where the client gave it.
        source: ``client``, or what it was estimated from: ``mesh``, ``points68`` or
            ``blendshapes``.
        delay_ms: How far an average lags behind the face, or None where the client gave it.
    """

    originating_ns: int
    valence: float
    arousal: float
    valence_sd: float | None = None
    arousal_sd: float | None = None
    source: str = "client"
    delay_ms: float | None = None


@dataclass(frozen=True, slots=True)
class Calibration:
    """Asks to make a person's neutral face the zero of valence and arousal.

    Attributes:
        originating_ns: When, on the session's time line.
        seconds: The face is neutral from then on for so long; or None, and then
        neutral: valence and arousal of the person's neutral face are known already.
    """

    originating_ns: int
    seconds: float | None
    neutral: tuple[float, float] | None


@dataclass(frozen=True, slots=True)
class Calibrated:
    """What a calibration came to.

    Attributes:
        valence: What the neutral face had before; from now on it is taken off.
        arousal: The same for arousal.
        faces: How many faces were seen; with too few nothing has changed.
        is_done: Whether it is in force.
    """

    valence: float
    arousal: float
    faces: int
    is_done: bool
