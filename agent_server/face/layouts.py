"""Which points are which: the mesh of MediaPipe, and the 68 points of dlib and iBUG."""

import numpy as np

from agent_server.domain.arrays import Float32

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
"""Of each of dlib's 68 points the nearest of the mesh; "right" is the person's right."""

MIRROR_DLIB68 = np.array((
    *range(16, -1, -1),
    *range(26, 16, -1),
    27, 28, 29, 30, 35, 34, 33, 32, 31,
    45, 44, 43, 42, 47, 46, 39, 38, 37, 36, 41, 40,
    54, 53, 52, 51, 50, 49, 48, 59, 58, 57, 56, 55,
    64, 63, 62, 61, 60, 67, 66, 65,
))
"""Where each point of dlib's lies in a mirrored face."""
# fmt: on


def to_dlib68(points: Float32) -> Float32:
    """The 68 points (..., 68, 2) of meshes (..., N, 2 or 3)."""
    return points[..., MESH_TO_DLIB68, :2]
