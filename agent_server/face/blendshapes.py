"""Blendshapes from the mesh: how far each of the face's muscles is drawn."""

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.model import FaceNetwork

# fmt: off
_POINTS = np.array((
    0, 1, 4, 5, 6, 7, 8, 10, 13, 14, 17, 21, 33, 37, 39, 40, 46, 52, 53, 54, 55, 58, 61, 63, 65,
    66, 67, 70, 78, 80, 81, 82, 84, 87, 88, 91, 93, 95, 103, 105, 107, 109, 127, 132, 133, 136,
    144, 145, 146, 148, 149, 150, 152, 153, 154, 155, 157, 158, 159, 160, 161, 162, 163, 168,
    172, 173, 176, 178, 181, 185, 191, 195, 197, 234, 246, 249, 251, 263, 267, 269, 270, 276,
    282, 283, 284, 285, 288, 291, 293, 295, 296, 297, 300, 308, 310, 311, 312, 314, 317, 318,
    321, 323, 324, 332, 334, 336, 338, 356, 361, 362, 365, 373, 374, 375, 377, 378, 379, 380,
    381, 382, 384, 385, 386, 387, 388, 389, 390, 397, 398, 400, 402, 405, 409, 415, 454, 466,
    468, 469, 470, 471, 472, 473, 474, 475, 476, 477,
))
# fmt: on


class FaceBlendshaper:
    """Reads blendshapes off a mesh of 478 points.

    Args:
        network: A network of the role ``blendshapes``.
    """

    def __init__(self, network: FaceNetwork) -> None:
        self._network = network

    def read(self, points: Float32) -> Float32:
        """Blendshapes of a mesh.

        Args:
            points: Shape (478, 2 or 3), in pixels.

        Returns:
            Shape (52,) in [0, 1], in ARKit's order; the tongue, which no point shows, is 0.

        Raises:
            InferenceError: If the network fails.
        """
        given = np.ascontiguousarray(points[_POINTS, :2], dtype=np.float32)[None]
        found = self._network.run(given)["blendshapes"].reshape(-1)
        # The network begins with how neutral a face is, which ARKit has not.
        return np.append(np.clip(found[1:], 0, 1), np.float32(0))
