"""The quality network: how likely a motion is a real one. It judges, and teaches nobody."""

import torch
from torch import nn

from models.hp_gan.config import NetworkConfig
from models.hp_gan.discriminator import whole_features
from models.hp_gan.network import patches

JUDGED_REAL = 0.5
"""What is more probably real than not."""


class Judge(nn.Module):
    """A recurrent layer over the motion, and attention over its moments.

    Args:
        config: Shape of the network.
    """

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        width, self.patch = config.judge_width, config.patch
        self.embed = nn.Linear(6 * config.joints * config.patch, width)
        self.recurrent = nn.GRU(width, width, batch_first=True)
        self.attention = nn.Linear(width, 1)
        self.out = nn.Sequential(nn.Linear(width, width), nn.ReLU(), nn.Linear(width, 1))

    def forward(self, seen: torch.Tensor, future: torch.Tensor) -> torch.Tensor:
        """(B, seen, J, 3), (B, future, J, 3) in metres -> logits (B,)."""
        given = patches(whole_features(seen, future), self.patch)
        moments, _ = self.recurrent(torch.tanh(self.embed(given)))
        weights = torch.softmax(self.attention(moments), dim=1)  # (B, T, 1)
        looked_at = (weights.transpose(1, 2) @ moments)[:, 0]
        logits: torch.Tensor = self.out(looked_at)[:, 0]
        return logits

    def quality(self, seen: torch.Tensor, future: torch.Tensor) -> torch.Tensor:
        """Probability (B,) that a motion is real."""
        return torch.sigmoid(self.forward(seen, future))
