"""Which points are which: the mesh of MediaPipe, and the 68 points of dlib and iBUG."""

import numpy as np

from agent_server.domain.arrays import Float32

RIGHT_PUPIL, LEFT_PUPIL = 468, 473
"""Of the 478-point mesh; "right" is the person's right."""

# fmt: off
MESH_TO_DLIB68 = np.array((
    127, 234, 93, 132, 58, 172, 150, 176, 152, 400, 379, 397, 288, 361, 323, 454, 356,  # jaw
    70, 63, 105, 66, 107,  # the person's right brow, from the temple in
    336, 296, 334, 293, 300,  # left brow, from the nose out
    168, 197, 5, 4,  # bridge of the nose
    98, 97, 2, 326, 327,  # below the nose
    33, 160, 158, 133, 153, 144,  # right eye
    362, 385, 387, 263, 373, 380,  # left eye
    61, 39, 37, 0, 267, 269, 291, 405, 314, 17, 84, 181,  # lips, outside
    78, 82, 13, 312, 308, 317, 14, 87,  # lips, inside
))
"""Of each of dlib's 68 points the nearest of the mesh."""

MIRROR_DLIB68 = np.array((
    *range(16, -1, -1),
    *range(26, 16, -1),
    27, 28, 29, 30, 35, 34, 33, 32, 31,
    45, 44, 43, 42, 47, 46, 39, 38, 37, 36, 41, 40,
    54, 53, 52, 51, 50, 49, 48, 59, 58, 57, 56, 55,
    64, 63, 62, 61, 60, 67, 66, 65,
))
"""Where each point of dlib's lies in a mirrored face."""

CONTOURS: dict[str, tuple[int, ...]] = {
    "oval": (10, 338, 297, 332, 284, 251, 389, 356, 454, 323, 361, 288, 397, 365, 379, 378, 400,
             377, 152, 148, 176, 149, 150, 136, 172, 58, 132, 93, 234, 127, 162, 21, 54, 103, 67,
             109, 10),
    "right_eye": (33, 7, 163, 144, 145, 153, 154, 155, 133, 173, 157, 158, 159, 160, 161, 246, 33),
    "left_eye": (263, 249, 390, 373, 374, 380, 381, 382, 362, 398, 384, 385, 386, 387, 388, 466,
                 263),
    "right_brow": (70, 63, 105, 66, 107),
    "left_brow": (300, 293, 334, 296, 336),
    "outer_lips": (61, 146, 91, 181, 84, 17, 314, 405, 321, 375, 291, 409, 270, 269, 267, 0, 37,
                   39, 40, 185, 61),
    "inner_lips": (78, 95, 88, 178, 87, 14, 317, 402, 318, 324, 308, 415, 310, 311, 312, 13, 82,
                   81, 80, 191, 78),
    "nose": (168, 6, 197, 195, 5, 4),
}
"""Lines through points of the mesh that make a drawing of a face; a closed one ends where it
began."""
# fmt: on


def to_dlib68(points: Float32) -> Float32:
    """The 68 points (..., 68, 2) of meshes (..., N, 2 or 3)."""
    return points[..., MESH_TO_DLIB68, :2]
