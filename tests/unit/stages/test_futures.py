"""Several futures: drawn beside the forecast, judged, classified on average."""

import numpy as np
import pytest

from agent_server.domain.motion import Forecast, Quality, Window
from agent_server.inference.fake import LastFramePredictor, RuleClassifier
from agent_server.service.models import Drawing, Models
from agent_server.service.worker import infer
from agent_server.stages.classify import classify
from agent_server.stages.futures import draw_futures
from agent_server.stages.predict import LAST_FRAME, hold_last, predict
from tests.support.models import RisingSampler


def window(index=0, height=1.0):
    rng = np.random.default_rng(index)
    positions = (height + 0.1 * rng.standard_normal((25, 9, 3))).astype(np.float32)
    return Window(index, 0, 0, 1, positions, np.ones((25, 9), np.float32), Quality(1, 0, 0))


def drawn_beside(sampler, count, seen):
    forecast = predict(LastFramePredictor(), [seen])
    return draw_futures(sampler, count, 0.5, [seen], forecast)[0]


def test_the_forecast_stays_and_others_come_beside_it_in_the_camera_frame():
    sampler, seen = RisingSampler(0.9, 0.8, 0.7), window()
    forecast = drawn_beside(sampler, 4, seen)
    assert sampler.asked == [3]
    np.testing.assert_array_equal(forecast.positions, np.repeat(seen.positions[-1:], 50, axis=0))
    assert forecast.futures.positions.shape == (3, 50, 9, 3)
    rise = forecast.futures.positions[..., 1] - seen.positions[-1, :, 1]
    np.testing.assert_allclose(rise[:, 0, 0], [0.1, 0.2, 0.3], atol=1e-6)
    assert not forecast.futures.positions.flags.writeable


def test_futures_of_low_quality_are_left_out_and_counted():
    forecast = drawn_beside(RisingSampler(0.9, 0.2, 0.5), 4, window())
    np.testing.assert_allclose(forecast.futures.quality, [0.9, 0.5])
    assert forecast.futures.drawn == 3
    spread = classify(RuleClassifier(lambda _: "idle"), [window()], [forecast])[0].spread
    assert (spread.futures, spread.left_out) == (3, 1)


def test_where_all_are_left_out_the_forecast_decides_alone():
    seen, classifier = window(), RuleClassifier(lambda _: "idle")
    alone = classify(classifier, [seen], predict(LastFramePredictor(), [seen]))[0]
    among = classify(classifier, [seen], [drawn_beside(RisingSampler(0.1, 0.1), 3, seen)])[0]
    np.testing.assert_array_equal(among.probabilities, alone.probabilities)
    assert not among.spread.deviations.any()


def test_probabilities_are_the_mean_over_futures_and_their_spread_its_deviation():
    def rule(motion):
        return "hello" if motion[-1, 2, 1] > 0.15 else "idle"  # the navel has risen

    classifier = RuleClassifier(rule)
    found = classify(
        classifier, [window()], [drawn_beside(RisingSampler(1.0, 1.0, 1.0), 4, window())]
    )[0]
    hello = found.labels.index("hello")
    # The forecast and the first draw say idle, the other two hello.
    assert found.probabilities[hello] == pytest.approx((2 * 0.01 + 2 * 0.94) / 4)
    assert found.spread.deviations[hello] == pytest.approx((0.94 - 0.01) / 2)
    assert found.probabilities.sum() == pytest.approx(1.0)


def test_windows_with_and_without_futures_keep_their_order_and_their_bits():
    classifier = RuleClassifier(lambda m: "hello" if m[0, 0, 0] > 0 else "idle")
    windows = [window(index) for index in range(4)]
    forecasts = predict(LastFramePredictor(), windows)
    mixed = [
        draw_futures(RisingSampler(1.0), 2, 0.5, [seen], [forecast])[0] if index % 2 else forecast
        for index, (seen, forecast) in enumerate(zip(windows, forecasts, strict=True))
    ]
    together = classify(classifier, windows, mixed)
    for seen, forecast, found in zip(windows, mixed, together, strict=True):
        alone = classify(classifier, [seen], [forecast])[0]
        assert found.probabilities.tobytes() == alone.probabilities.tobytes()
        assert (found.spread is None) == (forecast.futures is None)


def test_a_failed_forecast_stays_alone():
    sampler, seen = RisingSampler(1.0), window()
    held = hold_last(seen, "no such pose")
    assert draw_futures(sampler, 5, 0.5, [seen], [held]) == [held]
    assert sampler.asked == []


def test_a_sampler_that_fails_leaves_the_last_frame_and_says_why():
    forecast = drawn_beside(RisingSampler(fails=True), 5, window())
    assert (forecast.source, forecast.failure) == (LAST_FRAME, "the sampler is broken")
    assert forecast.futures is None


def test_the_worker_draws_only_where_it_is_told_to():
    predictor, classifier = LastFramePredictor(), RuleClassifier(lambda _: "idle")
    assert infer(Models(predictor, classifier), [window()])[0].classification.spread is None
    models = Models(predictor, classifier, drawing=Drawing(RisingSampler(1.0, 1.0), 3, 0.5))
    assert infer(models, [window()])[0].classification.spread.futures == 3
    assert models.hashes["rising_sampler"] == "4" * 12


def test_forecasts_of_one_future_say_nothing_of_others():
    assert Forecast(np.zeros((50, 9, 3), np.float32), "x").futures is None
