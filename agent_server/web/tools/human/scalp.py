"""Where hair grows: one field that the skin, the paint and the hair share."""

import numpy as np

from agent_server.web.tools.human.figure import Figure
from agent_server.web.tools.human.makehuman import Array

AXIS = 0.05
"""Where the upright axis of the head lies, metres in front of the world's x axis."""
HAIRLINE = np.array(
    [
        (0, 0.066), (20, 0.068), (38, 0.069), (52, 0.060), (62, 0.040), (68, 0.012),
        (73, -0.006), (79, -0.008), (83, 0.017), (104, 0.017), (109, -0.008), (120, -0.044),
        (150, -0.064), (180, -0.068),
    ]
)  # fmt: skip
"""Degrees from the front, and metres above the eyes."""


def around(points: Array) -> Array:
    """The angle from the front around the axis of the head, 0 to pi on both sides, (...)."""
    return np.arctan2(np.abs(points[..., 0]), points[..., 2] - AXIS)


def above_eyes(points: Array, figure: Figure) -> Array:
    """Metres above the middle of the eyes, (...)."""
    height: Array = points[..., 1] - figure.rig["LeftEye"][1]
    return height


def above_hairline(points: Array, figure: Figure) -> Array:
    """Metres above the hairline, negative on the face and the neck, (...)."""
    line = np.interp(np.degrees(around(points)), HAIRLINE[:, 0], HAIRLINE[:, 1])
    height: Array = above_eyes(points, figure) - line
    return height
