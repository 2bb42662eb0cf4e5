"""The classifier, on one page.

After the Interformer of Chopin et al., "Interaction Transformer for Human Reaction
Generation" (IEEE TMM 2023): attention between the joints of a moment, masked by the skeleton's
edges and with the three coordinates as heads, runs in parallel with attention between moments.
Where this differs: only the encoder is kept, a moment is a patch of five frames, and the body
is turned to the front inside the network.
"""

import torch
from torch import nn

from agent_server.domain.motion import SEEN_FRAMES
from agent_server.domain.skeleton import CORE_BONES, CORE_JOINTS
from models.interformer.config import NetworkConfig
from models.ops.heading import heading, to_front

POSITION_SCALE = 3.0
VELOCITY_SCALE = 30.0
"""Bring metres, and metres a frame, to about unit size."""


def adjacency() -> torch.Tensor:
    """Which joints see each other: themselves, inward and outward neighbours; (9, 9) bool."""
    mask = torch.eye(CORE_JOINTS, dtype=torch.bool)
    for parent, child in CORE_BONES:
        mask[parent, child] = mask[child, parent] = True
    return mask


class SpatialAttention(nn.Module):
    """Attention between the joints of one token; a head for each coordinate."""

    bias: torch.Tensor

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.joints, self.features = config.joints, config.features
        shape = (3, config.features, 3 * config.features)
        self.queries_keys_values = nn.Parameter(torch.randn(shape) * config.features**-0.5)
        self.out = nn.Linear(config.width, config.width)
        seen = adjacency() if config.adjacency else torch.ones_like(adjacency())
        # A large negative number and no infinity, so that no arithmetic on it can give NaN.
        self.register_buffer("bias", torch.where(seen, 0.0, -1e4))

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        """(B, T, 3 * J * F) -> the same shape."""
        size, tokens, width = x.shape
        heads = x.reshape(size * tokens, 3, self.joints, self.features)
        q, k, v = torch.split(heads @ self.queries_keys_values, self.features, dim=-1)
        scores = q @ k.transpose(-1, -2) * self.features**-0.5 + self.bias
        mixed = torch.softmax(scores, dim=-1) @ v  # (B * T, 3, J, F)
        out: torch.Tensor = self.out(mixed.reshape(size, tokens, width))
        return out


class TemporalAttention(nn.Module):
    """Attention between the tokens of a window."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.heads, self.depth = config.heads, config.width // config.heads
        self.queries_keys_values = nn.Linear(config.width, 3 * config.width)
        self.out = nn.Linear(config.width, config.width)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        """(B, T, D) -> (B, T, D)."""
        size, tokens, width = x.shape
        split = self.queries_keys_values(x).reshape(size, tokens, 3, self.heads, self.depth)
        q, k, v = split.permute(2, 0, 3, 1, 4)  # each (B, H, T, D / H)
        scores = q @ k.transpose(-1, -2) * self.depth**-0.5
        mixed = (torch.softmax(scores, dim=-1) @ v).transpose(1, 2)
        out: torch.Tensor = self.out(mixed.reshape(size, tokens, width))
        return out


class EncoderLayer(nn.Module):
    """Both attentions in parallel, then a small dense network; all residual."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.attention_norm = nn.LayerNorm(config.width)
        self.temporal = TemporalAttention(config)
        self.spatial = SpatialAttention(config) if config.spatial else None
        self.dense_norm = nn.LayerNorm(config.width)
        self.dense = nn.Sequential(
            nn.Linear(config.width, 2 * config.width),
            nn.ReLU(),
            nn.Linear(2 * config.width, config.width),
        )
        self.dropout = nn.Dropout(config.dropout)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        """(B, T, D) -> (B, T, D)."""
        normed = self.attention_norm(x)
        mixed = self.temporal(normed)
        if self.spatial is not None:
            mixed = mixed + self.spatial(normed)
        x = x + self.dropout(mixed)
        out: torch.Tensor = x + self.dropout(self.dense(self.dense_norm(x)))
        return out


class Classifier(nn.Module):
    """Normalised motion -> logits; :class:`Calibrated` makes probabilities of them."""

    average: torch.Tensor

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.config = config
        self.embed = nn.Parameter(torch.randn(3, 2 * config.patch, config.features) * 0.4)
        self.widen = nn.Linear(config.width, config.width)
        self.position = nn.Parameter(torch.randn(config.tokens, config.width) * 0.02)
        self.layers = nn.ModuleList(EncoderLayer(config) for _ in range(config.layers))
        self.norm = nn.LayerNorm(config.width)
        self.hidden = nn.Linear(config.width, config.width)
        self.head = nn.Linear(config.width, config.classes)
        self.register_buffer("average", torch.full((1, config.tokens), 1.0 / config.tokens))

    def forward(self, motion: torch.Tensor) -> torch.Tensor:
        """(B, frames, J, 3), metres, normalised -> logits (B, classes)."""
        config = self.config
        front = to_front(motion, heading(motion[:, :SEEN_FRAMES]))
        steps = torch.cat([front[:, :1] * 0.0, front[:, 1:] - front[:, :-1]], dim=1)
        both = torch.stack([front * POSITION_SCALE, steps * VELOCITY_SCALE], dim=-1)
        patches = both.reshape(-1, config.tokens, config.patch, config.joints, 3, 2)
        # (B, T, patch, J, 3, 2) -> (B, T, 3, J, patch * 2): the coordinates are the heads.
        heads = patches.permute(0, 1, 4, 3, 2, 5).flatten(4)
        x = (heads @ self.embed).flatten(2)
        x = x + self.widen(x) + self.position
        for layer in self.layers:
            x = layer(x)
        # The head sees every token and its logits are averaged by a product: a row of a
        # batch then has the bits that it has alone.
        each = self.head(torch.relu(self.hidden(self.norm(x))))
        logits: torch.Tensor = self.average @ each  # (B, 1, classes)
        return logits[:, 0]


class Calibrated(nn.Module):
    """A classifier with its temperature: motion -> probabilities.

    Args:
        classifier: Gives logits.
        temperature: Logits are divided by it; above 1 the probabilities are more modest.
    """

    temperature: torch.Tensor

    def __init__(self, classifier: Classifier, temperature: float) -> None:
        super().__init__()
        self.classifier = classifier
        self.register_buffer("temperature", torch.tensor(temperature))

    def forward(self, motion: torch.Tensor) -> torch.Tensor:
        """(B, frames, J, 3) -> (B, classes), sum 1."""
        return torch.softmax(self.classifier(motion) / self.temperature, dim=-1)
