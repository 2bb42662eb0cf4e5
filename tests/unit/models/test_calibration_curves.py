"""Reliability, risk over coverage, and whether a gain is more than chance."""

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from hypothesis import given, settings
from hypothesis import strategies as st

from agent_server.domain.skeleton import CoreJoint
from models.evaluation.calibration_curves import reliability, risk_coverage
from models.evaluation.gestures import calibration_error
from models.evaluation.prediction_gain import Verdict, gain_of, hand_distances
from models.evaluation.readings import HELD, PREDICTED, TRUE


def sure(*levels: float) -> np.ndarray:
    """Rows of two classes whose first one has these probabilities, all of them over a half."""
    return np.array([[level, 1 - level] for level in levels], np.float32)


RIGHT, WRONG = 0, 1


@given(st.integers(0, 2**32 - 1), st.integers(1, 60))
@settings(derandomize=True, deadline=None, max_examples=40)
def test_bins_give_the_calibration_error(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    rows = rng.dirichlet(np.ones(4), count).astype(np.float32)
    labels = rng.integers(0, 4, count)
    found = reliability(rows, labels)
    filled = found.counts > 0
    gaps = np.abs(found.confidence - found.accuracy)[filled]
    weighted = float((gaps * found.counts[filled]).sum() / count)
    assert weighted == pytest.approx(calibration_error(rows, labels), abs=1e-6)
    assert found.counts.sum() == count
    assert np.isnan(found.accuracy[~filled]).all()


def test_boasting_is_over_and_modesty_under() -> None:
    assert reliability(sure(0.9, 0.9), np.array([RIGHT, WRONG])).over == pytest.approx(0.4)
    assert reliability(sure(0.6, 0.6), np.array([RIGHT, RIGHT])).over == pytest.approx(-0.4)


def test_risk_is_of_the_surest_first() -> None:
    curve = risk_coverage(sure(0.6, 0.9, 0.8, 0.7), np.array([WRONG, RIGHT, WRONG, RIGHT]))
    assert curve.thresholds == pytest.approx([0.9, 0.8, 0.7, 0.6])
    assert curve.coverage.tolist() == [0.25, 0.5, 0.75, 1]
    assert curve.risk == pytest.approx([0, 1 / 2, 1 / 3, 1 / 2])
    assert curve.area == pytest.approx((0 + 1 / 2 + 1 / 3 + 1 / 2) / 4)


def test_equally_sure_windows_come_in_together() -> None:
    one = risk_coverage(sure(0.8, 0.8, 0.8, 0.8), np.array([RIGHT, RIGHT, WRONG, WRONG]))
    other = risk_coverage(sure(0.8, 0.8, 0.8, 0.8), np.array([WRONG, WRONG, RIGHT, RIGHT]))
    assert one.coverage.tolist() == other.coverage.tolist() == [1]
    assert one.area == other.area == 0.5


def gain(predicted: list[bool], held: list[bool], true: list[bool]):  # type: ignore[no-untyped-def]
    right = {PREDICTED: np.array(predicted), HELD: np.array(held), TRUE: np.array(true)}
    return gain_of(right, np.ones(len(predicted), np.bool_))


def test_a_gain_must_be_more_than_chance() -> None:
    sides = [True] * 12, [False] * 12, [True] * 12
    helps = gain(sides[0], sides[1], sides[2])
    assert (helps.verdict, helps.points, helps.room) == (Verdict.HELPS, 100, 100)
    assert gain(sides[1], sides[0], sides[2]).verdict is Verdict.HURTS
    few = gain([True] * 4 + [False] * 8, [False] * 12, sides[2])
    assert few.points == pytest.approx(100 / 3)
    assert few.p_value == pytest.approx(2 * 0.5**4)
    assert few.verdict is Verdict.EVEN


def test_a_gain_is_of_the_chosen_windows() -> None:
    right = {
        PREDICTED: np.array([True, False]),
        HELD: np.array([False, False]),
        TRUE: np.array([True, True]),
    }
    found = gain_of(right, np.array([False, True]))
    assert (found.windows, found.points, found.room) == (1, 0, 100)


def test_hands_are_as_far_off_as_both_wrists_on_average() -> None:
    true = np.zeros((1, 50, 9, 3), np.float32)
    future = true.copy()
    future[:, :, CoreJoint.HEAD] = 9
    future[:, 9, CoreJoint.LEFT_WRIST, 0] = 0.1  # 400 ms ahead
    future[:, 24, CoreJoint.RIGHT_WRIST] = (0, 0.3, 0.4)  # 1 s
    future[:, 49, [CoreJoint.LEFT_WRIST, CoreJoint.RIGHT_WRIST], 2] = 0.2  # 2 s
    assert hand_distances(future, true) == pytest.approx(np.array([[50, 250, 200]]), rel=1e-5)
