"""The discriminator of HP-GAN: is this motion real, and what is it?"""

import torch
from torch import nn

from models.hp_gan.config import NetworkConfig
from models.hp_gan.network import motion_features
from models.ops.heading import heading, to_front


def whole_features(seen: torch.Tensor, future: torch.Tensor) -> torch.Tensor:
    """Features (B, seen + future, 6 J) of a past and a future that faces the front as the past."""
    direction = heading(seen)
    return motion_features(to_front(torch.cat([seen, future], dim=1), direction))


class Discriminator(nn.Module):
    """Dense layers over the whole motion, each of which also sees what went into all before it.

    Args:
        config: Shape of the network.
    """

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.inputs = (config.seen + config.future) * 6 * config.joints
        width = config.critic_width
        self.first = nn.Linear(self.inputs, width)
        self.layers = nn.ModuleList(
            nn.Linear(width, width) for _ in range(config.critic_layers - 1)
        )
        self.norms = nn.ModuleList(nn.LayerNorm(width) for _ in range(config.critic_layers - 1))
        self.score = nn.Linear(width, 1)
        self.named = nn.Linear(width, config.classes)

    def features(self, motion: torch.Tensor) -> torch.Tensor:
        """Motion features (B, T, D) -> (B, width): what both heads look at."""
        x = nn.functional.leaky_relu(self.first(motion.flatten(1)), 0.2)
        for layer, norm in zip(self.layers, self.norms, strict=True):
            x = x + nn.functional.leaky_relu(layer(norm(x)), 0.2)
        return x

    def forward(self, motion: torch.Tensor) -> torch.Tensor:
        """Motion features (B, T, D) -> how real it looks (B,); no probability."""
        score: torch.Tensor = self.score(self.features(motion))[:, 0]
        return score

    def classes(self, motion: torch.Tensor) -> torch.Tensor:
        """Motion features (B, T, D) -> logits (B, classes)."""
        logits: torch.Tensor = self.named(self.features(motion))
        return logits
