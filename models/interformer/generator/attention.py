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

    seen: torch.Tensor
    hidden: torch.Tensor

    def __init__(self, config: NetworkConfig, masked: bool) -> None:
        super().__init__()
        self.joints, self.features = config.joints, config.features
        shape = (3, config.features, config.features)
        scale = config.features**-0.5
        self.queries = nn.Parameter(torch.randn(shape) * scale)
        self.keys = nn.Parameter(torch.randn(shape) * scale)
        self.values = nn.Parameter(torch.randn(shape) * scale)
        self.out = nn.Linear(config.width, config.width)
        self.masked = masked
        seen, hidden = neighbours(adjacency())
        self.register_buffer("seen", seen, persistent=False)
        self.register_buffer("hidden", hidden, persistent=False)

    def forward(
        self, x: torch.Tensor, other: torch.Tensor, near: torch.Tensor | None = None
    ) -> torch.Tensor:
        """Ask the joints of ``other`` at the same moments.

        Moments come last inside, so that few features and few neighbours cost little.

        Args:
            x: Who asks, (B, T, D).
            other: Who is asked, (B, T, D).
            near: Added to the weights, (B, T, J, J): how near the other's joints are.

        Returns:
            (B, T, D).
        """
        size, frames, width = x.shape
        asking, asked = self._moments_last(x), self._moments_last(other)
        q, k, v = (
            (weights.transpose(1, 2) @ each).unflatten(-1, (self.joints, -1))  # (3, F, J, M)
            for each, weights in (
                (asking, self.queries),
                (asked, self.keys),
                (asked, self.values),
            )
        )
        k, v = self._seen(k), self._seen(v)  # (3, F, J or 1, K, M)
        scores = (q[:, :, :, None] * k).sum(1) * self.features**-0.5
        if self.masked:
            scores = scores + self.hidden
        weights = torch.softmax(scores, dim=2)  # (3, J, K, M)
        if near is not None:
            weights = weights + near.flatten(0, 1).permute(1, 2, 0)
        mixed = (weights[:, None] * v).sum(3)  # (3, F, J, M)
        moments = mixed.permute(3, 0, 2, 1).reshape(size, frames, width)
        out: torch.Tensor = self.out(moments)
        return out

    def _seen(self, x: torch.Tensor) -> torch.Tensor:
        """(3, F, J, M) -> what each joint sees, (3, F, J, K, M), or all of them for each."""
        if not self.masked:
            return x[:, :, None]
        table: torch.Tensor = x.index_select(2, self.seen.flatten()).unflatten(2, self.seen.shape)
        return table

    def _moments_last(self, x: torch.Tensor) -> torch.Tensor:
        """(B, T, D) -> (3, F, J * B * T)."""
        split = x.flatten(0, 1).unflatten(-1, (3, self.joints, self.features))
        last: torch.Tensor = split.permute(1, 3, 2, 0).flatten(2)
        return last


def neighbours(mask: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """Whom each joint sees, as a table.

    Args:
        mask: Shape (J, J), which joints see each other.

    Returns:
        Joints (J, K), and what hides those beyond the neighbours that there are, (J, K, 1).
    """
    most = int(mask.sum(dim=1).max())
    seen = mask.int().argsort(dim=1, descending=True, stable=True)[:, :most]
    hidden = torch.where(mask.gather(1, seen), 0.0, NEVER)
    return seen, hidden[..., None]


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
