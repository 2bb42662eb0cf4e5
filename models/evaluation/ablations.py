"""Training and measuring the ablations of the predictor."""

from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import nn

from agent_server.domain.arrays import Float32
from models.evaluation.forecasters import Forecaster, Predict
from models.evaluation.futures import futures_figures
from models.evaluation.prediction import action_figures, average, outcomes
from models.evaluation.protocols import protocol_named
from models.evaluation.recursion import recursion_errors
from models.ma_wgan.ablations import ROWS
from models.ma_wgan.train import load_predictor, train
from models.training.run import INFO, Run

PROTOCOL = "h36m-256"
CHUNK = 512
KEYS = ("mpjpe", "mpjs_error", "jump_mm", "bone_error_mm")


def ablation_report(folder: Path, seed: int, data: Path, cache: Path) -> dict[str, Any]:
    """Average figures of every row under ``h36m-256``, and the recursion of the first.

    Args:
        folder: Where the runs are kept, one folder a row.
        seed: Of every training.
        data: Folder that holds the set folders.
        cache: Folder of generated recordings.
    """
    protocol = protocol_named(PROTOCOL)
    windows = protocol.windows(data, cache)
    rows: dict[str, Any] = {}
    for name, config in ROWS.items():
        place = folder / name.replace(" ", "_").replace(",", "")
        if not (place / INFO).exists():
            train(
                config,
                Run(place, config, seed, f"python -m models ablate ({name})", False),
                data,
                cache,
            )
        network = load_predictor(place)
        model = Forecaster(name, in_numpy(network), config.network.seen, config.network.joints, 0)
        found = average(action_figures(protocol, outcomes(model, protocol, windows)))
        rows[name] = {key: found[key] for key in KEYS}
        if name == "all":
            rows[name]["recursion"] = recursion_errors(network, config.network.seen, data)
        if config.network.noise:
            drawn = futures_figures(network, windows, protocol.layout.joints, seed)
            rows[name]["futures"] = drawn
    return rows


def in_numpy(network: nn.Module, chunk: int = CHUNK) -> Predict:
    """A network of torch as a function of arrays."""

    @torch.no_grad()
    def predict(seen: Float32) -> Float32:
        parts = [network(part).numpy() for part in torch.from_numpy(seen).split(chunk)]
        return np.concatenate(parts)

    return predict
