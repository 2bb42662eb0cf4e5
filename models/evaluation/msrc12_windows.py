"""MSRC-12's twelve gestures, told by people that no model of the benchmark has seen.

Every tag gives a window of 3 s that starts 1.5 s before it; the seen second ends half a second
before the gesture's mark. The classifiers are trained on the other people of each rotation, here
and for this purpose only. The predictors are frozen and have seen nobody of the set.
"""

from pathlib import Path
from typing import Any

import numpy as np
import torch

from models.data.msrc12 import TAGS, folds, read_streams, tag_windows
from models.data.windows import Augmentation
from models.evaluation.forecasters import BENCHMARKS, SERVER_BUNDLE
from models.evaluation.rows import (
    Bundled,
    RowResult,
    Split,
    paired_p_value,
    recall_by_class,
    row_configs,
    train_rows,
)
from models.interformer.config import NetworkConfig, TrainConfig

SHIFT = 8
"""Training windows start up to 0.32 s earlier or later than those that are tested."""
CLASSIFIER = TrainConfig(
    network=NetworkConfig(classes=len(TAGS)),
    steps=1_200,
    true_future=0.0,
    last_frame=0.0,
    validate_every=200,
    augmentation=Augmentation(yaw=0.35, scale=0.1, noise_m=0.01, drop=0.05),
)
PREDICTORS = {"ma_wgan": SERVER_BUNDLE, "simlpe": BENCHMARKS / "simlpe_core"}
"""Trained on virtual people and CMU: what they expect of those who train the classifier is no
better than what they expect of those who test it."""


def msrc12_report(data: Path, folder: Path, seed: int = 0) -> dict[str, Any]:
    """Train and test all rows in three rotations.

    Args:
        data: Folder that holds ``msrc12/``.
        folder: Where the runs are kept; those that are there are only measured again.
        seed: Of every training.
    """
    torch.set_num_threads(1)
    predictors = {name: Bundled(bundle) for name, bundle in PREDICTORS.items()}
    rows = row_configs(CLASSIFIER, tuple(predictors))
    streams = read_streams(data / "msrc12")
    rotations = []
    for number, fold in enumerate(folds([one.subject for one in streams])):
        place = folder / f"rotation_{number}"
        split = Split(
            tag_windows(streams, fold.train, SHIFT),
            tag_windows(streams, fold.validation),
            tag_windows(streams, fold.test),
        )
        rotations.append(train_rows(rows, predictors, split, place, seed))
    return _summary(rotations)


def _summary(rotations: list[dict[str, RowResult]]) -> dict[str, Any]:
    rows: dict[str, Any] = {}
    for name in rotations[0]:
        results = [rotation[name] for rotation in rotations]
        shares = [float(result.right.mean()) for result in results]
        rows[name] = {
            "accuracy": round(float(np.mean(shares)), 4),
            "per_class": recall_by_class(results, TAGS),
            "rotations": [round(share, 4) for share in shares],
        }
    right = {
        name: np.concatenate([rotation[name].right for rotation in rotations])
        for name in rotations[0]
    }
    return {
        "rows": rows,
        "p_value": paired_p_value(right["1s+ma_wgan"], right["1s"]),
        "windows": len(right["1s"]),
    }
