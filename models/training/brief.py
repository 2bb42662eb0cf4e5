"""Training that is over in a minute: no checkpoint, no validation, the last weights."""

from collections.abc import Callable
from typing import TypeVar

import torch
from torch import nn

from models.training.schedule import warm_cosine

Network = TypeVar("Network", bound=nn.Module)

CLIP = 1.0
"""Largest norm of the gradient."""


def train_briefly(
    make: Callable[[], Network],
    loss: Callable[[Network, torch.Generator], torch.Tensor],
    seed: int,
    *,
    steps: int,
    learning_rate: float,
    weight_decay: float,
    warm: int,
) -> Network:
    """Train a network; the same seed gives the same weights, and other chance is left alone.

    Args:
        make: Makes it.
        loss: Of a batch that is drawn with the generator.
        seed: Of everything random.
        steps: Updates.
        learning_rate: Peak rate.
        weight_decay: Of all weights.
        warm: Updates in which the rate rises; along a cosine it falls to zero after them.

    Returns:
        The network, as it is evaluated.
    """
    with torch.random.fork_rng():
        torch.manual_seed(seed)
        generator = torch.Generator().manual_seed(seed)
        network = make().train()
        optimizer = torch.optim.AdamW(
            network.parameters(), learning_rate, weight_decay=weight_decay
        )
        for step in range(steps):
            for group in optimizer.param_groups:
                group["lr"] = learning_rate * warm_cosine(step, steps, warm)
            value = loss(network, generator)
            optimizer.zero_grad(set_to_none=True)
            torch.autograd.backward(value)
            nn.utils.clip_grad_norm_(network.parameters(), CLIP)
            optimizer.step()
    return network.eval()
