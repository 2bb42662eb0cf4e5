"""The generator of reactions, on one page.

After Chopin et al., "Interaction Transformer for Human Reaction Generation" (IEEE TMM 2023): an
encoder reads the whole action, a decoder writes the reaction frame by frame. In every layer
attention between joints runs beside attention between moments; within one person it is masked
by the skeleton, between two people it is raised by how near the joints are.
Where this differs: layers are normalised before each part, a token also holds the last step,
the decoder says how far each joint is from where it began, which cannot drift, the end is a
probability and no pose, noise makes several reactions to one action, and the encoder also says
what kind of interaction it sees, which the decoder is told.
"""

import math
from typing import NamedTuple

import torch
from torch import nn

from models.interformer.generator.attention import (
    NEVER,
    Seen,
    SpatialAttention,
    TemporalAttention,
    nearness,
)
from models.interformer.generator.config import NetworkConfig

WAY_SCALE = 4.0
VELOCITY_SCALE = 8.0
"""Bring metres from the start, and metres a frame, to about unit size."""


class Written(NamedTuple):
    """What the decoder says of the frames that it was given.

    Attributes:
        pose: The pose that follows each, (B, T, J, 3), metres.
        stop: Logit that it is the last one, (B, T).
    """

    pose: torch.Tensor
    stop: torch.Tensor


class Embedding(nn.Module):
    """Positions, ways from the first pose and steps -> tokens; a feature is a coordinate's own."""

    times: torch.Tensor

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.each = nn.Parameter(torch.randn(3, 3, config.features) * 0.7)
        self.widen = nn.Linear(config.width, config.width)
        self.register_buffer("times", _times(config.frames + 1, config.width), persistent=False)

    def forward(
        self, first: torch.Tensor, motion: torch.Tensor, steps: torch.Tensor
    ) -> torch.Tensor:
        """First poses (B, 1, J, 3), poses and steps (B, T, J, 3) -> (B, T, D), without times."""
        way = (motion - first) * WAY_SCALE
        seen = torch.stack([motion, way, steps * VELOCITY_SCALE], dim=-1)
        x: torch.Tensor = (seen.transpose(2, 3) @ self.each).flatten(2)  # (B, T, 3 * J * F)
        widened: torch.Tensor = x + self.widen(x)
        return widened

    def timed(self, motion: torch.Tensor) -> torch.Tensor:
        """(B, T, J, 3) -> (B, T, D), with the times of the first frames."""
        x: torch.Tensor = self(motion[:, :1], motion, steps_of(motion))
        return x + self.times[: motion.shape[1]]


class Dense(nn.Sequential):
    """The dense network of a layer."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__(
            nn.Linear(config.width, config.hidden),
            nn.ReLU(),
            nn.Dropout(config.dropout),
            nn.Linear(config.hidden, config.width),
        )


class EncoderLayer(nn.Module):
    """Both attentions within the action, then a dense network; all residual."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.norm = nn.LayerNorm(config.width)
        self.temporal = TemporalAttention(config)
        self.spatial = SpatialAttention(config, config.adjacency) if config.spatial else None
        self.dense_norm = nn.LayerNorm(config.width)
        self.dense = Dense(config)
        self.dropout = nn.Dropout(config.dropout)

    def forward(self, x: torch.Tensor, bias: torch.Tensor) -> torch.Tensor:
        """(B, T, D) and what hides padding, (B, 1, 1, T) -> (B, T, D)."""
        normed = self.norm(x)
        mixed = self.temporal(normed, self.temporal.see(normed), bias)
        if self.spatial is not None:
            mixed = mixed + self.spatial(normed, normed)
        x = x + self.dropout(mixed)
        out: torch.Tensor = x + self.dropout(self.dense(self.dense_norm(x)))
        return out


class DecoderLayer(nn.Module):
    """Attention within the reaction, then to the action, then a dense network; all residual."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.norm = nn.LayerNorm(config.width)
        self.temporal = TemporalAttention(config)
        self.spatial = SpatialAttention(config, config.adjacency) if config.spatial else None
        self.other_norm = nn.LayerNorm(config.width)
        self.other_temporal = TemporalAttention(config)
        self.other_spatial = SpatialAttention(config, masked=False) if config.spatial else None
        self.dense_norm = nn.LayerNorm(config.width)
        self.dense = Dense(config)
        self.dropout = nn.Dropout(config.dropout)

    def within(self, x: torch.Tensor, seen: Seen, bias: torch.Tensor) -> torch.Tensor:
        """The first part: the reaction's own moments and joints; ``seen`` has x's own, too."""
        normed = self.norm(x)
        mixed = self.temporal(normed, seen, bias)
        if self.spatial is not None:
            mixed = mixed + self.spatial(normed, normed)
        out: torch.Tensor = x + self.dropout(mixed)
        return out

    def between(
        self,
        x: torch.Tensor,
        action: Seen,
        bias: torch.Tensor,
        beside: torch.Tensor,
        near: torch.Tensor | None,
    ) -> torch.Tensor:
        """The second and third parts.

        Args:
            x: Tokens, (B, T, D).
            action: What the temporal attention sees of the action.
            bias: Hides its padding.
            beside: The action's tokens at the same moments, (B, T, D).
            near: How near the joints are, (B, T, J, J).
        """
        normed = self.other_norm(x)
        mixed = self.other_temporal(normed, action, bias)
        if self.other_spatial is not None:
            mixed = mixed + self.other_spatial(normed, beside, near)
        x = x + self.dropout(mixed)
        out: torch.Tensor = x + self.dropout(self.dense(self.dense_norm(x)))
        return out


class Memory(NamedTuple):
    """An action that has been read.

    Attributes:
        action: (B, S, J, 3), metres.
        tokens: (B, S, D).
        bias: Hides padding, (B, 1, 1, S).
        seen: What each decoder layer may ask.
        kind: Logits of the kinds of interaction, (B, classes).
    """

    action: torch.Tensor
    tokens: torch.Tensor
    bias: torch.Tensor
    seen: tuple[Seen, ...]
    kind: torch.Tensor


class Generator(nn.Module):
    """Action and first pose of the reaction -> the reaction."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.config = config
        self.read = Embedding(config)
        self.ending = nn.Parameter(torch.randn(config.width) * 0.1)
        self.encoder = nn.ModuleList(EncoderLayer(config) for _ in range(config.layers))
        self.encoder_norm = nn.LayerNorm(config.width)
        self.name = nn.Linear(config.width, config.classes)
        self.write = Embedding(config)
        self.named = nn.Linear(config.classes, config.width)
        self.noise = nn.Linear(config.latent, config.width)
        self.decoder = nn.ModuleList(DecoderLayer(config) for _ in range(config.layers))
        self.norm = nn.LayerNorm(config.width)
        self.way = nn.Linear(config.width, 3 * config.joints)
        self.stop = nn.Linear(config.width, 1)
        # At first all reactions are one, and stand still.
        nn.init.normal_(self.noise.weight, std=0.02)
        nn.init.zeros_(self.way.weight)
        nn.init.zeros_(self.way.bias)

    @property
    def decoder_layers(self) -> list[DecoderLayer]:
        """The decoder's layers, first to last."""
        return [layer for layer in self.decoder if isinstance(layer, DecoderLayer)]

    def encode(self, action: torch.Tensor, lengths: torch.Tensor) -> Memory:
        """Read actions (B, S, J, 3) of ``lengths`` (B,) frames."""
        frames = torch.arange(action.shape[1], device=action.device)
        x = self.read.timed(action)
        last = (frames == lengths[:, None] - 1)[..., None]
        x = x + last * self.ending
        bias = torch.where(frames < lengths[:, None], 0.0, NEVER)[:, None, None]
        for layer in self.encoder:
            x = layer(x, bias)
        tokens = self.encoder_norm(x)
        seen = tuple(layer.other_temporal.see(tokens) for layer in self.decoder_layers)
        shares = torch.softmax(bias[:, 0, 0], dim=-1)  # every frame of the action alike
        kind = self.name((shares[:, None] @ tokens)[:, 0])
        return Memory(action, tokens, bias, seen, kind)

    def told(self, kind: torch.Tensor, noise: torch.Tensor) -> torch.Tensor:
        """What is said of the kind (B, classes), noise (B, latent) -> of any token, (B, 1, D)."""
        both: torch.Tensor = self.named(kind) + self.noise(noise)
        return both[:, None]

    def decode(
        self, reaction: torch.Tensor, noise: torch.Tensor, kind: torch.Tensor, memory: Memory
    ) -> Written:
        """What follows each frame of reactions; no frame sees a later one of its reaction.

        Args:
            reaction: (B, T, J, 3), metres, at most as long as the actions.
            noise: (B, latent).
            kind: What is said of the kind of interaction, (B, classes); shares in training.
            memory: The actions.
        """
        frames = reaction.shape[1]
        x = self.write.timed(reaction) + self.told(kind, noise)
        later = torch.ones(frames, frames, device=x.device).triu(1) * NEVER
        beside = memory.tokens[:, :frames]
        near = nearness(reaction, memory.action[:, :frames]) if self.config.distance else None
        for layer, action in zip(self.decoder_layers, memory.seen, strict=True):
            x = layer.within(x, layer.temporal.see(layer.norm(x)), later)
            x = layer.between(x, action, memory.bias, beside, near)
        return self.written(reaction[:, :1], x)

    def written(self, first: torch.Tensor, x: torch.Tensor) -> Written:
        """First poses (B, 1, J, 3) and tokens of the last layer -> poses and ends."""
        x = self.norm(x)
        way = self.way(x).unflatten(-1, (self.config.joints, 3))
        return Written(first + way, self.stop(x)[..., 0])


def steps_of(motion: torch.Tensor) -> torch.Tensor:
    """(B, T, J, 3) -> how far each frame is from the one before; the first is not."""
    return torch.cat([motion[:, :1] * 0.0, motion[:, 1:] - motion[:, :-1]], dim=1)


def _times(frames: int, width: int) -> torch.Tensor:
    """Sines of the frame's number, (frames, width)."""
    at = torch.arange(frames)[:, None]
    rates = torch.exp(-math.log(1000.0) * torch.arange(0, width, 2) / width)
    waves = torch.zeros(frames, width)
    waves[:, 0::2] = torch.sin(at * rates)
    waves[:, 1::2] = torch.cos(at * rates)[:, : width // 2]
    return 0.5 * waves
