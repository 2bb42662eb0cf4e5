"""Whether the quality network tells recorded reactions from what is none, on a test split."""

from collections.abc import Mapping
from typing import Any

import torch

from agent_server.stages.react import LEAST_QUALITY
from models.data.interactions import Pairs
from models.interformer.quality.counterfeits import COUNTERFEITS, NEEDS_MOTION, moves
from models.interformer.quality.network import Quality

DRAWS = 3


@torch.no_grad()
def quality_of(network: Quality, pairs: Pairs, reaction: torch.Tensor) -> torch.Tensor:
    """What a server would hold of whole reactions (B, T, 15, 3), in [0, 1], (B,)."""
    logits, counts = network(pairs.action, reaction), pairs.mask
    return torch.sigmoid((logits * counts).sum(1) / counts.sum(1))


def quality_report(
    network: Quality, test: Pairs, made: Mapping[str, torch.Tensor]
) -> dict[str, Any]:
    """Figures of a quality network.

    Args:
        network: Which has not seen ``test``.
        test: Recorded interactions.
        made: Name -> other reactions to their actions, each (B, T, 15, 3), as long.

    Returns:
        ``passes``: share that is held to be recorded more probably than not, of the recorded ones
        and of ``made``; ``auc`` of each counterfeit: how often a recorded reaction is held to be
        better than one.
    """
    generator = torch.Generator().manual_seed(0)
    recorded, moving = quality_of(network, test, test.reaction), moves(test)
    auc = {}
    for name, counterfeit in COUNTERFEITS.items():
        those = moving if name in NEEDS_MOTION else torch.ones_like(moving)
        found = [
            quality_of(network, test, counterfeit(test, test, generator))[those]
            for _ in range(DRAWS)
        ]
        auc[name] = _auc(recorded[those], torch.cat(found))
    qualities = {"recorded": recorded} | {
        name: quality_of(network, test, reaction) for name, reaction in made.items()
    }
    return {
        "passes": {
            name: round(float((quality >= LEAST_QUALITY).float().mean()), 3)
            for name, quality in qualities.items()
        },
        "auc": auc,
    }


def _auc(good: torch.Tensor, bad: torch.Tensor) -> float:
    better = (good[:, None] > bad).double() + 0.5 * (good[:, None] == bad).double()
    return round(float(better.mean()), 3)
