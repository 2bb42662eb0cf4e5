import numpy as np
import pytest

from agent_server.synthetic.limbs import (
    MAX_FLEXION_RAD,
    elbow_direction,
    pushed_out,
    rotation,
    turn,
    two_bone,
    unturn,
)

UPPER, LOWER = 0.31, 0.26


def test_rotations_turn_the_way_their_names_say() -> None:
    zero, some = np.zeros(1), np.full(1, 0.3)
    up, ahead = np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, -1.0])
    assert turn(rotation(some, zero, zero), up)[0, 2] < 0  # pitch: the top goes forward
    assert turn(rotation(zero, some, zero), up)[0, 0] < 0  # roll: the top goes to the left
    assert turn(rotation(zero, zero, some), ahead)[0, 0] < 0  # yaw: the front goes to the left
    frames = rotation(*np.random.default_rng(0).uniform(-1, 1, (3, 5)))
    np.testing.assert_allclose(
        frames @ frames.swapaxes(1, 2), np.eye(3) * np.ones((5, 1, 1)), atol=1e-12
    )
    np.testing.assert_allclose(np.linalg.det(frames), 1.0)
    vectors = np.random.default_rng(1).normal(size=(5, 3))
    np.testing.assert_allclose(unturn(frames, turn(frames, vectors)), vectors)


def test_a_chain_reaches_what_is_within_reach() -> None:
    rng = np.random.default_rng(0)
    target = rng.normal(size=(200, 3))
    target *= (rng.uniform(0.25, 0.5, 200) / np.linalg.norm(target, axis=1))[:, None]
    pole = rng.normal(size=(200, 3))
    middle, end = two_bone(np.zeros((200, 3)), target, pole, UPPER, LOWER)
    np.testing.assert_allclose(end, target, atol=1e-3)
    np.testing.assert_allclose(np.linalg.norm(middle, axis=1), UPPER)
    np.testing.assert_allclose(np.linalg.norm(end - middle, axis=1), LOWER)
    aside = middle - (middle * end).sum(1, keepdims=True) / (end**2).sum(1, keepdims=True) * end
    assert ((aside * pole).sum(axis=1) > 0).all()


@pytest.mark.parametrize("distance", [0.0, 0.02, 0.1, 0.57, 0.8, 5.0])
def test_a_chain_keeps_its_limits_beyond_its_reach(distance: float) -> None:
    target = np.array([[distance, 0.0, 0.0]])
    middle, end = two_bone(np.zeros((1, 3)), target, np.array([[0.0, 1.0, 0.0]]), UPPER, LOWER)
    cosine = (middle[0] @ (end - middle)[0]) / (UPPER * LOWER)
    assert np.isfinite(end).all()
    assert np.linalg.norm(end) < UPPER + LOWER
    if distance:
        assert np.arccos(np.clip(cosine, -1, 1)) <= MAX_FLEXION_RAD + 1e-6


def test_elbows_point_where_people_point_them() -> None:
    lines = np.array(
        [[0.1, -1.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, -0.2], [1.0, 0.0, 0.0]]
    )  # hanging, ahead, up, aside
    natural = elbow_direction(lines, np.full(4, np.radians(20)))
    np.testing.assert_allclose(np.linalg.norm(natural, axis=1), 1.0)
    np.testing.assert_allclose((natural * lines).sum(axis=1), 0.0, atol=1e-12)
    assert natural[0, 2] > 0.5  # backwards
    assert natural[1, 1] < -0.5  # down
    assert natural[2, 2] < -0.5  # forwards
    assert natural[3, 1] < -0.5  # down
    raised = elbow_direction(lines[1:2], np.full(1, np.radians(90)))
    assert raised[0, 0] > 0.9  # outwards


def test_points_are_pushed_out_of_an_ellipsoid_and_left_alone_beyond_it() -> None:
    radii = (0.1, 0.14, 0.12)
    points = np.array([[0.01, 0.0, 0.02], [0.05, 0.05, 0.05], [0.3, 0.0, 0.0]])
    out = pushed_out(points, radii, 1.0)
    relative = np.sqrt(((out / np.array(radii)) ** 2).sum(axis=1))
    assert (relative > 0.9).all()
    np.testing.assert_allclose(out[2], points[2], atol=1e-4)
    np.testing.assert_allclose(pushed_out(points, radii, 0.0), points)
