"""What the mesh network is shown, and where its points end up."""

import numpy as np
import pytest

from agent_server.domain.face import FaceLayout
from agent_server.face.mesh import FaceMesh
from agent_server.face.regions import Region

SIDE = 64


class Corners:
    """A mesh network whose points are the corners of its input, again and again."""

    name = "corners"
    sha256 = "0" * 64
    input_shape = (1, SIDE, SIDE, 3)

    def __init__(self, count=478, flag=0.0):
        corners = np.array(((0, 0, -8), (SIDE, 0, 0), (SIDE, SIDE, 8), (0, SIDE, 4)), np.float32)
        self.points = np.resize(corners, (count, 3))
        self.flag = flag

    def run(self, given):
        self.given = given
        return {
            "points": self.points.reshape(1, -1),
            "flag": np.array([[self.flag]], dtype=np.float32),
        }


def test_the_network_is_shown_colours_from_0_to_1():
    image = np.zeros((200, 200, 3), np.uint8)
    image[:] = (255, 51, 0)
    network = Corners()
    FaceMesh(network).look(image, Region(100, 100, 80, 0.4))
    assert network.given.shape == (1, SIDE, SIDE, 3)
    assert network.given.dtype == np.float32
    assert network.given.reshape(-1, 3) == pytest.approx(np.tile((1, 0.2, 0), (SIDE * SIDE, 1)))


def test_points_of_the_crop_are_placed_in_the_image():
    # A quarter turn clockwise: what is right in the crop is below in the image.
    region = Region(300, 200, 2 * SIDE, np.pi / 2)
    mesh = FaceMesh(Corners()).look(np.zeros((480, 640, 3), np.uint8), region)
    corners = ((364, 136, -16), (364, 264, 0), (236, 264, 16), (236, 136, 8))
    assert mesh.points[:4] == pytest.approx(np.array(corners), abs=1e-3)


@pytest.mark.parametrize(
    ("flag", "presence"), [(0, 0.5), (3, 0.95257), (-3, 0.04743), (1e6, 1), (-1e6, 0)]
)
def test_presence_is_the_probability_of_the_flag(flag, presence):
    mesh = FaceMesh(Corners(flag=flag)).look(np.zeros((9, 9, 3), np.uint8), Region(4, 4, 8, 0))
    assert mesh.presence == pytest.approx(presence, abs=1e-5)


@pytest.mark.parametrize("layout", [FaceLayout.MESH478, FaceLayout.MESH468])
def test_the_number_of_points_tells_the_layout(layout):
    mesh = FaceMesh(Corners(layout.points)).look(np.zeros((9, 9, 3), np.uint8), Region(4, 4, 8, 0))
    assert mesh.layout is layout
