"""Efficient attention, the styling by a step of the diffusion, and the graph between joints."""

import torch
import torch.nn.functional as F
from torch import nn

from models.bigraphdiff.config import NetworkConfig

NEVER = -1e4
"""What a forbidden score becomes: no infinity, so that no arithmetic on it can give NaN."""


class Styled(nn.Module):
    """The end of a part: scaled and shifted by the style; gives nothing before training."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        width = config.width
        self.style = nn.Linear(width, 2 * width)
        self.norm = nn.LayerNorm(width)
        self.dropout = nn.Dropout(config.dropout)
        self.out = nn.Linear(width, width)
        nn.init.zeros_(self.out.weight)
        nn.init.zeros_(self.out.bias)

    def forward(self, x: torch.Tensor, style: torch.Tensor) -> torch.Tensor:
        """(B, T, D) and style (B, D) -> (B, T, D)."""
        scale, shift = self.style(F.silu(style))[:, None].chunk(2, dim=-1)
        x = self.norm(x) * (1 + scale) + shift
        out: torch.Tensor = self.out(self.dropout(F.silu(x)))
        return out


class LinearAttention(nn.Module):
    """Attention whose cost grows with the number of tokens, and not with its square.

    Shen et al., "Efficient Attention: Attention with Linear Complexities" (WACV 2021): a softmax
    of the queries over features and one of the keys over tokens, so that keys and values meet
    first.
    """

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        width = config.width
        self.heads = config.heads
        self.norm, self.other_norm = nn.LayerNorm(width), nn.LayerNorm(width)
        self.queries = nn.Linear(width, width)
        self.keys_values = nn.Linear(width, 2 * width)
        self.styled = Styled(config)

    def forward(
        self, x: torch.Tensor, other: torch.Tensor, mask: torch.Tensor, style: torch.Tensor
    ) -> torch.Tensor:
        """Ask; residual.

        Args:
            x: Who asks, (B, T, D).
            other: Who is asked, (B, S, D).
            mask: True where a token of ``other`` counts, (B, S).
            style: (B, D).

        Returns:
            (B, T, D).
        """
        q = self.queries(self.norm(x)).unflatten(-1, (self.heads, -1)).transpose(1, 2)
        both = self.keys_values(self.other_norm(other)).unflatten(-1, (2, self.heads, -1))
        k, v = both.permute(2, 0, 3, 1, 4)  # each (B, H, S, D / H)
        hidden = ~mask[:, None, :, None]
        k = torch.softmax(torch.where(hidden, NEVER, k), dim=2)
        mixed = torch.softmax(q, dim=-1) @ (k.transpose(2, 3) @ v)
        out: torch.Tensor = x + self.styled(mixed.transpose(1, 2).flatten(2), style)
        return out


class Dense(nn.Module):
    """The dense network of a layer; residual."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.dense = nn.Sequential(
            nn.Linear(config.width, config.hidden),
            nn.GELU(),
            nn.Dropout(config.dropout),
            nn.Linear(config.hidden, config.width),
        )
        self.styled = Styled(config)

    def forward(self, x: torch.Tensor, style: torch.Tensor) -> torch.Tensor:
        """(B, T, D) and style (B, D) -> (B, T, D)."""
        out: torch.Tensor = x + self.styled(self.dense(x), style)
        return out


class JointGraph(nn.Module):
    """A graph convolution from the joints of one person to those of the same or another one.

    The adjacency is learned: a number for every pair of joints, to which what the two joints do
    in the frame adds. In the paper nodes are shares of a token that the other person's token
    chooses; here they are the joints, so that an adjacency can be looked at.
    """

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        features = config.features
        self.joints = config.joints
        self.norm, self.other_norm = nn.LayerNorm(features), nn.LayerNorm(features)
        self.adjacency = nn.Parameter(torch.zeros(config.joints, config.joints))
        self.queries = nn.Linear(features, features)
        self.keys_values = nn.Linear(features, 2 * features)
        self.out = nn.Linear(features, features)
        nn.init.zeros_(self.out.weight)
        nn.init.zeros_(self.out.bias)

    def forward(self, x: torch.Tensor, other: torch.Tensor) -> torch.Tensor:
        """Who receives (B, T, D), who sends (B, T, D) -> (B, T, D); residual."""
        mine, theirs = (each.unflatten(-1, (self.joints, -1)) for each in (x, other))
        q = self.queries(self.norm(mine))
        k, v = self.keys_values(self.other_norm(theirs)).chunk(2, dim=-1)
        scores = q @ k.transpose(-1, -2) * k.shape[-1] ** -0.5 + self.adjacency
        mixed = torch.softmax(scores, dim=-1) @ v  # (B, T, J, F)
        out: torch.Tensor = x + self.out(F.relu(mixed)).flatten(2)
        return out
