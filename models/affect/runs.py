"""A training run of an affect model on disk."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch

from agent_server.domain.arrays import Float32
from agent_server.errors import InvalidInput
from models.affect.config import AffectConfig
from models.affect.data import FaceFeatures, features_of, features_of_clips
from models.affect.network import AffectNetwork
from models.affect.train import Validated, train_and_calibrate
from models.affect.views import PLAIN, Pipeline, look_at
from models.data.afew_va import read_afew_va
from models.data.labelled_faces import FOLDER, LABELS, read_faces, test_split
from models.training.run import Run, read_best, read_info

EXAMPLES = 64
"""Features that are kept to check an export with."""


@dataclass(frozen=True, slots=True)
class Trained:
    """What a run came to.

    Attributes:
        network: Trained on all training faces.
        validated: Estimates of cross-validation.
        examples: Shape (64, D): features of some training faces.
        info: What the run says of itself.
    """

    network: AffectNetwork
    validated: Validated
    examples: Float32
    info: Mapping[str, Any]


def training_faces(config: AffectConfig, data: Path, bundles: Path, cache: Path) -> FaceFeatures:
    """Faces to train on: pictures with a ``labels.csv``, or clips of AFEW-VA for 68 points.

    Of pictures, the test fifth is left out.
    """
    if (data / LABELS).exists() or (data / FOLDER).exists():
        faces = read_faces(data)
        views = look_at(faces, Pipeline(bundles), cache)
        train, _ = test_split(faces)
        return features_of(config.source, views, faces.affect).take(np.array(train))
    if config.source != "points68":
        raise InvalidInput(
            f"{data} has no {LABELS}, and clips of AFEW-VA have 68 points only: train with "
            "--input points68, or give a folder of pictures"
        )
    return features_of_clips(read_afew_va(data))


def train_run(config: AffectConfig, faces: FaceFeatures, run: Run, folds: int) -> Validated:
    """Cross-validate, train on all faces, and keep what came of it."""
    seed = run.info["seed"]
    network, validated, wall_s = train_and_calibrate(config, faces, folds, seed)
    seen = faces.features[faces.found[:, PLAIN], PLAIN]
    chosen = np.linspace(0, len(seen) - 1, EXAMPLES).astype(int)
    state = {
        "network": network.state_dict(),
        "estimates": torch.from_numpy(validated.estimates),
        "affect": torch.from_numpy(validated.affect),
        "examples": torch.from_numpy(seen[chosen]),
    }
    run.save(state, wall_s)
    run.save_best(state)
    return validated


def read_run(folder: Path) -> Trained:
    """What a run came to.

    Raises:
        InvalidInput: If the folder holds no run.
    """
    info = read_info(folder)
    state = read_best(folder)
    settings = dict(info["config"])
    settings["hidden"] = tuple(settings["hidden"])
    weights = state["network"]
    order, signs = weights["order"].tolist(), weights["signs"].tolist()
    network = AffectNetwork(AffectConfig(**settings), len(order), order, signs)
    network.load_state_dict(weights)
    validated = Validated(state["estimates"].numpy(), state["affect"].numpy())
    return Trained(network.eval(), validated, state["examples"].numpy(), info)
