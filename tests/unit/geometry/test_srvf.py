import numpy as np
import pytest

from agent_server.errors import InvalidInput
from agent_server.geometry import srvf


def test_values_on_a_curve_done_by_hand() -> None:
    # Steps of length 4, 0 and 9 along x, nothing, and -y.
    curve = np.array([[1.0, 1.0], [5.0, 1.0], [5.0, 1.0], [5.0, -8.0]])
    np.testing.assert_array_equal(srvf.srvf(curve), [[2, 0], [0, 0], [0, -3]])
    assert srvf.curve_length(curve) == 13.0
    q, length = srvf.to_sphere(curve)
    assert length == 13.0
    np.testing.assert_allclose(q, np.array([[2, 0], [0, 0], [0, -3]]) / np.sqrt(13.0))


def test_a_curve_that_stands_still_is_zero_and_comes_back() -> None:
    curve = np.full((2, 5, 27), 0.7)
    q, length = srvf.to_sphere(curve)
    np.testing.assert_array_equal(q, np.zeros((2, 4, 27)))
    np.testing.assert_array_equal(length, [0.0, 0.0])
    np.testing.assert_array_equal(srvf.srvf(curve), q)
    np.testing.assert_array_equal(srvf.from_sphere(q, length, curve[:, 0]), curve)


@pytest.mark.parametrize("size", [1e-300, 1e-200, 1e200])
def test_steps_whose_squares_leave_the_range_of_floats(size: float) -> None:
    curve = size * np.array([[0.0, 0.0], [3.0, 4.0], [3.0, 5.0]])
    assert srvf.curve_length(curve) == pytest.approx(6.0 * size, rel=1e-15, abs=0.0)
    q, length = srvf.to_sphere(curve)
    np.testing.assert_allclose((q * q).sum(), 1.0)
    np.testing.assert_allclose(srvf.from_sphere(q, length, curve[0]), curve, rtol=1e-14)


def test_one_start_serves_a_batch() -> None:
    q = np.ones((3, 4, 2))
    curves = srvf.inverse_srvf(q, np.array([1.0, 2.0]))
    assert curves.shape == (3, 5, 2)
    np.testing.assert_array_equal(curves[:, 0], [[1.0, 2.0]] * 3)


@pytest.mark.parametrize("shape", [(3,), (1, 3), (4, 1, 3)])
def test_a_single_point_is_no_curve(shape: tuple[int, ...]) -> None:
    for function in (srvf.srvf, srvf.to_sphere, srvf.curve_length):
        with pytest.raises(InvalidInput, match="at least two points") as caught:
            function(np.zeros(shape))
        assert caught.value.code == "too_short"


def test_refining_a_curve_converges_to_the_continuous_function() -> None:
    """q_t / sqrt(dt) tends to v / sqrt(|v|): a circle run through at growing speed."""

    def error(points: int) -> float:
        time = np.linspace(0.0, 1.0, points)
        angle = time + time**2
        q = srvf.srvf(np.stack([np.cos(angle), np.sin(angle)], axis=-1))
        middle = 0.5 * (time[1:] + time[:-1])
        angle, speed = middle + middle**2, 1 + 2 * middle
        exact = np.sqrt(speed)[:, None] * np.stack([-np.sin(angle), np.cos(angle)], axis=-1)
        return float(np.abs(q * np.sqrt(points - 1) - exact).max())

    assert error(1001) < 1e-6
    assert error(1001) == pytest.approx(error(101) / 100, rel=0.05)
