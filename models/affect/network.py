"""The network: an ensemble of dense networks on standardised features."""

from collections.abc import Sequence
from itertools import pairwise

import torch
from torch import Tensor, nn

from models.affect.config import AffectConfig

TARGETS = 2
"""Valence and arousal."""
REACH = 5.0
"""How many standard deviations a feature may be away from the mean."""
SMALLEST_SPREAD, LARGEST_SPREAD = -5.0, 1.0
"""Limits of the log standard deviations, so that no face makes them overflow."""


class Members(nn.Module):
    """Several dense networks side by side, each with its own weights.

    Args:
        features: Numbers that go in.
        config: Shape.
    """

    def __init__(self, features: int, config: AffectConfig) -> None:
        super().__init__()
        sizes = (features, *config.hidden)
        self.weights = nn.ParameterList()
        self.biases = nn.ParameterList()
        for inner, outer in pairwise(sizes):
            bound = (1 / inner) ** 0.5
            shape = (config.members, inner, outer)
            self.weights.append(nn.Parameter(torch.empty(shape).uniform_(-bound, bound)))
            self.biases.append(nn.Parameter(torch.zeros(config.members, 1, outer)))
        last = sizes[-1]
        bound = (1 / last) ** 0.5
        shape = (config.members, last, TARGETS)
        self.mean = nn.Parameter(torch.empty(shape).uniform_(-bound, bound))
        self.mean_bias = nn.Parameter(torch.zeros(config.members, 1, TARGETS))
        self.spread = nn.Parameter(torch.zeros(config.members, last, TARGETS))
        self.spread_bias = nn.Parameter(torch.full((config.members, 1, TARGETS), -2.0))
        self.dropout = nn.Dropout(config.dropout)

    def forward(self, given: Tensor) -> tuple[Tensor, Tensor]:
        """Estimates and log standard deviations.

        Args:
            given: Shape (M, B, D), or (B, D) for all members alike.

        Returns:
            Two of shape (M, B, 2).
        """
        hidden = given if given.dim() == 3 else given[None]
        for weight, bias in zip(self.weights, self.biases, strict=True):
            hidden = self.dropout(nn.functional.gelu(hidden @ weight + bias))
        # What the uncertainty learns leaves the estimate alone.
        apart = hidden.detach()
        logs = (apart @ self.spread + self.spread_bias).clamp(SMALLEST_SPREAD, LARGEST_SPREAD)
        return hidden @ self.mean + self.mean_bias, logs


class AffectNetwork(nn.Module):
    """Features (B, D) -> valence, arousal and their standard deviations (B, 4), on [-1, 1].

    Args:
        config: Shape.
        features: D.
        order: Of each feature, which one it is in a mirrored face.
        signs: Of each feature, by what it is multiplied then.
    """

    order: Tensor
    signs: Tensor
    centre: Tensor
    scale: Tensor
    slope: Tensor
    level: Tensor
    gain: Tensor
    widening: Tensor

    def __init__(
        self, config: AffectConfig, features: int, order: Sequence[int], signs: Sequence[float]
    ) -> None:
        super().__init__()
        self.symmetric = config.symmetric
        self.linear = config.linear
        self.register_buffer("order", torch.tensor(order, dtype=torch.int64))
        self.register_buffer("signs", torch.tensor(signs, dtype=torch.float32))
        self.register_buffer("centre", torch.zeros(features))
        self.register_buffer("scale", torch.ones(features))
        self.register_buffer("slope", torch.zeros(features, TARGETS))
        self.register_buffer("level", torch.zeros(TARGETS))
        self.register_buffer("gain", torch.ones(TARGETS))
        self.register_buffer("widening", torch.ones(TARGETS))
        self.members = Members(features, config)

    def standardise(self, features: Tensor) -> Tensor:
        """Standardised features (B, D); what no face of the training had is cut off."""
        return ((features - self.centre) * self.scale).clamp(-REACH, REACH)

    def forward(self, features: Tensor) -> Tensor:
        """Estimate affect."""
        given = self.standardise(features)
        if self.symmetric:
            # One batch, so that the weights are read once.
            mirrored = self.standardise(features[:, self.order] * self.signs)
            given = torch.cat((given, mirrored))
        means, logs = self.members(given)  # (M, B or 2 B, 2)
        if self.linear:
            means = (1 - self.linear) * means + self.linear * (given @ self.slope + self.level)
        if self.symmetric:
            rows = features.shape[0]
            means, logs = (torch.cat((x[:, :rows], x[:, rows:])) for x in (means, logs))
        mean = means.mean(0)
        variance = (2 * logs).exp().mean(0) + (means - mean).square().mean(0)
        estimate = (mean * self.gain).clamp(-1, 1)
        return torch.cat((estimate, variance.sqrt() * self.widening), dim=1)
