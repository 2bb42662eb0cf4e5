"""The shipped networks, and painted faces whose points are known."""

from dataclasses import dataclass

import numpy as np
import pytest

from agent_server import assets
from agent_server.domain.model import FaceNetwork
from agent_server.inference.runtime import OnnxFaceNetwork
from agent_server.synthetic.face import face_shapes
from agent_server.synthetic.portrait import portrait


@dataclass(frozen=True)
class Networks:
    detector: FaceNetwork
    mesh: FaceNetwork
    fast: FaceNetwork
    blendshapes: FaceNetwork


@pytest.fixture(scope="session")
def networks():
    bundles = assets.bundles()
    return Networks(
        OnnxFaceNetwork(bundles / "face_detector", "detector"),
        OnnxFaceNetwork(bundles / "face_mesh", "mesh"),
        OnnxFaceNetwork(bundles / "face_mesh_fast", "mesh"),
        OnnxFaceNetwork(bundles / "face_blendshapes", "blendshapes"),
    )


@pytest.fixture(scope="session")
def painted():
    """Paints a neutral face, and gives the picture with the points that it was painted from."""

    def paint(x=320.0, y=220.0, eyes=70.0, degrees=0.0, width=640, height=480):
        turn = np.radians(degrees)
        rotation = np.array(((np.cos(turn), -np.sin(turn)), (np.sin(turn), np.cos(turn))))
        points = face_shapes().expression[0].copy()  # (478, 3), the eyes one unit apart
        points[:, :2] = points[:, :2] @ rotation.T
        points = (points * eyes + (x, y, 0)).astype(np.float32)
        return portrait(points, width, height), points

    return paint
