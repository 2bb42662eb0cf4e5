"""What features of a face may not depend on."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agent_server.domain.affect import AffectSample
from agent_server.face.features import blendshape_features, mesh_features, points68_features
from agent_server.synthetic.face import SyntheticFace

angle = st.floats(-0.6, 0.6)
small = st.floats(-0.25, 0.25)
scale = st.floats(0.3, 4.0)
shift = st.floats(-300, 300)


def face(kind, seed=0):
    shown = SyntheticFace(np.random.default_rng(seed)).show(AffectSample(0, -4.0, 3.0), kind)
    return shown.points.astype(np.float64)


def about(axis, radians):
    c, s = np.cos(radians), np.sin(radians)
    i, j = [k for k in range(3) if k != axis]
    turn = np.eye(3)
    turn[i, i] = turn[j, j] = c
    turn[i, j], turn[j, i] = -s, s
    return turn


@settings(deadline=None, derandomize=True)
@given(angle, scale, shift, shift)
def test_place_size_and_roll_do_not_show(roll, size, x, y):
    points = face("mesh478")
    moved = points @ about(2, roll).T * size + (x, y, 0)
    np.testing.assert_allclose(mesh_features(moved), mesh_features(points), atol=1e-4)
    flat = face("dlib68")
    moved = flat @ about(2, roll)[:2, :2].T * size + (x, y)
    np.testing.assert_allclose(points68_features(moved), points68_features(flat), atol=1e-4)


@settings(deadline=None, derandomize=True)
@given(small, small)
def test_the_turn_of_the_head_does_not_show_in_a_mesh(yaw, pitch):
    points = face("mesh478")
    turned = points @ (about(0, pitch) @ about(1, yaw)).T
    np.testing.assert_allclose(mesh_features(turned), mesh_features(points), atol=1e-4)


@pytest.mark.parametrize(
    ("features", "kind"), [(mesh_features, "mesh478"), (points68_features, "dlib68")]
)
def test_a_batch_is_the_faces_one_by_one(features, kind):
    batch = np.stack([face(kind, seed) for seed in range(4)]).reshape(2, 2, -1, face(kind).shape[1])
    together = features(batch)
    for i in range(2):
        for j in range(2):
            np.testing.assert_allclose(together[i, j], features(batch[i, j]), atol=1e-6)
    assert together.dtype == np.float32


def test_the_irises_do_not_count():
    points = face("mesh478")
    np.testing.assert_array_equal(mesh_features(points), mesh_features(points[:468]))


def test_blendshapes_keep_their_order_and_lose_the_tongue():
    values = np.linspace(0, 1, 52, dtype=np.float32)
    features = blendshape_features(values)
    assert features.shape == (51,)
    np.testing.assert_allclose(np.square(features), values[:51], atol=1e-6)
