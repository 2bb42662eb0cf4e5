"""The mesh of a face: 478 points, or 468 by the fast network, and whether it is a face."""

from dataclasses import dataclass
from math import exp

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.face import FaceLayout
from agent_server.domain.model import FaceNetwork
from agent_server.face.image import Pixels
from agent_server.face.regions import Region

_LAYOUTS = {layout.points: layout for layout in (FaceLayout.MESH478, FaceLayout.MESH468)}


@dataclass(frozen=True, slots=True)
class Mesh:
    """A face as the network sees it.

    Attributes:
        layout: Which points.
        points: Shape (N, 3): x, y in pixels of the image, and the depth in the same unit,
            smaller towards the camera.
        presence: Probability that there is a face.
    """

    layout: FaceLayout
    points: Float32
    presence: float


class FaceMesh:
    """Finds the points of a face in a region.

    Args:
        network: A network of the role ``mesh``.
    """

    def __init__(self, network: FaceNetwork) -> None:
        self._network = network
        self._side = network.input_shape[1]

    def look(self, image: Pixels, region: Region) -> Mesh:
        """Find the points of the face in ``region``.

        Raises:
            InferenceError: If the network fails.
        """
        side = self._side
        crop = region.crop(image, side)
        found = self._network.run(np.multiply(crop, np.float32(1 / 255), dtype=np.float32)[None])
        points = found["points"].reshape(-1, 3)
        back = region.to_image(side)
        placed = np.empty_like(points)
        placed[:, :2] = points[:, :2] @ back[:, :2].T + back[:, 2]
        placed[:, 2] = points[:, 2] * (region.size / side)
        logit = max(-80.0, min(80.0, float(found["flag"].reshape(()))))
        return Mesh(_LAYOUTS[len(points)], placed, 1 / (1 + exp(-logit)))
