"""From a training run to the bundle of a predictor."""

from pathlib import Path
from typing import Any

import torch

from agent_server.domain.motion import PREDICTED_FRAMES, SEEN_FRAMES
from agent_server.inference.manifest import Manifest
from models.data.splits import cmu_split, synthetic_split
from models.data.windows import cut
from models.evaluation.report import prediction_report
from models.export.bundle import Export, write_bundle
from models.export.card import predictor_card
from models.export.session import OnnxModel
from models.ma_wgan.train import load_predictor
from models.training.run import read_info

CHECKED_WINDOWS = 128


def export_predictor(run: Path, folder: Path, version: str, data: Path, cache: Path) -> Manifest:
    """Write the bundle of the run's best network, measured on held-out people and recordings."""
    half = CHECKED_WINDOWS // 2
    windows = torch.cat(
        [
            held.frames(torch.linspace(0, len(held) - 1, half).long())[0][:, :SEEN_FRAMES]
            for held in (cut(synthetic_split(cache, "test")), cut(cmu_split(data, "test")))
        ]
    )

    def measure(path: Path) -> dict[str, Any]:
        return prediction_report(OnnxModel(path), data, cache)

    export = Export(
        name=folder.name,
        version=version,
        task="predict",
        network=load_predictor(run),
        windows=windows.numpy(),
        output_frames=PREDICTED_FRAMES,
        labels=(),
        info=read_info(run),
    )
    return write_bundle(export, folder, measure, predictor_card)
