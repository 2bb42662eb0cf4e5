"""Faces, gaze and calibration between the wire and the domain, checked as they come in."""

from itertools import chain
from typing import NoReturn

import numpy as np

from agent_server.domain.affect import Calibrated, Calibration
from agent_server.domain.arrays import Float32, Float64
from agent_server.domain.face import (
    ARKIT_BLENDSHAPES,
    Face,
    FaceBlendshapes,
    FaceLandmarks,
    FaceLayout,
    GazeSample,
)
from agent_server.errors import InvalidInput
from agent_server.protocol import messages as m

STEPS_PER_PIXEL = 16
"""Landmarks are rounded to a sixteenth of a pixel before anything sees them, so that the wire,
the stages and a recording agree to the bit."""
BLENDSHAPE_DECIMALS = 4
MIN_FACE_PX = 8.0
"""A face that is narrower shows nothing."""
MAX_SIZES_OFF = 1.0
"""How far beyond the image, in image sizes, a point may lie: a face may be cut off."""

_INDEX = {name: index for index, name in enumerate(ARKIT_BLENDSHAPES)}
_OPTIONAL = frozenset({"tongueOut"})
_ROTATIONS = frozenset(
    f"{part}{axis}" for part in ("head", "leftEye", "rightEye") for axis in ("Yaw", "Pitch", "Roll")
)
"""What Live Link Face sends beside the blendshapes; nothing here needs it."""


def round_points(points: Float64) -> Float64:
    """Points as they are taken in, from the wire or from an image."""
    rounded: Float64 = np.rint(points * STEPS_PER_PIXEL)
    rounded /= STEPS_PER_PIXEL
    return rounded


def landmarks_from_message(
    message: m.FacePoints | m.PackedFacePoints, stamp_ns: int | None = None
) -> FaceLandmarks:
    """Check the points of a face.

    Args:
        message: As decoded.
        stamp_ns: Its stamp on the session's time line; None keeps the sender's.

    Raises:
        InvalidInput: If the number of points or axes does not fit the format, or a coordinate
            is not finite, far outside the image, or the face has no size.
    """
    layout = FaceLayout(message.format)
    points = _coordinates(message, layout)
    _check_points(points, message)
    points = round_points(points)
    return FaceLandmarks(
        originating_ns=message.originating_ns if stamp_ns is None else stamp_ns,
        layout=layout,
        points=_read_only(points.astype(np.float32)),
        width=message.width,
        height=message.height,
    )


def blendshapes_from_message(
    message: m.Blendshapes, stamp_ns: int | None = None
) -> FaceBlendshapes:
    """Check blendshapes; names may begin with a capital, as Live Link Face has them.

    Raises:
        InvalidInput: If a name is unknown or missing, or a value lies outside [0, 1].
    """
    values = np.full(len(ARKIT_BLENDSHAPES), np.nan)
    for given, value in message.values.items():
        name = given[:1].lower() + given[1:]
        index = _INDEX.get(name)
        if index is None:
            if name in _ROTATIONS:
                continue
            raise InvalidInput(
                f"values.{given} is no blendshape of ARKit: send the names of "
                "ARFaceAnchor.BlendShapeLocation, for example jawOpen",
                field=f"values.{given}",
                code="unknown_blendshape",
            )
        if not 0.0 <= value <= 1.0:
            raise InvalidInput(
                f"values.{given} is {value:g}: a blendshape lies in 0..1",
                field=f"values.{given}",
                code="out_of_range",
            )
        values[index] = value
    missing = [
        name
        for name, value in zip(ARKIT_BLENDSHAPES, values, strict=True)
        if np.isnan(value) and name not in _OPTIONAL
    ]
    if missing:
        raise InvalidInput(
            f"values lacks {', '.join(missing[:3])}{' and others' if len(missing) > 3 else ''}: "
            f"send all {len(ARKIT_BLENDSHAPES)} of ARKit (tongueOut may be left out), 0 where "
            "a muscle rests",
            field="values",
            code="missing_blendshape",
        )
    rounded = np.nan_to_num(values).round(BLENDSHAPE_DECIMALS).astype(np.float32)
    stamp_ns = message.originating_ns if stamp_ns is None else stamp_ns
    return FaceBlendshapes(stamp_ns, _read_only(rounded))


def face_from_message(
    message: m.FacePoints | m.PackedFacePoints | m.Blendshapes, stamp_ns: int | None = None
) -> Face:
    """Check a face of either kind.

    Raises:
        InvalidInput: As the functions for each kind do.
    """
    if isinstance(message, m.Blendshapes):
        return blendshapes_from_message(message, stamp_ns)
    return landmarks_from_message(message, stamp_ns)


def face_to_message(face: Face) -> m.FacePoints | m.Blendshapes:
    """A face as a JSON-coded message."""
    if isinstance(face, FaceBlendshapes):
        values = face.values.astype(np.float64).round(BLENDSHAPE_DECIMALS).tolist()
        return m.Blendshapes(face.originating_ns, dict(zip(ARKIT_BLENDSHAPES, values, strict=True)))
    points = round_points(face.points.astype(np.float64))
    return m.FacePoints(
        face.originating_ns, face.layout.value, face.width, face.height, points.tolist()
    )


def pack_face(message: m.FacePoints) -> m.PackedFacePoints:
    """JSON-coded points as MessagePack-coded ones."""
    points = np.array(message.points, dtype="<f4").tobytes()
    return m.PackedFacePoints(
        message.originating_ns, message.format, message.width, message.height, points
    )


@np.errstate(over="ignore", invalid="ignore")  # such numbers are refused by the checks below
def gaze_from_message(message: m.Gaze, stamp_ns: int | None = None) -> GazeSample:
    """Check a gaze ray and give it unit length.

    Raises:
        InvalidInput: If a number is not finite or the direction has no length.
    """
    for field in ("origin", "direction"):
        if not np.isfinite(getattr(message, field)).all():
            raise InvalidInput(
                f"{field} is {list(getattr(message, field))}: send finite numbers",
                field=field,
                code="not_finite",
            )
    length = float(np.linalg.norm(message.direction))
    if not 1e-6 < length < 1e6:
        raise InvalidInput(
            f"direction has the length {length:g}: send where the person looks, of length 1",
            field="direction",
            code="out_of_range",
        )
    x, y, z = (round(axis / length, 6) for axis in message.direction)
    stamp_ns = message.originating_ns if stamp_ns is None else stamp_ns
    return GazeSample(stamp_ns, message.origin, (x, y, z))


def gaze_to_message(sample: GazeSample) -> m.Gaze:
    """A gaze as a message."""
    return m.Gaze(sample.originating_ns, sample.origin, sample.direction)


def calibration_from_message(message: m.Calibrate, stamp_ns: int | None = None) -> Calibration:
    """Check what is asked of a calibration.

    Raises:
        InvalidInput: If it gives neither ``seconds`` nor ``valence`` and ``arousal``, or both.
    """
    known = message.valence is not None and message.arousal is not None
    some = message.valence is not None or message.arousal is not None
    if some != known or known == (message.seconds is not None):
        raise InvalidInput(
            "calibrate takes seconds, while the face is neutral, or else valence and arousal of "
            "a neutral face that is known",
            field="seconds",
            code="invalid_field",
        )
    neutral = None
    if message.valence is not None and message.arousal is not None:
        neutral = (message.valence, message.arousal)
    stamp_ns = message.originating_ns if stamp_ns is None else stamp_ns
    return Calibration(stamp_ns, message.seconds, neutral)


def calibration_to_message(calibration: Calibration) -> m.Calibrate:
    """What was asked of a calibration, as a message."""
    valence, arousal = calibration.neutral or (None, None)
    return m.Calibrate(calibration.originating_ns, calibration.seconds, valence, arousal)


def calibrated_message(calibrated: Calibrated) -> m.CalibrationState:
    """What a calibration came to, for clients."""
    return m.CalibrationState(
        calibrated.valence, calibrated.arousal, calibrated.faces, calibrated.is_done
    )


def _coordinates(message: m.FacePoints | m.PackedFacePoints, layout: FaceLayout) -> Float64:
    """Points as (N, 2 or 3)."""
    if isinstance(message, m.PackedFacePoints):
        if len(message.points) != 4 * layout.points * layout.axes:
            raise _wrong_count(layout, f"{len(message.points)} bytes")
        packed = np.frombuffer(message.points, dtype="<f4").astype(np.float64)
        return packed.reshape(layout.points, layout.axes)
    if len(message.points) != layout.points:
        raise _wrong_count(layout, f"{len(message.points)} points")
    axes = layout.axes
    if set(map(len, message.points)) != {axes}:
        index = next(i for i, point in enumerate(message.points) if len(point) != axes)
        raise InvalidInput(
            f"points[{index}] has {len(message.points[index])} numbers: format {layout} has {axes}",
            field=f"points[{index}]",
            code="wrong_point_size",
        )
    flat = np.fromiter(chain.from_iterable(message.points), np.float64, layout.points * axes)
    return flat.reshape(layout.points, axes)


def _wrong_count(layout: FaceLayout, got: str) -> InvalidInput:
    return InvalidInput(
        f"format {layout} has {layout.points} points of {layout.axes} numbers, got {got}: send "
        "every point of the format, in its order",
        field="points",
        code="wrong_point_count",
    )


def _check_points(points: Float64, message: m.FacePoints | m.PackedFacePoints) -> None:
    least, most = points.min(axis=0).tolist(), points.max(axis=0).tolist()
    sizes = (message.width, message.height, max(message.width, message.height))
    # NaN fails every comparison.
    if not all(
        low >= -MAX_SIZES_OFF * size and high <= (1 + MAX_SIZES_OFF) * size
        for low, high, size in zip(least, most, sizes, strict=False)
    ):
        _find_outside(points, message)
    width, height = most[0] - least[0], most[1] - least[1]
    if max(width, height) < MIN_FACE_PX:
        raise InvalidInput(
            f"the face is {width:.1f} pixels wide: send pixels, not shares of the image, of a "
            f"face of at least {MIN_FACE_PX:g}",
            field="points",
            code="face_too_small",
        )


def _find_outside(points: Float64, message: m.FacePoints | m.PackedFacePoints) -> NoReturn:
    size = np.array((message.width, message.height, max(message.width, message.height)))
    size = size[: points.shape[1]]
    good = (points >= -MAX_SIZES_OFF * size) & (points <= (1 + MAX_SIZES_OFF) * size)
    point, axis = np.argwhere(~good)[0]
    field = f"points[{point}][{axis}]"
    value = points[point, axis]
    raise InvalidInput(
        f"{field} is {value:g}, far outside an image of {message.width} x {message.height}: "
        "send pixels of that image",
        field=field,
        code="out_of_range" if np.isfinite(value) else "not_finite",
    )


def _read_only(array: Float32) -> Float32:
    array.flags.writeable = False
    return array
