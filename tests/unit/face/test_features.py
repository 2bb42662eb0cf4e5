"""What affect models see of real expressions, of a mirrored face, and of points that are none."""

import numpy as np
import pytest

from agent_server.domain.affect import AffectSample
from agent_server.errors import InvalidInput
from agent_server.face.features import front_view, mesh_features, points68_features
from agent_server.face.layouts import MIRROR_DLIB68, to_dlib68
from agent_server.synthetic.face import SyntheticFace

WIDTH = 640.0


def shown(valence=-4.0, arousal=3.0, kind="mesh478"):
    face = SyntheticFace(np.random.default_rng(0))
    return face.show(AffectSample(0, valence, arousal), kind).points.astype(np.float32)


@pytest.mark.parametrize(
    ("features", "kind", "size"),
    [
        (mesh_features, "mesh478", 936),
        (mesh_features, "mesh468", 936),
        (points68_features, "dlib68", 136),
    ],
)
def test_an_expression_shows(features, kind, size):
    sad, glad = features(shown(-6, 4, kind)), features(shown(6, 4, kind))
    assert (sad.shape, sad.dtype) == ((size,), np.float32)
    assert np.abs(sad - glad).max() > 0.05


def test_a_mirrored_face_has_mirrored_features():
    points = shown(kind="dlib68")
    mirrored = points[MIRROR_DLIB68] * (-1, 1) + (WIDTH, 0)
    expected = points68_features(points).reshape(68, 2)[MIRROR_DLIB68] * (-1, 1)
    found = points68_features(mirrored.astype(np.float32)).reshape(68, 2)
    np.testing.assert_allclose(found, expected, atol=1e-4)


def test_the_front_view_undoes_the_axes_that_it_gives():
    points = shown()
    front, size, axes = front_view(points)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert size.item() > 0
    back = front @ axes
    np.testing.assert_allclose(np.ptp(back, axis=0), np.ptp(points, axis=0), rtol=1e-4)
    # Level eyes: one corner is as high as the other's, on both sides of the nose.
    eyes = front[[33, 133]].mean(axis=0) - front[[362, 263]].mean(axis=0)
    np.testing.assert_allclose(eyes[1:], 0, atol=1e-6)


def test_both_kinds_come_from_one_mesh():
    points = shown()
    assert points68_features(to_dlib68(points)).shape == (136,)


@pytest.mark.parametrize(
    ("features", "points"),
    [
        (points68_features, np.zeros((68, 2), np.float32)),
        (points68_features, np.full((2, 68, 2), 50, np.float32)),
        (mesh_features, np.zeros((478, 3), np.float32)),
        # On one line, forehead and nose lie along the eyes.
        (mesh_features, np.arange(478, dtype=np.float32)[:, None] * np.float32([1, 0, 0])),
    ],
)
def test_points_that_are_no_face_are_refused_in_words(features, points):
    with pytest.raises(InvalidInput, match=r"points has no face.*while a face is found"):
        features(points)
