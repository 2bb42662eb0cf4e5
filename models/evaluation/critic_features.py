"""Whether what HP-GAN's discriminator has learnt helps to tell MSRC-12's gestures apart.

The same dense layers are trained on other people of MSRC-12, once from the discriminator's weights
and once from random ones, with all, half and a quarter of the labels. The discriminator has seen
virtual people and CMU alone. MSRC-12 is for benchmarks only, and nothing of this ships.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import torch
import torch.nn.functional as F

from agent_server.domain.motion import SEEN_FRAMES
from models.data.msrc12 import TAGS, TaggedStream, folds, tag_windows
from models.data.windows import WindowSet
from models.hp_gan.config import NetworkConfig
from models.hp_gan.discriminator import Discriminator, whole_features

SHARES = (1.0, 0.5, 0.25)
"""Of the labels."""
SEEDS = (0, 1)
EPOCHS = 20
BATCH = 64
RATE = 1e-3
STARTS = ("discriminator", "random")


def features_report(
    trained: Discriminator, config: NetworkConfig, streams: Sequence[TaggedStream]
) -> dict[str, Any]:
    """Accuracy on unseen people after every epoch, mean of two seeds, and epochs to reach it.

    ``epochs_to_same`` is the first epoch whose accuracy is the highest that the random start
    reaches; None where it never comes.

    Args:
        trained: The discriminator of a run.
        config: Its shape.
        streams: MSRC-12.
    """
    fold = folds([one.subject for one in streams])[0]
    training = _features(tag_windows(streams, fold.train))
    test = _features(tag_windows(streams, fold.test))
    rows: dict[str, Any] = {}
    for share in SHARES:
        curves = {
            start: np.mean(
                [_curve(start, trained, config, training, test, share, seed) for seed in SEEDS],
                axis=0,
            )
            for start in STARTS
        }
        goal = float(curves["random"].max())
        rows[f"{share:g}"] = {
            "labels": int(share * len(training[1])),
            "goal": round(goal, 4),
            "epochs_to_same": {name: _first(curve, goal) for name, curve in curves.items()},
            "best": {name: round(float(curve.max()), 4) for name, curve in curves.items()},
            "accuracy": {name: curve.round(4).tolist() for name, curve in curves.items()},
        }
    return {"test_windows": len(test[1]), "shares": rows}


def _features(windows: WindowSet) -> tuple[torch.Tensor, torch.Tensor]:
    motion = windows.all()
    return whole_features(motion[:, :SEEN_FRAMES], motion[:, SEEN_FRAMES:]), windows.labels


def _curve(
    start: str,
    trained: Discriminator,
    config: NetworkConfig,
    training: tuple[torch.Tensor, torch.Tensor],
    test: tuple[torch.Tensor, torch.Tensor],
    share: float,
    seed: int,
) -> np.ndarray:
    """Accuracy on the test windows after each epoch, shape (EPOCHS,)."""
    torch.manual_seed(seed)
    network = Discriminator(replace(config, classes=len(TAGS)))
    if start == "discriminator":
        kept = {k: v for k, v in trained.state_dict().items() if not k.startswith("named.")}
        network.load_state_dict(kept, strict=False)
    generator = torch.Generator().manual_seed(seed)
    motion, labels = training
    chosen = torch.randperm(len(labels), generator=generator)[: int(share * len(labels))]
    optimizer = torch.optim.Adam(network.parameters(), RATE)
    found = []
    for _ in range(EPOCHS):
        for batch in _batches(chosen, generator):
            loss = F.cross_entropy(network.classes(motion[batch]), labels[batch])
            optimizer.zero_grad(set_to_none=True)
            torch.autograd.backward(loss)
            optimizer.step()
        with torch.no_grad():
            right = network.classes(test[0]).argmax(1) == test[1]
        found.append(float(right.float().mean()))
    return np.array(found)


def _batches(chosen: torch.Tensor, generator: torch.Generator) -> Iterator[torch.Tensor]:
    order = torch.randperm(len(chosen), generator=generator)
    yield from chosen[order].split(BATCH)


def _first(curve: Sequence[float] | np.ndarray, goal: float) -> int | None:
    reached = np.flatnonzero(np.asarray(curve) >= goal)
    return int(reached[0]) + 1 if len(reached) else None
