"""Motion at the models' rate: what was seen, and what is expected to follow."""

from dataclasses import dataclass

from agent_server.domain.arrays import Float32

RATE_HZ = 25
FRAME_NS = 1_000_000_000 // RATE_HZ
SEEN_FRAMES = 25
PREDICTED_FRAMES = 50
CLASSIFIED_FRAMES = SEEN_FRAMES + PREDICTED_FRAMES


@dataclass(frozen=True, slots=True)
class MotionSequence:
    """A stretch of one body's motion, as data sets and generators give it.

    Attributes:
        positions: Shape (T, 9, 3), read-only, metres in the camera frame.
        confidence: Shape (T, 9), read-only, in [0, 1].
        rate_hz: Frames a second.
        subject: Who moves, so that people can be held out.
        label: Gesture shown, or ``idle``.
        source: Where it comes from, for example ``synthetic`` or ``cmu_mocap``.
    """

    positions: Float32
    confidence: Float32
    rate_hz: float
    subject: str
    label: str
    source: str


@dataclass(frozen=True, slots=True)
class Quality:
    """How far a window of frames can be trusted.

    Attributes:
        measured: Share of joint samples that were tracked, in [0, 1].
        filled: Share of joint samples that repeat a last known position, in [0, 1].
        bone_deviation: Largest relative deviation of a bone's length from its median.
        warnings: Names of what looks wrong: ``mirrored``, ``upside_down``, ``bone_length``,
            ``occluded``.
    """

    measured: float
    filled: float
    bone_deviation: float
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Window:
    """One second of seen motion, ready for the models.

    Attributes:
        index: Counts the session's windows from 0.
        body_id: Whose motion it is.
        start_ns: Capture time of the first frame.
        end_ns: Capture time of the last frame.
        positions: Shape (25, 9, 3), read-only, metres in the camera frame.
        confidence: Shape (25, 9), read-only, in [0, 1].
        quality: How far it can be trusted.
    """

    index: int
    body_id: int
    start_ns: int
    end_ns: int
    positions: Float32
    confidence: Float32
    quality: Quality


@dataclass(frozen=True, slots=True)
class Futures:
    """What else may follow a window, beside what is expected.

    Attributes:
        positions: Shape (K, 50, 9, 3), read-only, metres in the camera frame: those of good
            quality, K may be 0.
        quality: Shape (K,), read-only, in [0, 1]: how probably each is a real motion.
        drawn: How many were drawn.
        source: Name of the bundle that drew them.
    """

    positions: Float32
    quality: Float32
    drawn: int
    source: str


@dataclass(frozen=True, slots=True)
class Forecast:
    """The two seconds that are expected to follow a window.

    Attributes:
        positions: Shape (50, 9, 3), read-only, metres in the camera frame.
        source: Name of the bundle that made it, or ``last_frame`` when it stood in.
        failure: Why the predictor could not be used, or None.
        futures: What else may follow, or None where nothing was drawn.
    """

    positions: Float32
    source: str
    failure: str | None = None
    futures: Futures | None = None


@dataclass(frozen=True, slots=True)
class ForecastFigures:
    """How good the forecasts were whose truth came within the last minute.

    Attributes:
        error_mm: Mean distance of the nine core joints over the two seconds.
        zero_velocity_mm: The same for a body that stands still from the last seen frame on.
        forecasts: How many were scored.
    """

    error_mm: float
    zero_velocity_mm: float
    forecasts: int


@dataclass(frozen=True, slots=True)
class BodyLost:
    """The followed body has left, or its sensor has.

    Attributes:
        stamp_ns: When it counted as lost.
        body_id: Who left.
    """

    stamp_ns: int
    body_id: int
