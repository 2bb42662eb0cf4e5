"""Blendshapes of painted and of real faces, by name."""

import numpy as np
import pytest

from agent_server.domain.affect import AffectSample
from agent_server.domain.face import ARKIT_BLENDSHAPES
from agent_server.face.blendshapes import FaceBlendshaper
from agent_server.face.tracker import FaceTracker
from agent_server.synthetic.face import SyntheticFace, face_shapes
from tests.support.pictures import labelled, needs_faces, picture

INDEX = {name: index for index, name in enumerate(ARKIT_BLENDSHAPES)}


class Ramp:
    """A blendshape network that gives what it was asked for, and its own running numbers."""

    name = "ramp"
    sha256 = "0" * 64
    input_shape = (1, 146, 2)

    def run(self, given):
        self.given = given
        return {"blendshapes": np.linspace(-0.1, 1.1, 52, dtype=np.float32)[None]}


@pytest.fixture
def shapes(networks):
    return FaceBlendshaper(networks.blendshapes)


def test_shapes_come_in_arkits_order_within_their_limits():
    network = Ramp()
    values = FaceBlendshaper(network).read(np.zeros((478, 3), np.float32))
    assert values.shape == (52,)
    assert values.dtype == np.float32
    expected = np.clip(np.linspace(-0.1, 1.1, 52)[1:], 0, 1)
    assert np.allclose(values[:51], expected), "how neutral a face is comes first, and is left out"
    assert values[INDEX["tongueOut"]] == 0


def test_the_network_gets_x_and_y_of_its_points_in_order():
    network = Ramp()
    points = np.arange(478 * 3, dtype=np.float32).reshape(478, 3)
    FaceBlendshaper(network).read(points)
    assert network.given.shape == (1, 146, 2)
    assert network.given.dtype == np.float32
    chosen = network.given[0, :, 0] / 3
    assert (np.diff(chosen) > 0).all(), "ascending, so none twice"
    assert set(range(468, 478)) <= set(chosen.astype(int)), "with both irises"
    assert np.array_equal(network.given[0, :, 1], network.given[0, :, 0] + 1)


def test_the_networks_points_are_those_of_both_halves_of_the_face():
    network = Ramp()
    points = np.zeros((478, 3), dtype=np.float32)
    points[:, 0] = np.arange(478)
    FaceBlendshaper(network).read(points)
    chosen = network.given[0, :, 0].astype(int)
    neutral = face_shapes().expression[0]
    distances = np.linalg.norm(neutral[:, None] * (-1, 1, 1) - neutral[None], axis=2)
    mirrored = distances.argmin(axis=1)
    assert set(mirrored[chosen]) <= set(chosen)
    # On the line between them: lips, chin, nose and forehead.
    middle = {int(point) for point in chosen if mirrored[point] == point}
    assert middle >= {0, 1, 4, 5, 6, 8, 10, 13, 14, 17, 152, 168, 195, 197}


def test_place_and_size_of_a_face_change_nothing(shapes):
    points = _face(0, 0)
    values = shapes.read(points)
    assert np.abs(shapes.read(points * 2 + (100, -50, 0)) - values).max() < 0.01


def _face(valence, arousal):
    mood = AffectSample(0, float(valence), float(arousal))
    return SyntheticFace(np.random.default_rng(3)).show(mood, "mesh478").points


def test_a_smile_is_a_smile_and_an_open_jaw_is_open(shapes):
    neutral, glad, startled = (shapes.read(_face(*mood)) for mood in ((0, 0), (8, 2), (-2, 9)))
    for side in ("Left", "Right"):
        smile = INDEX[f"mouthSmile{side}"]
        assert glad[smile] > neutral[smile] + 0.3
    assert startled[INDEX["jawOpen"]] > neutral[INDEX["jawOpen"]] + 0.2


def test_shut_eyes_blink(shapes):
    points = _face(0, 0).copy()
    open_eyes = shapes.read(points)
    for upper, lower in ((159, 145), (158, 153), (160, 144), (157, 154), (161, 163)):
        points[upper] = points[lower]  # the person's right eye
    shut = shapes.read(points)
    right, left = INDEX["eyeBlinkRight"], INDEX["eyeBlinkLeft"]
    assert shut[right] > open_eyes[right] + 0.3
    assert shut[right] > shut[left] + 0.3


@needs_faces
def test_real_faces_smile_where_their_labels_say_so(networks, shapes):
    def smiles(files):
        found = [FaceTracker(networks.detector, networks.mesh).look(picture(f)) for f in files]
        values = np.array([shapes.read(each.points) for each in found if each is not None])
        return values[:, [INDEX["mouthSmileLeft"], INDEX["mouthSmileRight"]]].mean(axis=1)

    glad = smiles(labelled(12, valence=(0.7, 1)))
    sad = smiles(labelled(12, valence=(-1, -0.6)))
    assert np.median(glad) > 0.4
    assert np.median(sad) < 0.1
