"""The networks of the paper: convolutions over the frames and coordinates of tangent vectors.

Chopin et al. 2021, section IV: a dense layer of 36,864, five blocks of nearest upsampling, a 3 x 3
convolution and ReLU with 512, 256, 128, 64 and 1 channels; a critic of 64, 32 and 16 channels
and dense layers of 1024 and 1. Not in the paper, and chosen here: the maps grow by equal ratios to
frames x coordinates; the last block ends without ReLU, since tangent vectors have both signs.
"""

import torch
import torch.nn.functional as F
from torch import nn

from models.ma_wgan.config import NetworkConfig
from models.ma_wgan.representation import Forecast, Point, Spheres
from models.ops import srvf

FIRST_MAP = (6, 12)
WIDTHS = (1.0, 0.5, 0.25, 0.125)
"""Channels of the blocks before the last, as shares of the first."""
CRITIC_WIDTHS = (64, 32, 16)
CRITIC_DENSE = 1024


class Convolutions(nn.Module):
    """The generator.

    It sees the past as an SRVF of unit norm, the way that it gives the future. The lengths are
    not predicted: the body goes on as fast as it went.

    Args:
        config: Shape; ``channels`` is the width of the first block, 512 in the paper.
    """

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.config = config
        coordinates = 3 * config.joints
        widths = [round(config.channels * share) for share in WIDTHS]
        rows, columns = FIRST_MAP
        self.maps = [
            (
                round(rows * (config.future / rows) ** (k / 5)),
                round(columns * (coordinates / columns) ** (k / 5)),
            )
            for k in range(1, 6)
        ]
        self.dense = nn.Linear(
            (config.seen - 1) * coordinates + config.noise, config.channels * rows * columns
        )
        self.convolutions = nn.ModuleList(
            nn.Conv2d(before, after, 3, padding=1)
            for before, after in zip([config.channels, *widths], [*widths, 1], strict=True)
        )

    def forward(self, seen: torch.Tensor, noise: torch.Tensor | None, spheres: Spheres) -> Forecast:
        """(B, seen, C), (B, Z) -> the future."""
        past, length = srvf.to_sphere(seen.unsqueeze(1))
        x = past.flatten(1)
        if self.config.noise:
            drawn = seen.new_zeros(len(seen), self.config.noise) if noise is None else noise
            x = torch.cat([x, drawn], dim=1)
        x = torch.relu(self.dense(x)).unflatten(1, (self.config.channels, *FIRST_MAP))
        for size, convolution in zip(self.maps, self.convolutions, strict=True):
            x = convolution(F.interpolate(x, size=size, mode="nearest"))
            if convolution is not self.convolutions[-1]:
                x = torch.relu(x)
        tangent = spheres.project(x[:, 0])
        share = self.config.future / (self.config.seen - 1)
        log_length = torch.log(length * share + 1e-3)
        poses = spheres.decode(tangent, log_length, seen[:, -1])
        return Forecast(Point(tangent, log_length, torch.ones_like(log_length)), poses)


class ConvolutionCritic(nn.Module):
    """Scores tangent vectors: three strided convolutions and two dense layers."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.shape = (config.future, 3 * config.joints)
        share = config.critic_channels / CRITIC_WIDTHS[0]
        widths = [round(width * share) for width in CRITIC_WIDTHS]
        self.convolutions = nn.Sequential()
        for before, after in zip([1, *widths[:-1]], widths, strict=True):
            self.convolutions.append(nn.Conv2d(before, after, 3, stride=2, padding=1))
            self.convolutions.append(nn.LeakyReLU(0.2))
        rows, columns = (-(-n // 8) for n in self.shape)
        self.dense = nn.Sequential(
            nn.Linear(widths[-1] * rows * columns, CRITIC_DENSE),
            nn.LeakyReLU(0.2),
            nn.Linear(CRITIC_DENSE, 1),
        )

    def forward(self, tangent: torch.Tensor, poses: torch.Tensor) -> torch.Tensor:
        """Tangent (B, 1, D) -> (B,); the paper's critic does not look at poses."""
        maps = tangent.unflatten(2, self.shape)
        score: torch.Tensor = self.dense(self.convolutions(maps).flatten(1))[:, 0]
        return score
