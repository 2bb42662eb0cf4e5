"""Training of the quality network, on recorded interactions and counterfeits of them."""

import torch
import torch.nn.functional as F
from torch import nn

from models.data.interactions import InteractionSet, Pairs, vary
from models.interformer.quality.counterfeits import COUNTERFEITS, NEEDS_MOTION, moves
from models.interformer.quality.network import Quality
from models.training.schedule import warm_cosine

STEPS = 1000
BATCH = 24
LEARNING_RATE = 3e-3
WEIGHT_DECAY = 0.05
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
    with torch.random.fork_rng():
        torch.manual_seed(seed)
        generator = torch.Generator().manual_seed(seed)
        network = Quality().train()
        optimizer = torch.optim.AdamW(
            network.parameters(), LEARNING_RATE, weight_decay=WEIGHT_DECAY
        )
        for step in range(steps):
            for group in optimizer.param_groups:
                group["lr"] = LEARNING_RATE * warm_cosine(step, steps, 30)
            batch = vary(pairs.draw(BATCH, generator), generator, swap=swap)
            kind = kinds[int(torch.randint(len(kinds), (), generator=generator))]
            made = COUNTERFEITS[kind](batch, pairs, generator)
            counts = batch.mask & (moves(batch)[:, None] | (kind not in NEEDS_MOTION))
            action, recorded, made = (
                motion + NOISE_M * torch.randn(motion.shape, generator=generator)
                for motion in (batch.action, batch.reaction, made)
            )
            loss = _mean(F.softplus(-network(action, recorded)), batch.mask)
            loss = loss + _mean(F.softplus(network(action, made)), counts)
            optimizer.zero_grad(set_to_none=True)
            torch.autograd.backward(loss)
            nn.utils.clip_grad_norm_(network.parameters(), 1.0)
            optimizer.step()
    return network.eval()


def _mean(values: torch.Tensor, counts: torch.Tensor) -> torch.Tensor:
    return (values * counts).sum() / counts.sum().clamp(min=1)
