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
    """

    originating_ns: int
    valence: float
    arousal: float
    valence_sd: float | None = None
    arousal_sd: float | None = None
    source: str = "client"
