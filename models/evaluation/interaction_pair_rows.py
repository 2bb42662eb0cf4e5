"""BiGraphDiff measured: its bundle, and the paper's rows and ours, each trained where it is not."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import torch

from agent_server.errors import ConfigError
from models.bigraphdiff.config import ABLATIONS, CONFIGS, TrainConfig, ablated
from models.bigraphdiff.generate import Generator
from models.bigraphdiff.network import to_draw_with
from models.bigraphdiff.onnx_denoiser import read_generator
from models.bigraphdiff.train import load_denoiser, train_on
from models.bigraphdiff.words import tokens
from models.data.interaction_sets import two_person_set
from models.data.interactions import InteractionSet, Pairs
from models.evaluation.forecasters import BENCHMARKS
from models.evaluation.interaction_pairs import Interact, PairCourt
from models.training.run import INFO, Run

MODEL = "bigraphdiff"


def interacting(generator: Generator) -> Interact:
    """A generator as courts see it; the seed is that of its noise."""

    def interact(labels: torch.Tensor, lengths: torch.Tensor, seed: int) -> Pairs:
        return generator.interactions(labels, lengths, torch.Generator().manual_seed(seed))

    return interact


def run_generator(folder: Path, spec: InteractionSet) -> Generator:
    """The generator of a training run on a set."""
    network, normaliser = load_denoiser(folder)
    words = tokens(spec.labels)
    return Generator.of(to_draw_with(network), normaliser, words, network.config)


def pair_bundle_report(spec: InteractionSet, data: Path, runs: Path) -> dict[str, Any]:
    """The research bundle on the test split, beside real interactions and copies of training ones.

    Args:
        spec: The data set.
        data: Folder that holds the set folders.
        runs: Where the judges are kept.
    """
    generator, _ = read_generator(BENCHMARKS / f"{MODEL}_{spec.name}")
    court = PairCourt.of(spec, data, runs)
    return {**court.setting(), MODEL: court.measure(interacting(generator))}


def bundled_sets() -> list[InteractionSet]:
    """The sets that there is a bundle of."""
    places = sorted(BENCHMARKS.glob(f"{MODEL}_*"))
    return [two_person_set(place.name.removeprefix(f"{MODEL}_")) for place in places]


def pair_rows_report(
    spec: InteractionSet,
    data: Path,
    runs: Path,
    rows: Sequence[str] | None = None,
    steps: int | None = None,
) -> dict[str, Any]:
    """The paper's rows and ours, each trained unless its run is in ``runs``.

    Args:
        spec: The data set.
        data: Folder that holds the set folders.
        runs: Where runs and judges are kept.
        rows: Which of :data:`models.bigraphdiff.config.ABLATIONS`; None for all.
        steps: Updates of each row; None for those of the configuration.

    Raises:
        ConfigError: If there is no such row.
    """
    rows = list(ABLATIONS) if rows is None else rows
    for row in rows:
        if row not in ABLATIONS:
            raise ConfigError(f"row '{row}' is none of {', '.join(ABLATIONS)}")
    court = PairCourt.of(spec, data, runs)
    found = court.setting()
    for row in rows:
        config = ablated(CONFIGS[spec.name], row)
        config = replace(config, steps=steps or config.steps)
        place = runs / f"{MODEL}_{spec.name}_{row}_{config.steps}"
        _train_where_missing(config, court.training, place)
        found[row] = court.measure(interacting(run_generator(place, spec)))
    return found


def _train_where_missing(config: TrainConfig, training: Pairs, place: Path) -> None:
    if not (place / INFO).exists():
        run = Run(place, config, 0, "python -m models evaluate interaction", resume=False)
        train_on(config, run, training)
