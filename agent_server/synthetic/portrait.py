"""A painted picture of a face: plain enough to need no data, a face to the networks all the same.

What is where in the picture is known from the points that it was painted from.
"""

import cv2
import numpy as np
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32, Float64
from agent_server.face.image import Pixels
from agent_server.face.layouts import CONTOURS, LEFT_PUPIL, RIGHT_PUPIL

_GROUND, _HAIR, _SKIN = (120, 125, 130), (50, 35, 25), (222, 178, 150)
_WHITE, _IRIS, _BROW = (240, 240, 240), (40, 30, 25), (60, 40, 30)
_LIPS, _MOUTH, _NOSE_SHADE = (170, 80, 80), (90, 30, 30), (190, 140, 115)
_NOSE_BASE = (98, 97, 2, 326, 327, 4)
_FRACTION_BITS = 4
_BLUR_PX = 1.2


def portrait(points: Float32, width: int = 640, height: int = 480) -> Pixels:
    """Paint a face.

    Args:
        points: Shape (478, 2 or 3), in pixels, as :mod:`agent_server.synthetic.face` makes them.
        width: Of the picture, in pixels.
        height: Of the picture, in pixels.
    """
    flat = points[:, :2].astype(np.float64)
    eyes_px = float(np.linalg.norm(flat[LEFT_PUPIL] - flat[RIGHT_PUPIL]))
    canvas = np.full((height, width, 3), _GROUND, dtype=np.uint8)

    def fill(outline: Float64, colour: tuple[int, int, int]) -> None:
        cv2.fillPoly(canvas, [_fixed(outline)], colour, cv2.LINE_AA, _FRACTION_BITS)

    oval = flat[list(CONTOURS["oval"])]
    centre = oval.mean(axis=0)
    up = flat[10] - flat[152]  # from the chin to the hairline
    fill(centre + 1.18 * (oval - centre) + 0.12 * up, _HAIR)
    fill(oval, _SKIN)
    thickness = max(1, round(eyes_px / 10))
    for side in ("right", "left"):
        fill(flat[list(CONTOURS[f"{side}_eye"])], _WHITE)
        brow = _fixed(flat[list(CONTOURS[f"{side}_brow"])])
        cv2.polylines(canvas, [brow], False, _BROW, thickness, cv2.LINE_AA, _FRACTION_BITS)
    for pupil in (RIGHT_PUPIL, LEFT_PUPIL):
        x, y = _fixed(flat[pupil]).tolist()
        radius = round(0.09 * eyes_px * 2**_FRACTION_BITS)
        cv2.circle(canvas, (x, y), radius, _IRIS, -1, cv2.LINE_AA, _FRACTION_BITS)
    fill(flat[list(CONTOURS["outer_lips"])], _LIPS)
    fill(flat[list(CONTOURS["inner_lips"])], _MOUTH)
    fill(flat[list(_NOSE_BASE)], _NOSE_SHADE)
    return cv2.GaussianBlur(canvas, (0, 0), _BLUR_PX).astype(np.uint8, copy=False)


def _fixed(places: Float64) -> NDArray[np.int32]:
    """Places as OpenCV takes them: integers with four binary digits after the point."""
    fixed: NDArray[np.int32] = np.round(places * 2**_FRACTION_BITS).astype(np.int32)
    return fixed
