"""Table 5.2 of Chopin's thesis on virtual people: what the prediction is worth to the classifier.

Eleven virtual people make the six gestures or something else, before motion capture or a Kinect.
Two of them are held out, eight train, one chooses the checkpoint. The rows are one network on one
budget. The predictor is the server's, frozen: it has been trained on other virtual people.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import torch

from agent_server.synthetic.corpus import subject_names
from models.data.synthetic import synthetic_recordings
from models.data.windows import AMBIGUOUS, WindowSet, cut
from models.evaluation.forecasters import SERVER_BUNDLE
from models.evaluation.gestures import scores
from models.evaluation.rows import (
    Bundled,
    RowResult,
    Split,
    paired_p_value,
    row_configs,
    train_rows,
)
from models.interformer.config import TrainConfig

PEOPLE = subject_names(11, 500)
TRAIN, VALIDATION, TEST = PEOPLE[:8], PEOPLE[8:9], PEOPLE[9:]
SHARES = (0.25, 0.25, 0.5, 0.0)
"""Kinect v2, Kinect v1, motion capture; no webcam."""
TAKES = {"train": (520, 2_000), "validation": (521, 300), "test": (522, 600)}
"""Seed and number of takes."""
STRIDE = 5
CLASSIFIER = TrainConfig(steps=2_000, validate_every=250)
ABLATIONS = {
    f"1s+ma_wgan without {what}": replace(
        CLASSIFIER, network=replace(CLASSIFIER.network, **{switch: False})
    )
    for what, switch in (("adjacency", "adjacency"), ("spatial attention", "spatial"))
}


def thesis_report(folder: Path, seed: int = 0) -> dict[str, Any]:
    """Train and test all rows.

    Args:
        folder: Where the runs are kept; those that are there are only measured again.
        seed: Of every training.
    """
    torch.set_num_threads(1)
    training = _windows(TRAIN, "train", 1)
    validation = _windows(VALIDATION, "validation", STRIDE)
    test = _judged(_windows(TEST, "test", STRIDE))
    predictors = {"ma_wgan": Bundled(SERVER_BUNDLE)}
    split = Split(training, _judged(validation), test)
    results = train_rows(row_configs(CLASSIFIER, ("ma_wgan",)), predictors, split, folder, seed)
    ablations = train_rows(ABLATIONS, predictors, split, folder, seed)
    return {
        "synthetic": True,
        "rows": _figures(results),
        "ablations": _figures(ablations),
        "p_value": paired_p_value(results["1s+ma_wgan"].right, results["1s"].right),
        "thesis": {"3s": 0.636, "1s": 0.477, "1s+ma_wgan": 0.602},
    }


def _figures(results: dict[str, RowResult]) -> dict[str, Any]:
    return {name: scores(each.probabilities, each.labels) for name, each in results.items()}


def _windows(people: tuple[str, ...], split: str, stride: int) -> WindowSet:
    seed, count = TAKES[split]
    return cut(synthetic_recordings(seed, count, people, shares=SHARES), stride)


def _judged(windows: WindowSet) -> WindowSet:
    """Those that have a label, and show nothing in their future that the label does not say."""
    clear = (windows.labels != AMBIGUOUS) & ~windows.undecided
    return windows.take(clear.nonzero()[:, 0])
