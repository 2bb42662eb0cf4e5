"""Table 5.2 of Chopin's thesis on virtual people: what the prediction is worth to the classifier.

Eleven virtual people make the six gestures or something else, all seven alike often, before motion
capture or a Kinect. Two are held out, eight train, one chooses the checkpoint. A window of 3 s
begins with the movement, give or take 0.2 s, so that its first second is the gesture's first one.
The rows are one network on one budget. The predictor is the server's, frozen: it has been trained
on other virtual people.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import torch

from agent_server.domain.gesture import GESTURES, IDLE
from agent_server.domain.motion import CLASSIFIED_FRAMES
from agent_server.synthetic.corpus import subject_names
from models.data.synthetic import Mix, synthetic_recordings
from models.data.windows import WindowSet
from models.evaluation.forecasters import SERVER_BUNDLE
from models.evaluation.gestures import scores
from models.evaluation.rows import (
    Bundled,
    RowResult,
    Split,
    compared,
    row_configs,
    train_rows,
)
from models.interformer.config import TrainConfig

PEOPLE = subject_names(11, 500)
PARTS = {
    "train": (520, 2_000, PEOPLE[:8]),
    "validation": (521, 300, PEOPLE[8:9]),
    "test": (522, 700, PEOPLE[9:]),
}
"""Seed, number of takes and people."""
MIX = Mix(idle=1 / 7, sensors=(0.25, 0.25, 0.5, 0.0))
"""Kinect v2, Kinect v1, motion capture; no webcam."""
EARLY_OR_LATE = 5
"""Frames by which a window begins before or after the movement."""
CLASSIFIER = TrainConfig(steps=2_000, idle=1 / 7, validate_every=250)
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
    split = Split(*(table_windows(*PARTS[name]) for name in ("train", "validation", "test")))
    predictors = {"ma_wgan": Bundled(SERVER_BUNDLE)}
    results = train_rows(row_configs(CLASSIFIER, ("ma_wgan",)), predictors, split, folder, seed)
    ablations = train_rows(ABLATIONS, predictors, split, folder, seed)
    return {
        "synthetic": True,
        "rows": _figures(results),
        "ablations": _figures(ablations),
        "ma_wgan_against": {
            name: compared(results["1s+ma_wgan"].right, other.right)
            for name, other in results.items()
            if name != "1s+ma_wgan"
        },
        "thesis": {"3s": 0.636, "1s": 0.477, "1s+ma_wgan": 0.602},
    }


def _figures(results: dict[str, RowResult]) -> dict[str, Any]:
    return {name: scores(each.probabilities, each.labels) for name, each in results.items()}


def table_windows(seed: int, count: int, people: tuple[str, ...]) -> WindowSet:
    """Windows that begin with each take's movement; an idle take's begin anywhere."""
    takes = synthetic_recordings(seed, count, people, MIX)
    rng = np.random.default_rng(seed)
    starts, labels, base = [], [], 0
    for take in takes:
        spare = len(take.observed) - CLASSIFIED_FRAMES
        stretch = take.stretches[0] if take.stretches else None
        middle = stretch.onset if stretch else int(rng.integers(spare + 1))
        gesture = stretch.gesture if stretch else IDLE
        for start in range(middle - EARLY_OR_LATE, middle + EARLY_OR_LATE + 1):
            starts.append(base + min(max(start, 0), spare))
            labels.append(GESTURES.index(gesture))
        base += len(take.observed)
    return WindowSet(
        torch.from_numpy(np.concatenate([take.observed for take in takes])),
        torch.from_numpy(np.concatenate([take.clean for take in takes])),
        torch.tensor(starts),
        torch.tensor(labels),
        torch.tensor(labels),
        GESTURES,
    )
