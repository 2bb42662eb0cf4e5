"""Regions of an image: where a face is looked at, upright and square.

As in MediaPipe's face graphs: a region is half as large again as the box around the face, and
turned so that the eyes lie level.
"""

from dataclasses import dataclass
from math import atan2, cos, sin

import cv2
import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.face.image import Pixels

MARGIN = 1.5
RIGHT_EYE_OUTER, LEFT_EYE_OUTER = 33, 263
"""Outer corners of the person's eyes in the mesh."""


@dataclass(frozen=True, slots=True)
class Region:
    """A square, turned part of an image.

    Attributes:
        x: Of its centre, in pixels.
        y: Of its centre, in pixels.
        size: Length of a side, in pixels.
        angle: By which it is turned clockwise, in radians.
    """

    x: float
    y: float
    size: float
    angle: float

    def to_image(self, side: int) -> Float32:
        """Affine map (2, 3) from the pixels of a crop of ``side`` to those of the image."""
        scale = self.size / side
        along, across = scale * cos(self.angle), scale * sin(self.angle)
        half = side / 2
        return np.array(
            [
                [along, -across, self.x - half * (along - across)],
                [across, along, self.y - half * (across + along)],
            ],
            dtype=np.float32,
        )

    def crop(self, image: Pixels, side: int) -> Pixels:
        """The region as an upright image of ``side`` pixels; beyond the image its edge goes on."""
        crop = cv2.warpAffine(
            image,
            self.to_image(side),
            (side, side),
            flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP,
            borderMode=cv2.BORDER_REPLICATE,
        )
        return crop.astype(np.uint8, copy=False)


def region_of_box(low: Float32, high: Float32, right_eye: Float32, left_eye: Float32) -> Region:
    """The region of a face from its box and its eyes, each (2,) in pixels."""
    x, y = (low + high) / 2
    across = left_eye - right_eye
    size = MARGIN * float((high - low).max())
    return Region(float(x), float(y), size, atan2(across[1], across[0]))


def region_of_points(points: Float32) -> Region:
    """The region of a face from the points of its mesh, (N, 2 or 3) in pixels."""
    flat = points[:, :2]
    return region_of_box(
        flat.min(axis=0), flat.max(axis=0), flat[RIGHT_EYE_OUTER], flat[LEFT_EYE_OUTER]
    )
