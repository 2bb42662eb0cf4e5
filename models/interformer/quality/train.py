"""Training of the quality network, on recorded interactions and counterfeits of them."""

import torch
import torch.nn.functional as F

from models.data.interactions import InteractionSet, Pairs, vary
from models.interformer.quality.counterfeits import COUNTERFEITS, NEEDS_MOTION, moves
from models.interformer.quality.network import Quality
from models.training.brief import train_briefly

STEPS = 1000
BATCH = 24
LEARNING_RATE = 3e-3
WEIGHT_DECAY = 0.05
WARM = 30
NOISE_M = 0.01
"""Deviation of what all joints of both people are shifted by, so that a sensor's noise, or that
there is none, tells nothing."""


def train_quality(spec: InteractionSet, pairs: Pairs, seed: int, steps: int = STEPS) -> Quality:
    """Train a quality network.

    Args:
        spec: The data set.
        pairs: The training split, and nothing else.
        seed: Of everything random.
        steps: Updates.
    """
    swap = torch.tensor([label in spec.symmetric for label in spec.labels])
    kinds = list(COUNTERFEITS)

    def loss(network: Quality, generator: torch.Generator) -> torch.Tensor:
        batch = vary(pairs.draw(BATCH, generator), generator, swap=swap)
        kind = kinds[int(torch.randint(len(kinds), (), generator=generator))]
        made = COUNTERFEITS[kind](batch, pairs, generator)
        counts = batch.mask & (moves(batch)[:, None] | (kind not in NEEDS_MOTION))
        action, recorded, made = (
            motion + NOISE_M * torch.randn(motion.shape, generator=generator)
            for motion in (batch.action, batch.reaction, made)
        )
        real = _mean(F.softplus(-network(action, recorded)), batch.mask)
        return real + _mean(F.softplus(network(action, made)), counts)

    return train_briefly(
        Quality,
        loss,
        seed,
        steps=steps,
        learning_rate=LEARNING_RATE,
        weight_decay=WEIGHT_DECAY,
        warm=WARM,
    )


def _mean(values: torch.Tensor, counts: torch.Tensor) -> torch.Tensor:
    return (values * counts).sum() / counts.sum().clamp(min=1)
