"""Exponentially averaged weights."""

import copy

import torch
from torch import nn


class Ema:
    """A slow copy of a network; its early steps follow faster, so that it is soon useful."""

    def __init__(self, network: nn.Module, decay: float) -> None:
        self.network = copy.deepcopy(network).eval().requires_grad_(False)
        self.decay = decay
        self.updates = 0

    @torch.no_grad()
    def update(self, network: nn.Module) -> None:
        """Move the copy towards ``network``."""
        self.updates += 1
        decay = min(self.decay, (1 + self.updates) / (10 + self.updates))
        slow, fast = (
            [*map(torch.Tensor.detach, each.parameters())] for each in (self.network, network)
        )
        torch._foreach_lerp_(slow, fast, 1 - decay)
