"""The mixer: a generator of linear maps over time and over channels."""

import torch
from torch import nn

from models.ma_wgan.config import NetworkConfig
from models.ma_wgan.representation import Forecast, Point, Spheres
from models.ops.dct import dct_matrix
from models.ops.half import dense, product

POSITION_SCALE = 3.0
"""Brings positions in metres to about unit size."""
VELOCITY_SCALE = 30.0
"""Brings steps in metres a frame to about unit size."""
FLOOR_M = 1e-4
"""Speed in metres a frame below which the gradient of a direction no longer grows."""
LOG_LENGTH_RANGE = (-7.0, 4.0)
"""Lengths from 1 mm to 55 m: what two seconds can cover, with room."""
DECAY = 0.9
"""Share of the speed that is left a frame later, before anything is learnt."""


class MixerBlock(nn.Module):
    """Mixes over time (or its DCT coefficients), then over channels, both residually."""

    def __init__(
        self, frames: int, channels: int, dropout: float = 0.0, half: bool = False
    ) -> None:
        super().__init__()
        self.in_half = half
        self.time_norm = nn.LayerNorm(channels)
        self.time = nn.Linear(frames, frames)
        self.channel_norm = nn.LayerNorm(channels)
        self.channel_in = nn.Linear(channels, channels)
        self.dropout = nn.Dropout(dropout)
        self.channel_out = nn.Linear(channels, channels)
        nn.init.zeros_(self.time.bias)
        nn.init.normal_(self.time.weight, std=0.02)
        nn.init.normal_(self.channel_out.weight, std=0.02)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        """(B, T, C) -> (B, T, C)."""
        half = self.in_half and self.training
        # The weight multiplies from the left, so that no transpose is needed.
        x = x + product(self.time.weight, self.time_norm(x), half) + self.time.bias[:, None]
        hidden = torch.relu(dense(self.channel_norm(x), self.channel_in, half))
        hidden = self.dropout(hidden)
        return x + dense(hidden, self.channel_out, half).float()


class Mixer(nn.Module):
    """Seen poses -> the future as tangent vectors or as a curve.

    The future starts as the motion carried on: a learnt linear map over the seen steps, which
    begins as the last velocity dying away. The blocks add to it.

    Args:
        config: Shape of the network.
        half: Multiply in bfloat16 while training.
    """

    average: torch.Tensor
    dct_in: torch.Tensor
    dct_out: torch.Tensor

    def __init__(self, config: NetworkConfig, half: bool = False) -> None:
        super().__init__()
        self.config = config
        coordinates = 3 * config.joints
        self.register_buffer("dct_in", dct_matrix(config.seen))
        self.register_buffer(
            "dct_out", dct_matrix(config.future)[: config.coefficients].T.contiguous()
        )
        self.register_buffer("average", torch.full((1, config.seen), 1.0 / config.seen))
        carried = torch.zeros(config.future, config.seen - 1)
        carried[:, -1] = DECAY ** torch.arange(1, config.future + 1)
        self.carry = nn.Parameter(carried)
        self.embed = nn.Linear(3 * coordinates, config.channels)
        self.noise = nn.Linear(config.noise, config.channels, bias=False) if config.noise else None
        self.blocks = nn.ModuleList(
            MixerBlock(config.seen, config.channels, config.dropout, half)
            for _ in range(config.blocks)
        )
        self.norm = nn.LayerNorm(config.channels)
        self.stretch = nn.Linear(config.seen, config.coefficients)
        self.out = nn.Linear(config.channels, coordinates)
        nn.init.normal_(self.out.weight, std=0.002)
        nn.init.zeros_(self.out.bias)
        if config.output == "tangent":
            spheres = 1 if config.spheres == "body" else config.joints
            self.log_length = nn.Linear(config.channels, spheres)
            nn.init.normal_(self.log_length.weight, std=0.002)
            nn.init.zeros_(self.log_length.bias)

    def forward(self, seen: torch.Tensor, noise: torch.Tensor | None, spheres: Spheres) -> Forecast:
        """(B, seen, C), (B, Z) -> the future."""
        steps = seen[:, 1:] - seen[:, :-1]
        last = seen[:, -1:]
        x = self._features(seen, steps, last, noise)
        raw = self.dct_out @ self.out(self._stretched(x))  # (B, future, C)
        carried = torch.cumsum(self.carry @ steps, dim=1)
        if self.config.output == "curve":
            poses = last + carried + raw / POSITION_SCALE
            return Forecast(spheres.encode(torch.cat([last, poses], dim=1), FLOOR_M), poses)
        base = spheres.encode(torch.cat([last, last + carried], dim=1), FLOOR_M)
        tangent = base.tangent + spheres.project(raw)
        log_length = base.log_length
        if self.config.length:
            # A frame each and averaged by a product: see models.ops.heading about equal bits.
            log_length = log_length + (self.average @ self.log_length(x))[:, 0]
        log_length = log_length.clamp(*LOG_LENGTH_RANGE)
        poses = spheres.decode(tangent, log_length, last[:, 0])
        return Forecast(Point(tangent, log_length, base.moving), poses)

    def _features(
        self,
        seen: torch.Tensor,
        steps: torch.Tensor,
        last: torch.Tensor,
        noise: torch.Tensor | None,
    ) -> torch.Tensor:
        speeds = torch.cat([steps[:, :1], steps], dim=1) * VELOCITY_SCALE
        features = torch.cat([seen * POSITION_SCALE, speeds, (seen - last) * POSITION_SCALE], -1)
        x = self.embed(self.dct_in @ features)  # (B, seen, channels)
        if self.noise is not None and noise is not None:
            x = x + self.noise(noise).unsqueeze(1)
        for block in self.blocks:
            x = block(x)
        out: torch.Tensor = self.norm(x)
        return out

    def _stretched(self, x: torch.Tensor) -> torch.Tensor:
        """(B, seen, channels) -> (B, coefficients, channels)."""
        return self.stretch.weight @ x + self.stretch.bias[:, None]
