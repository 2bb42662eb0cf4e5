"""Attention between moments and between joints, of one person and of two."""

from typing import NamedTuple

import torch
import torch.nn.functional as F
from torch import nn

from models.data.layouts import KINECT15
from models.interformer.generator.config import NetworkConfig

NEVER = -1e4
"""What a forbidden score becomes: no infinity, so that no arithmetic on it can give NaN."""


class Seen(NamedTuple):
    """Keys and values of moments, each of shape (B, H, T, D / H)."""

    keys: torch.Tensor
    values: torch.Tensor


class TemporalAttention(nn.Module):
    """Attention between moments; queries may come from one person and keys from the other."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.heads, self.depth = config.heads, config.width // config.heads
        self.queries = nn.Linear(config.width, config.width)
        self.keys_values = nn.Linear(config.width, 2 * config.width)
        self.out = nn.Linear(config.width, config.width)

    def see(self, x: torch.Tensor) -> Seen:
        """What moments (B, T, D) can be asked for."""
        size, frames, _ = x.shape
        split = self.keys_values(x).reshape(size, frames, 2, self.heads, self.depth)
        keys, values = split.permute(2, 0, 3, 1, 4)
        return Seen(keys, values)

    def forward(self, x: torch.Tensor, seen: Seen, bias: torch.Tensor) -> torch.Tensor:
        """Ask.

        Args:
            x: Who asks, (B, T, D).
            seen: What is asked, of S moments.
            bias: Added to the scores, broadcast to (B, H, T, S).

        Returns:
            (B, T, D).
        """
        size, frames, width = x.shape
        q = self.queries(x).reshape(size, frames, self.heads, self.depth).transpose(1, 2)
        mixed = F.scaled_dot_product_attention(q, seen.keys, seen.values, bias)
        out: torch.Tensor = self.out(mixed.transpose(1, 2).reshape(size, frames, width))
        return out


class SpatialAttention(nn.Module):
    """Attention between the joints of a moment; the three coordinates are the heads.

    Where this differs from the published code: a joint's weights sum to one, where there those of
    all joints together do, and scores keep their sign.
    """

    bias: torch.Tensor

    def __init__(self, config: NetworkConfig, masked: bool) -> None:
        super().__init__()
        self.joints, self.features = config.joints, config.features
        shape = (3, config.features, config.features)
        scale = config.features**-0.5
        self.queries = nn.Parameter(torch.randn(shape) * scale)
        self.keys = nn.Parameter(torch.randn(shape) * scale)
        self.values = nn.Parameter(torch.randn(shape) * scale)
        self.out = nn.Linear(config.width, config.width)
        seen = adjacency() if masked else torch.ones(config.joints, config.joints).bool()
        self.register_buffer("bias", torch.where(seen, 0.0, NEVER))

    def forward(
        self, x: torch.Tensor, other: torch.Tensor, near: torch.Tensor | None = None
    ) -> torch.Tensor:
        """Ask the joints of ``other`` at the same moments.

        Args:
            x: Who asks, (B, T, D).
            other: Who is asked, (B, T, D).
            near: Added to the weights, (B, T, J, J): how near the other's joints are.

        Returns:
            (B, T, D).
        """
        size, frames, width = x.shape
        asking, asked = self._by_coordinate(x), self._by_coordinate(other)
        q, k, v = (
            (rows @ weights).reshape(3, size * frames, self.joints, self.features)
            for rows, weights in ((asking, self.queries), (asked, self.keys), (asked, self.values))
        )
        mixed = F.scaled_dot_product_attention(q, k, v, self.bias)
        if near is not None:
            mixed = mixed + near.flatten(0, 1) @ v
        moments = mixed.reshape(3, size, frames, self.joints * self.features)
        out: torch.Tensor = self.out(moments.permute(1, 2, 0, 3).reshape(size, frames, width))
        return out

    def _by_coordinate(self, x: torch.Tensor) -> torch.Tensor:
        """(B, T, D) -> (3, B * T * J, F)."""
        heads = x.unflatten(-1, (3, self.joints, self.features)).permute(2, 0, 1, 3, 4)
        rows: torch.Tensor = heads.reshape(3, -1, self.features)
        return rows


def adjacency() -> torch.Tensor:
    """Which joints see each other: themselves, inward and outward neighbours; (15, 15) bool."""
    mask = torch.eye(len(KINECT15.joints), dtype=torch.bool)
    for parent, child in KINECT15.bones:
        mask[parent, child] = mask[child, parent] = True
    return mask


def nearness(reaction: torch.Tensor, action: torch.Tensor) -> torch.Tensor:
    """The paper's interaction distance: softmax of minus the distances of two people's joints.

    Args:
        reaction: (B, T, J, 3), metres.
        action: (B, T, J, 3), metres, in the same frame.

    Returns:
        (B, T, J, J), for each joint of the reaction a share of each of the action's.
    """
    apart = reaction[:, :, :, None] - action[:, :, None]
    distance = (apart.square().sum(-1) + 1e-8).sqrt()
    shares: torch.Tensor = torch.softmax(-distance, dim=-1)
    return shares
