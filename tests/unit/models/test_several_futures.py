"""Figures of several futures, against plain ways of computing them."""

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.domain.gesture import GESTURES  # noqa: E402
from agent_server.domain.motion import Forecast, Quality, Window  # noqa: E402
from agent_server.inference.fake import LastFramePredictor  # noqa: E402
from agent_server.stages.classify import classify  # noqa: E402
from agent_server.stages.futures import draw_futures  # noqa: E402
from agent_server.stages.predict import predict  # noqa: E402
from models.evaluation.figures.futures import counts_plot, features_plot, losses_plot, quality_plot  # noqa: E402
from models.evaluation.sampled import Drawn, drawn_figures, trained_sampler  # noqa: E402
from models.evaluation.several import COUNTS, Futures, read_futures  # noqa: E402
from models.hp_gan.config import NetworkConfig  # noqa: E402
from models.hp_gan.judge import Judge  # noqa: E402
from models.hp_gan.sampler import Sampler, random_vectors  # noqa: E402
from models.ma_wgan.config import NetworkConfig as MaWganConfig  # noqa: E402
from models.ma_wgan.network import Predictor  # noqa: E402


def random_futures(windows: int = 7) -> Futures:
    rng = np.random.default_rng(0)
    rows = rng.dirichlet(np.ones(7), (windows, 11)).astype(np.float32)
    return Futures(rows[:, 0], rows[:, 1:], rng.random((windows, 10)) < 0.5)


def test_one_future_is_the_forecast() -> None:
    futures = random_futures()
    np.testing.assert_array_equal(futures.together(1), futures.expected)
    assert not futures.spread(1).any()


@pytest.mark.parametrize("count", COUNTS)
def test_averages_are_those_of_a_loop(count: int) -> None:
    futures = random_futures()
    spread = futures.spread(count)
    for at, mean in enumerate(futures.together(count)):
        kept = [futures.expected[at]]
        kept += [futures.drawn[at, k] for k in range(count - 1) if futures.good[at, k]]
        np.testing.assert_allclose(mean, np.mean(kept, axis=0), rtol=1e-5)
        best = mean.argmax()
        assert spread[at] == pytest.approx(np.std([row[best] for row in kept]), abs=1e-6)
    np.testing.assert_allclose(
        futures.alone(count), futures.drawn[:, :count].mean(axis=1), rtol=1e-6
    )


def test_the_evaluation_names_windows_as_the_live_stages_do() -> None:
    rng = np.random.default_rng(1)
    seen = (0.1 * rng.standard_normal((3, 25, 9, 3))).astype(np.float32)
    seen -= seen[:, -1:, 2:3]  # as the server normalises: the navel of the last frame at 0
    drawn = seen[:, None, -1:] + 0.2 * rng.standard_normal((3, 10, 50, 9, 3)).astype(np.float32)
    quality = rng.random((3, 10)).astype(np.float32)

    class Named:
        labels = GESTURES

        def classify(self, motion):
            logits = 3 * motion[:, 60, :7, 1]
            rows = np.exp(logits)
            return (rows / rows.sum(axis=1, keepdims=True)).astype(np.float32)

    class Table:
        name = "table"

        def draw(self, given, count):
            at = int(np.abs(seen - given).sum(axis=(1, 2, 3)).argmin())
            return drawn[at, :count], quality[at, :count]

    found = read_futures(
        Named().classify, LastFramePredictor().predict, lambda *_: Drawn(drawn, quality), seen
    )
    windows = [
        Window(i, 0, 0, 1, one, np.ones((25, 9), np.float32), Quality(1, 0, 0))
        for i, one in enumerate(seen)
    ]
    for count in COUNTS[1:]:
        forecasts = draw_futures(
            Table(), count, 0.5, windows, predict(LastFramePredictor(), windows)
        )
        assert all(isinstance(each, Forecast) for each in forecasts)
        live = classify(Named(), windows, forecasts)
        np.testing.assert_allclose(
            found.together(count), [row.probabilities for row in live], atol=1e-6
        )


def test_a_manifold_aware_gan_with_noise_draws_too() -> None:
    torch.manual_seed(0)
    config = MaWganConfig(output="curve", noise=4, channels=8, blocks=1)
    reference = torch.nn.functional.normalize(torch.randn(9, 150), dim=1)
    judge = Judge(NetworkConfig(judge_width=8))
    draw = trained_sampler(
        Sampler(Predictor(config, reference).eval(), judge, random_vectors(4)).eval()
    )
    seen = 0.1 * np.random.default_rng(0).standard_normal((2, 25, 9, 3)).astype(np.float32)
    drawn = draw(seen, 3)
    assert drawn.futures.shape == (2, 3, 50, 9, 3)
    assert drawn.quality.shape == (2, 3)
    assert np.abs(np.diff(drawn.futures, axis=1)).max() > 0


def test_distances_of_drawn_futures_are_in_millimetres() -> None:
    seen = np.zeros((2, 25, 9, 3), np.float32)
    true = np.zeros((2, 50, 9, 3), np.float32)
    futures = np.zeros((2, 3, 50, 9, 3), np.float32)
    futures[:, 1, ..., 0], futures[:, 2, ..., 0] = 0.01, 0.03
    figures = drawn_figures(Drawn(futures, np.array([[0.9, 0.4, 0.6]] * 2)), seen, true)
    assert figures["error_mm"] == pytest.approx(40 / 3, abs=0.01)
    assert figures["best_mm"] == figures["still_mm"] == figures["true_seam_mm"] == 0
    assert figures["mean_mm"] == pytest.approx(40 / 3, abs=0.01)
    assert figures["apart_mm"] == pytest.approx(15)
    assert figures["jump_mm"] == figures["seam_mm"] == pytest.approx(40 / 3, abs=0.01)
    assert figures["plausible"] == pytest.approx(2 / 3, abs=1e-4)


def test_titles_of_figures_say_what_the_numbers_say() -> None:
    row = {"apart_mm": 30.0, "seam_mm": 4.0, "true_seam_mm": 3.0}
    rows = {
        "all": {"synthetic": row},
        "without diversity": {"synthetic": {**row, "apart_mm": 8.0}},
        "without consistency": {"synthetic": {**row, "seam_mm": 9.0}},
    }
    assert "30 mm apart with the diversity loss and 8 mm without" in losses_plot(rows).title
    plot = quality_plot(np.array([0.9, 0.7]), np.array([0.1, 0.6, 0.2, 0.3]))
    assert "100 % of real" in plot.title
    assert "25 % of generated" in plot.title
    share = {
        "goal": 0.5,
        "epochs_to_same": {"discriminator": 2, "random": 3},
        "accuracy": {"discriminator": [0.2, 0.5, 0.6], "random": [0.1, 0.3, 0.5]},
    }
    assert "100 %: 2 against 3" in features_plot({"1": share, "0.5": share}).title
    scores = {"accuracy": 0.9, "ece": 0.02}
    named = {"windows": 10, "rows": {"forecast": scores, "10_futures": {**scores, "ece": 0.01}}}
    plot = counts_plot(named, "Virtual people")
    assert "calibration error 1.0 and 2.0 %" in plot.title
    assert plot.png.startswith(b"\x89PNG")
