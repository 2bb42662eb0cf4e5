import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agent_server.errors import InvalidInput
from models.evaluation.motion_sets import diversity_score, frechet_distance, spread


def features(seed: int, count: int = 40, width: int = 3) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(count, width))


@given(st.integers(0, 100))
@settings(max_examples=20, derandomize=True, deadline=None)
def test_equal_sets_have_no_distance_and_no_other_spread(seed: int) -> None:
    one = features(seed)
    assert frechet_distance(one, one) == pytest.approx(0, abs=1e-6)
    assert diversity_score(one, one[::-1]) == pytest.approx(0, abs=1e-9)


@given(st.integers(0, 100))
@settings(max_examples=20, derandomize=True, deadline=None)
def test_sets_that_are_shifted_lie_the_square_of_the_shift_apart(seed: int) -> None:
    one = features(seed)
    assert frechet_distance(one, one + np.array([3, 4, 0])) == pytest.approx(25)


def test_normal_distributions_along_axes_have_the_known_distance() -> None:
    # Deviations s and t along an axis add (s - t)^2.
    square = np.array([[1, 1], [1, -1], [-1, 1], [-1, -1]]) * np.sqrt(3 / 4)
    assert frechet_distance(square * [1, 2], square * [3, 2]) == pytest.approx(4)


def test_the_spread_is_the_mean_distance_of_two() -> None:
    assert spread(np.array([[0.0, 0], [3, 4], [0, 0]])) == pytest.approx((5 + 0 + 5) / 3)


@pytest.mark.parametrize(("factor", "score"), [(2.0, 100), (0.5, 50), (0.0, 100), (1.0, 0)])
def test_the_diversity_score_is_per_cent_of_the_real_spread(factor: float, score: float) -> None:
    one = features(1)
    assert diversity_score(factor * one, one) == pytest.approx(score)


def test_one_motion_has_no_spread() -> None:
    with pytest.raises(InvalidInput, match="a set of 1 motions"):
        diversity_score(features(0, count=1), features(1))
    with pytest.raises(InvalidInput, match="give two or more"):
        frechet_distance(features(0), features(1, count=1))
