import numpy as np
import pytest

from agent_server.errors import InvalidInput
from agent_server.geometry import sphere

NORTH = np.array([0.0, 0.0, 1.0])
EAST = np.array([1.0, 0.0, 0.0])


def test_a_quarter_turn() -> None:
    np.testing.assert_allclose(sphere.log(EAST, NORTH), [np.pi / 2, 0, 0], atol=1e-16)
    np.testing.assert_allclose(sphere.exp(np.array([np.pi / 2, 0, 0]), NORTH), EAST, atol=1e-16)
    assert sphere.distance(NORTH, EAST) == pytest.approx(np.pi / 2, abs=1e-16)


def test_equal_points_are_exactly_at_zero() -> None:
    point = sphere.normalise(np.array([0.1, 0.2, 0.3, 0.4]))
    assert sphere.distance(point, point) == 0.0
    np.testing.assert_array_equal(sphere.log(point, point), np.zeros(4))
    np.testing.assert_array_equal(sphere.exp(np.zeros(4), point), point)


@pytest.mark.parametrize("angle", [1e-15, 1e-12, 1e-9, 1e-6])
def test_tiny_angles_keep_their_digits(angle: float) -> None:
    near = sphere.exp(np.array([angle, 0.0, 0.0]), NORTH)
    assert sphere.distance(NORTH, near) == pytest.approx(angle, rel=1e-12, abs=0.0)
    np.testing.assert_allclose(sphere.log(near, NORTH), [angle, 0, 0], rtol=1e-12)


@pytest.mark.parametrize("short_of", [1e-15, 1e-12, 1e-9, 1e-6])
def test_angles_near_a_half_turn_keep_their_digits(short_of: float) -> None:
    far = np.array([np.sin(short_of), 0.0, -np.cos(short_of)])
    assert np.pi - sphere.distance(NORTH, far) == pytest.approx(short_of, rel=1e-3, abs=5e-16)
    back = sphere.log(far, NORTH)
    np.testing.assert_allclose(back[1:], 0.0, atol=1e-16)
    np.testing.assert_allclose(sphere.exp(back, NORTH), far, rtol=0, atol=1e-15)


def test_log_of_the_antipode_takes_the_axis_farthest_from_the_base() -> None:
    np.testing.assert_allclose(sphere.log(-NORTH, NORTH), [np.pi, 0, 0])
    batch = sphere.log(np.stack([-NORTH, EAST]), NORTH)
    np.testing.assert_allclose(batch, [[np.pi, 0, 0], [np.pi / 2, 0, 0]], atol=1e-16)


def test_base_and_points_broadcast() -> None:
    points = sphere.normalise(np.random.default_rng(0).normal(size=(4, 5, 3)))
    assert sphere.log(points, NORTH).shape == (4, 5, 3)
    assert sphere.distance(NORTH, points).shape == (4, 5)
    assert sphere.exp(sphere.log(points, NORTH), NORTH).shape == (4, 5, 3)


@pytest.mark.parametrize("size", [1e-310, 1e-200, 1.0, 1e200])
def test_normalise_at_any_scale(size: float) -> None:
    unit = sphere.normalise(size * np.array([3.0, 0.0, 4.0]))
    np.testing.assert_allclose(unit, [0.6, 0.0, 0.8], rtol=1e-12)


def test_a_zero_vector_has_no_direction() -> None:
    with pytest.raises(InvalidInput, match="zero vector") as caught:
        sphere.normalise(np.array([[1.0, 0.0], [0.0, 0.0]]))
    assert caught.value.code == "zero_vector"


@pytest.mark.parametrize("bad", [np.zeros(3), np.array([0.0, 0.0, 1.1]), np.full(3, np.nan)])
def test_points_off_the_sphere_are_refused(bad: np.ndarray) -> None:
    for call in (
        lambda: sphere.log(bad, NORTH),
        lambda: sphere.log(NORTH, bad),
        lambda: sphere.exp(np.zeros(3), bad),
        lambda: sphere.distance(bad, NORTH),
        lambda: sphere.distance(NORTH, bad),
        lambda: sphere.karcher_mean(np.stack([NORTH, bad])),
    ):
        with pytest.raises(InvalidInput, match="normalise it first") as caught:
            call()
        assert caught.value.code == "not_on_sphere"


def test_the_mean_of_one_point_is_the_point() -> None:
    np.testing.assert_allclose(sphere.karcher_mean(NORTH[None]), NORTH, atol=1e-16)


def test_points_all_around_have_no_mean() -> None:
    around = np.array([[1.0, 0, 0], [-0.5, np.sqrt(0.75), 0], [-0.5, -np.sqrt(0.75), 0]])
    for points in (np.stack([NORTH, -NORTH]), around):
        with pytest.raises(InvalidInput, match="average is zero") as caught:
            sphere.karcher_mean(points)
        assert caught.value.code == "no_mean"


def test_a_mean_that_does_not_converge_is_said() -> None:
    points = sphere.normalise(np.array([[1.0, 0.0, 0.1], [0.0, 1.0, 0.1], [-0.9, 0.1, 0.3]]))
    with pytest.raises(InvalidInput, match=r"no convergence .* in 2 steps"):
        sphere.karcher_mean(points, max_iterations=2)
    assert np.linalg.norm(sphere.karcher_mean(points)) == pytest.approx(1.0)
