"""Everything that is measured of several futures, and the page that shows it."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import SEEN_FRAMES
from models.data.msrc12 import read_streams
from models.data.splits import cmu_split, synthetic_split
from models.data.windows import Recording, cut
from models.evaluation.critic_features import features_report
from models.evaluation.figures.futures import (
    counts_plot,
    features_plot,
    losses_plot,
    quality_plot,
)
from models.evaluation.futures_losses import losses_report
from models.evaluation.gestures import Classify, Predict
from models.evaluation.page import plot_section, write_page
from models.evaluation.sampled import Draw, drawn_figures, trained_sampler
from models.evaluation.several import live_takes, real_gestures, several_report
from models.hp_gan.judge import JUDGED_REAL
from models.hp_gan.sampler import Sampler, random_vectors
from models.hp_gan.train import load_hp_gan
from models.ma_wgan.config import CONFIGS
from models.ma_wgan.network import Predictor
from models.ma_wgan.train import load_predictor
from models.ma_wgan.train import train as train_ma_wgan
from models.training.run import INFO, Run

STRIDE = 50
MA_WGAN = CONFIGS["server_noise"]
DRAWS = 4


def futures_report(
    classify: Classify,
    predict: Predict,
    draw: Draw,
    runs: Path,
    data: Path,
    cache: Path,
    report: Path | None = None,
) -> dict[str, Any]:
    """Figures of the sampler, of its losses and features, and of what its futures are worth.

    Args:
        classify: motion (B, 75, 9, 3) -> probabilities (B, C).
        predict: seen (B, 25, 9, 3) -> the forecast (B, 50, 9, 3).
        draw: The sampler that is measured.
        runs: Folder of HP-GAN's run ``hp_gan``, of those of its losses and of the manifold-aware
            GAN that stands beside it, which are trained where they are missing.
        data: Folder that holds the set folders.
        cache: Folder of generated recordings.
        report: Folder for a page, or None.
    """
    torch.set_num_threads(1)
    takes = synthetic_split(cache, "test")
    held = {"synthetic": _held(takes), "cmu": _held(cmu_split(data, "test"))}
    generator, critic, judge = load_hp_gan(runs / "hp_gan")
    drawn = {name: draw(seen, DRAWS) for name, (seen, _) in held.items()}
    with torch.no_grad():
        real = {
            name: judge.quality(*map(torch.from_numpy, pair)).numpy() for name, pair in held.items()
        }
    losses = losses_report(runs, held, data, cache)
    streams = read_streams(data / "msrc12")
    features = features_report(critic, generator.config, streams)
    lived, gestures = live_takes(takes), real_gestures(streams)
    table = random_vectors(MA_WGAN.network.noise)
    other = trained_sampler(Sampler(_ma_wgan(runs / "ma_wgan", data, cache), judge, table).eval())
    found = {
        "sampler": {
            name: {
                **drawn_figures(drawn[name], seen, true),
                "real_plausible": round(float((real[name] > JUDGED_REAL).mean()), 4),
            }
            for name, (seen, true) in held.items()
        },
        "losses": losses,
        "features": features,
        **several_report(classify, predict, draw, lived, gestures),
        "ma_wgan": {
            "sampler": {
                name: drawn_figures(other(seen, DRAWS), seen, true)
                for name, (seen, true) in held.items()
            },
            **several_report(classify, predict, other, lived, gestures),
        },
    }
    if report is not None:
        plots = [
            losses_plot(losses),
            quality_plot(
                np.concatenate(list(real.values())),
                np.concatenate([each.quality.ravel() for each in drawn.values()]),
            ),
            features_plot(features["shares"]),
            counts_plot(found["synthetic"], "Virtual people"),
            counts_plot(found["msrc12"], "The first second of real people's gestures"),
        ]
        write_page(
            report,
            title="Several futures",
            kind="Several futures",
            heading="Futures that are drawn, judged and averaged",
            lead="Virtual people whom no training has seen (synthetic), CMU's test files, and "
            "MSRC-12, which is for evaluation only.",
            key="",
            body="".join(map(plot_section, plots)),
        )
    return found


def _ma_wgan(place: Path, data: Path, cache: Path) -> Predictor:
    """The manifold-aware GAN with noise of its own, trained unless its run is there."""
    if not (place / INFO).exists():
        command = "python -m models train ma_wgan --config server_noise --data DIR --out RUN"
        train_ma_wgan(MA_WGAN, Run(place, MA_WGAN, 0, command, resume=False), data, cache)
    return load_predictor(place)


def _held(recordings: Sequence[Recording]) -> tuple[Float32, Float32]:
    """Seen (N, 25, 9, 3) and true future (N, 50, 9, 3) of windows 2 s apart, metres."""
    windows = cut(recordings, STRIDE)
    observed, clean = windows.frames(torch.arange(len(windows)))
    seen, true = observed[:, :SEEN_FRAMES].contiguous(), clean[:, SEEN_FRAMES:].contiguous()
    return seen.numpy(), true.numpy()
