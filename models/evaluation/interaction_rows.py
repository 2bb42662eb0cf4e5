"""Generators of reactions, trained and measured: the paper's four rows, and folds of people."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch

from agent_server.errors import ConfigError
from models.data.interactions import SBU, SBU_FOLDS, InteractionSet, Pairs, held_out
from models.evaluation.forecasters import BENCHMARKS
from models.evaluation.interaction import DRAWS, JUDGES, PUBLISHED, Court, React, stand_still
from models.interformer.generator.config import ABLATIONS, CONFIGS, TrainConfig, ablated
from models.interformer.generator.generate import Core, TorchCore, generate
from models.interformer.generator.onnx_core import OnnxCore
from models.interformer.generator.train import load_generator, longest_of, train_on
from models.training.run import INFO, Run

SEEDS = {"S1": (0,), "S2": (0,), "S3": (0,), "S4": (0, 1, 2)}
"""Trainings of each row."""


def reacting(core: Core, latent: int, frames: int) -> React:
    """A generator as courts see it; the seed is that of its noise."""

    def react(pairs: Pairs, seed: int) -> tuple[torch.Tensor, torch.Tensor]:
        generator = torch.Generator().manual_seed(seed)
        noise = torch.randn(len(pairs), latent, generator=generator)
        given = pairs.reaction[:, :1]
        longest = longest_of(pairs, frames)
        return generate(core, pairs.action, pairs.lengths, given, noise, longest)

    return react


def bundle_report(
    spec: InteractionSet, data: Path, runs: Path, model: str = "interformer"
) -> dict[str, Any]:
    """A research bundle on the thesis's test split, beside real reactions and standing still.

    Args:
        spec: The data set.
        data: Folder that holds the set folders.
        runs: Where the judges are kept.
        model: Name of the bundle, without the set's.
    """
    core, manifest = OnnxCore.of(BENCHMARKS / f"{model}_{spec.name}")
    court = Court.thesis(spec, data, runs)
    return {
        **_setting(court),
        model: court.measure(reacting(core, manifest.latent, manifest.frames)),
    }


def rows_report(
    spec: InteractionSet, data: Path, runs: Path, rows: Sequence[str] | None = None
) -> dict[str, Any]:
    """The paper's rows, each trained unless its run is in ``runs``.

    Args:
        spec: The data set.
        data: Folder that holds the set folders.
        runs: Where runs and judges are kept.
        rows: Which of :data:`ABLATIONS`; None for all.

    Raises:
        ConfigError: If there is no such row.
    """
    rows = list(ABLATIONS) if rows is None else rows
    for row in rows:
        if row not in ABLATIONS:
            raise ConfigError(f"row '{row}' is none of {', '.join(ABLATIONS)}")
    court = Court.thesis(spec, data, runs)
    training = Pairs.of(spec.read(data, "train"), spec.labels)
    found = _setting(court)
    for row in rows:
        config = ablated(CONFIGS[spec.name], row)
        each = [
            court.measure(_trained(config, training, runs / f"{spec.name}_{row}_{seed}", seed))
            for seed in SEEDS[row]
        ]
        found[row] = {"seeds": each, "accuracy": _spread([one["accuracy"] for one in each])}
    return found


def folds_report(data: Path, runs: Path, row: str = "S4") -> dict[str, Any]:
    """SBU's five folds: judges and generator are trained on other pairs of people."""
    everybody = [*SBU.read(data, "train"), *SBU.read(data, "test")]
    config = ablated(CONFIGS["sbu"], row)
    found = []
    for number, fold in enumerate(SBU_FOLDS):
        training, test = held_out(everybody, fold)
        court = Court.of(SBU, training, test, runs)
        pairs = Pairs.of(training, SBU.labels)
        react = _trained(config, pairs, runs / f"sbu_fold{number}_{row}", 0)
        found.append({**_setting(court), row: court.measure(react)})
    accuracies = {
        name: _spread([one[name]["accuracy"] for one in found])
        for name in ("real", "zero_velocity", row)
    }
    return {"folds": found, "accuracy": accuracies}


def _trained(config: TrainConfig, training: Pairs, place: Path, seed: int) -> React:
    if not (place / INFO).exists():
        run = Run(place, config, seed, "python -m models evaluate interaction", resume=False)
        train_on(config, run, training)
    network = load_generator(place)
    return reacting(TorchCore(network), network.config.latent, network.config.frames)


def _setting(court: Court) -> dict[str, Any]:
    return {
        "test_interactions": len(court.test),
        "judges": JUDGES,
        "draws": DRAWS,
        "published": PUBLISHED[court.spec.name],
        "real": court.real(),
        "zero_velocity": court.measure(stand_still),
    }


def _spread(values: Sequence[float]) -> dict[str, float]:
    return {
        "mean": round(float(np.mean(values)), 3),
        "lowest": round(min(values), 3),
        "highest": round(max(values), 3),
    }
