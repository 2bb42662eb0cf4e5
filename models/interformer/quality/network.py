"""The quality network of reactions: how probable it is, frame by frame, that one is recorded.

The idea is HP-GAN's (Barsoum et al., "HP-GAN: Probabilistic 3D human motion prediction via GAN",
CVPR Workshops 2018): a network that tells real motion from other motion, is asked beside the
generator and never teaches it. This one sees both people, and at each frame only what came before.
"""

import torch
from torch import nn

from models.data.interactions import JOINTS

WAY_SCALE = 4.0
VELOCITY_SCALE = 8.0
"""Bring metres from the start, and metres a frame, to about unit size."""


class Quality(nn.Module):
    """A recurrent layer over both people's motion, which says after each frame what it holds of it.

    Args:
        width: Units of the layer.
    """

    def __init__(self, width: int = 64) -> None:
        super().__init__()
        self.width = width
        self.embed = nn.Linear(2 * JOINTS * 3 * 3, width)
        self.recurrent = nn.GRU(width, width, batch_first=True)
        self.drop_in, self.drop_out = nn.Dropout(0.2), nn.Dropout(0.3)
        self.out = nn.Sequential(nn.Linear(width, width), nn.ReLU(), nn.Linear(width, 1))

    def forward(self, action: torch.Tensor, reaction: torch.Tensor) -> torch.Tensor:
        """Judge whole motions.

        Args:
            action: Shape (B, T, 15, 3), metres, in the frame of the pair.
            reaction: Likewise.

        Returns:
            A logit for each frame, (B, T).
        """
        pair = torch.cat([action, reaction], dim=2)
        before = torch.cat([pair[:, :1], pair[:, :-1]], dim=1)
        moments, _ = self.recurrent(self.see(pair[:, :1], before, pair))
        return self.say(moments)

    def see(self, first: torch.Tensor, before: torch.Tensor, pair: torch.Tensor) -> torch.Tensor:
        """First frames (B, 1, 30, 3), predecessors and frames (B, T, 30, 3) -> (B, T, width)."""
        way, step = (pair - first) * WAY_SCALE, (pair - before) * VELOCITY_SCALE
        seen = self.drop_in(torch.cat([pair, way, step], dim=-1).flatten(2))
        return torch.tanh(self.embed(seen))

    def say(self, moments: torch.Tensor) -> torch.Tensor:
        """(..., width) -> logits (...)."""
        logits: torch.Tensor = self.out(self.drop_out(moments))[..., 0]
        return logits


class QualityStep(nn.Module):
    """One frame of a quality network, with what it keeps from frame to frame given and taken.

    Args:
        network: Whose weights it has.
    """

    def __init__(self, network: Quality) -> None:
        super().__init__()
        self.network = network
        self.cell = nn.GRUCell(network.width, network.width)
        for name in ("weight_ih", "weight_hh", "bias_ih", "bias_hh"):
            setattr(self.cell, name, getattr(network.recurrent, f"{name}_l0"))

    def forward(
        self, first: torch.Tensor, before: torch.Tensor, pair: torch.Tensor, hidden: torch.Tensor
    ) -> tuple[torch.Tensor, torch.Tensor]:
        """Look at a frame of two people, the action's joints and then the reaction's.

        Args:
            first: The first frame, (B, 30, 3), metres, in the frame of the pair.
            before: The frame before this one; the same for the first.
            pair: This frame.
            hidden: What was kept so far, (B, width); zeros at first.

        Returns:
            Logits (B,), and what is kept.
        """
        seen = self.network.see(first[:, None], before[:, None], pair[:, None])
        kept = self.cell(seen[:, 0], hidden)
        return self.network.say(kept), kept
