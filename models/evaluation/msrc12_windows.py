"""MSRC-12's twelve gestures, told by people that no model of the benchmark has seen.

Every tag gives a window of 3 s that starts 1.5 s before it; the seen second ends half a second
before the gesture's mark. Predictors and classifiers are trained on the other people of each
rotation, here and for this purpose only: nothing of it ships. A predictor is frozen before a
classifier is trained on what it expects.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import nn

from models.data.msrc12 import (
    STREAM_CLASSES,
    TAGS,
    Fold,
    TaggedStream,
    folds,
    read_streams,
    tag_windows,
    tagged_recordings,
)
from models.data.windows import Augmentation, cut
from models.evaluation.rows import (
    RowResult,
    Split,
    compared,
    paired_p_value,
    recall_by_class,
    row_configs,
    train_rows,
)
from models.interformer.config import NetworkConfig, TrainConfig
from models.ma_wgan.config import SERVER
from models.ma_wgan.train import load_predictor
from models.ma_wgan.train import train_on as train_ma_wgan
from models.simlpe.config import CONFIGS
from models.simlpe.train import load_simlpe
from models.simlpe.train import train_on as train_simlpe
from models.training.run import INFO, Run
from models.training.source import TaggedSource, whole

SHIFT = 8
"""Training windows start up to 0.32 s earlier or later than those that are tested."""
CLASSIFIER = TrainConfig(
    network=NetworkConfig(classes=len(TAGS)),
    steps=1_200,
    true_future=0.5,
    last_frame=0.4,
    mixup=0.3,
    validate_every=200,
    augmentation=Augmentation(yaw=0.35, scale=0.1, noise_m=0.01, drop=0.05),
)
MA_WGAN = replace(SERVER, steps=1_200, validate_every=200)
SIMLPE = replace(CONFIGS["server"], steps=1_200, validate_every=200)
VALIDATION_STRIDE = 40
COMMAND = "python -m models evaluate gestures --benchmark msrc12 --data DIR"


def msrc12_report(data: Path, folder: Path, seed: int = 0) -> dict[str, Any]:
    """Train and test all rows in three rotations.

    Args:
        data: Folder that holds ``msrc12/``.
        folder: Where the runs are kept; those that are there are only measured again.
        seed: Of every training.
    """
    torch.set_num_threads(1)
    streams = read_streams(data / "msrc12")
    rotations = []
    for number, fold in enumerate(folds([one.subject for one in streams])):
        place = folder / f"rotation_{number}"
        predictors = fold_predictors(streams, fold, place, seed)
        rows = row_configs(CLASSIFIER, tuple(predictors))
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
            "nll": round(float(np.mean([result.nll for result in results])), 4),
        }
    right = {
        name: np.concatenate([rotation[name].right for rotation in rotations])
        for name in rotations[0]
    }
    return {
        "rows": rows,
        "p_value": paired_p_value(right["1s+ma_wgan"], right["1s"]),
        "windows": len(right["1s"]),
        "ma_wgan_against": {
            name: compared(right["1s+ma_wgan"], other)
            for name, other in right.items()
            if name != "1s+ma_wgan"
        },
    }


def fold_predictors(
    streams: Sequence[TaggedStream], fold: Fold, place: Path, seed: int
) -> dict[str, nn.Module]:
    """Both predictors, trained on the people of a rotation unless their runs are there."""
    held = cut(tagged_recordings(streams, fold.validation), VALIDATION_STRIDE, STREAM_CLASSES)
    source = TaggedSource(
        cut(tagged_recordings(streams, fold.train), classes=STREAM_CLASSES),
        tag_windows(streams, fold.train, SHIFT),
        {"msrc12": whole(held)},
    )
    if not (place / "ma_wgan" / INFO).exists():
        train_ma_wgan(MA_WGAN, Run(place / "ma_wgan", MA_WGAN, seed, COMMAND, False), source)
    if not (place / "simlpe" / INFO).exists():
        train_simlpe(SIMLPE, Run(place / "simlpe", SIMLPE, seed, COMMAND, False), source)
    return {
        "ma_wgan": load_predictor(place / "ma_wgan"),
        "simlpe": load_simlpe(place / "simlpe"),
    }
