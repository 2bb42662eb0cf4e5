"""The critic: says how far a future is from a real one."""

import torch
from torch import nn

from models.ma_wgan.config import NetworkConfig
from models.ma_wgan.paper import ConvolutionCritic

POSE_SCALE = 3.0
"""Brings poses in metres, seen from the last seen one, to about unit size."""


class Critic(nn.Module):
    """Three strided convolutions over time, then two dense layers.

    It looks at the tangent vectors, frame by frame, and beside them at the poses that they stand
    for: the spheres forget how far a joint goes.
    """

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        width = config.critic_channels
        self.frames, self.poses = config.future, config.critic_poses
        inputs = 3 * config.joints * (2 if config.critic_poses else 1)
        self.convolutions = nn.Sequential(
            nn.Conv1d(inputs, width, 5, stride=2, padding=2),
            nn.LeakyReLU(0.2),
            nn.Conv1d(width, width, 5, stride=2, padding=2),
            nn.LeakyReLU(0.2),
            nn.Conv1d(width, width, 5, stride=2, padding=2),
            nn.LeakyReLU(0.2),
        )
        self.dense = nn.Sequential(
            nn.Linear(width * -(-config.future // 8), 128), nn.LeakyReLU(0.2), nn.Linear(128, 1)
        )

    def forward(self, tangent: torch.Tensor, poses: torch.Tensor) -> torch.Tensor:
        """Tangent (B, S, D) and poses (B, T, C) relative to the last seen one -> (B,)."""
        frames = tangent.unflatten(2, (self.frames, -1)).transpose(1, 2).flatten(2)
        # Unit norm spread over D coordinates is small; the scale brings them near one.
        inputs = frames * self.frames**0.5
        if self.poses:
            inputs = torch.cat([inputs, poses * POSE_SCALE], dim=2)
        score: torch.Tensor = self.dense(self.convolutions(inputs.transpose(1, 2)).flatten(1))[:, 0]
        return score


def make_critic(config: NetworkConfig) -> nn.Module:
    """The critic that belongs to the family of the generator."""
    return Critic(config) if config.family == "mixer" else ConvolutionCritic(config)
