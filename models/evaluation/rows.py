"""The same classifier on the same budget, given more or less of the three seconds.

After Table 5.2 of Chopin's thesis: 3 s seen, 1 s seen, and 1 s seen with 2 s that somebody expects.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from scipy.stats import binomtest
from torch import nn

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import SEEN_FRAMES
from agent_server.inference.manifest import MODEL_FILE, read_manifest
from models.data.windows import WindowSet
from models.interformer.config import TrainConfig
from models.interformer.train import hold_last, load_classifier, train, window_logits
from models.ops.session import OnnxModel
from models.training.run import INFO, Run


class Held(nn.Module):
    """The predictor of rows without one: the last frame, for ever."""

    def forward(self, seen: torch.Tensor) -> torch.Tensor:
        """(B, 25, 9, 3) -> (B, 50, 9, 3)."""
        return hold_last(seen)


class Bundled(nn.Module):
    """The predictor of a bundle, as training wants it.

    Raises:
        BundleError: If the bundle is not whole.
    """

    def __init__(self, folder: Path) -> None:
        super().__init__()
        read_manifest(folder)
        self.model = OnnxModel(folder / MODEL_FILE)

    def forward(self, seen: torch.Tensor) -> torch.Tensor:
        """(B, 25, 9, 3) -> (B, 50, 9, 3)."""
        return torch.from_numpy(self.model.batched(seen.cpu().numpy())).to(seen.device)


@dataclass(frozen=True, slots=True)
class Split:
    """The windows of a table.

    Attributes:
        training: To train on.
        validation: To choose the checkpoint with.
        test: Of people that neither of the two shows.
    """

    training: WindowSet
    validation: WindowSet
    test: WindowSet


@dataclass(frozen=True, slots=True)
class RowResult:
    """What a row gives for the test windows.

    Attributes:
        probabilities: Shape (N, C).
        labels: Shape (N,).
    """

    probabilities: Float32
    labels: NDArray[np.int64]

    @property
    def right(self) -> NDArray[np.bool_]:
        """Shape (N,), whether the most probable class is the true one."""
        found: NDArray[np.bool_] = self.probabilities.argmax(1) == self.labels
        return found

    @property
    def nll(self) -> float:
        """Mean negative logarithm of the true class's probability."""
        true = self.probabilities[np.arange(len(self.labels)), self.labels]
        return float(-np.log(true + 1e-12).mean())


def row_configs(base: TrainConfig, predictors: Sequence[str]) -> dict[str, TrainConfig]:
    """Row -> configuration; rows of predictors are called ``1s+NAME``."""
    alone = replace(base.network, frames=SEEN_FRAMES)
    return {
        "3s": replace(base, futures="true"),
        "1s": replace(base, futures="held", network=alone),
        **{f"1s+{name}": base for name in predictors},
        "1s+last": replace(base, futures="held"),
    }


def train_rows(
    rows: Mapping[str, TrainConfig],
    predictors: Mapping[str, nn.Module],
    split: Split,
    folder: Path,
    seed: int,
) -> dict[str, RowResult]:
    """Train each row, unless its run is there, and ask it about the test windows.

    Args:
        rows: Row -> configuration; a row that begins with ``1s+NAME`` uses that predictor.
        predictors: Frozen, by name.
        split: The windows.
        folder: Where the runs are kept, one folder a row.
        seed: Of every row.
    """
    results = {}
    for name, config in rows.items():
        predictor = predictors.get(name.removeprefix("1s+").split()[0], Held())
        place = folder / name.replace("+", "_").replace(" ", "_")
        if not (place / INFO).exists():
            run = Run(place, config, seed, f"evaluate gestures ({name})", resume=False)
            train(config, run, split.training, split.validation, predictor)
        network = load_classifier(place)
        logits = window_logits(network, predictor, split.test, config, torch.device("cpu"))
        results[name] = RowResult(torch.softmax(logits, -1).numpy(), split.test.labels.numpy())
    return results


def paired_p_value(first: NDArray[np.bool_], second: NDArray[np.bool_]) -> float:
    """McNemar's exact test: how likely rows that are equally good differ by as much.

    Args:
        first: Shape (N,), which windows a row has right.
        second: Shape (N,), the same of another row.
    """
    only_first, only_second = int((first & ~second).sum()), int((second & ~first).sum())
    if not only_first + only_second:
        return 1.0
    return float(binomtest(only_first, only_first + only_second).pvalue)


def compared(first: NDArray[np.bool_], second: NDArray[np.bool_]) -> dict[str, Any]:
    """How many windows a row has right that another has wrong, and the other way round."""
    return {
        "gained": int((first & ~second).sum()),
        "lost": int((second & ~first).sum()),
        "p_value": paired_p_value(first, second),
    }


def recall_by_class(results: Sequence[RowResult], classes: Sequence[str]) -> dict[str, Any]:
    """Share of the windows of each class that are right, over several rotations."""
    labels = np.concatenate([result.labels for result in results])
    right = np.concatenate([result.right for result in results])
    return {
        name: round(float(right[labels == index].mean()), 4)
        for index, name in enumerate(classes)
        if (labels == index).any()
    }
