"""Generator and critic of the predictor, on one page.

After Chopin et al., "Human Motion Prediction Using Manifold-Aware Wasserstein GAN" (FG 2021):
the future curve is a point on the unit sphere of SRVFs, and the networks work in the tangent
space at the Karcher mean. Where this differs from the paper: a residual mixer over DCT
coefficients in place of the convolutions (faster and more exact), the length of the curve is
predicted beside its direction (the sphere forgets it), and the body is turned to the front
inside the network.
"""

import torch
from torch import nn

from models.ma_wgan.config import NetworkConfig
from models.ops import sphere, srvf
from models.ops.dct import dct_matrix
from models.ops.heading import from_front, heading, to_front

POSITION_SCALE = 3.0
"""Brings positions in metres to about unit size."""
VELOCITY_SCALE = 30.0
"""Brings steps in metres a frame to about unit size."""
FROZEN_M = 2e-5
"""Steps a frame and coordinate at which half of the predicted motion is left."""
LOG_LENGTH_RANGE = (-6.0, 4.0)
"""Lengths from 2.5 mm to 55 m: what two seconds of nine joints can cover, with room."""


def log_liveliness(front: torch.Tensor) -> torch.Tensor:
    """Logarithm of a factor on the future's length: 1 for a body, 0 for a frozen stream.

    A living body always moves and every sensor trembles by more than a tenth of a millimetre.
    Frames that are equal to the last bit come from a source that has stopped, and of a motion
    that was never seen nothing can be foreseen.

    Args:
        front: Shape (B, seen, joints * 3), metres.

    Returns:
        Shape (B,).
    """
    # In units of FROZEN_M: the exporter takes tiny constants for zero.
    steps = (front[:, 1:] - front[:, :-1]).flatten(1) / FROZEN_M
    squared = (steps.unsqueeze(-2) @ steps.unsqueeze(-1))[:, 0, 0] / steps.shape[1]
    return torch.log((squared + 1e-6) / (squared + 1.0))


class MixerBlock(nn.Module):
    """Mixes over time (or its DCT coefficients), then over channels, both residually."""

    def __init__(self, frames: int, channels: int) -> None:
        super().__init__()
        self.time_norm = nn.LayerNorm(channels)
        self.time = nn.Linear(frames, frames)
        self.channel_norm = nn.LayerNorm(channels)
        self.channel_in = nn.Linear(channels, channels)
        self.channel_out = nn.Linear(channels, channels)
        nn.init.zeros_(self.time.bias)
        nn.init.normal_(self.time.weight, std=0.02)
        nn.init.normal_(self.channel_out.weight, std=0.02)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        """(B, T, C) -> (B, T, C)."""
        # The weight multiplies from the left, so that no transpose is needed.
        mixed = self.time.weight @ self.time_norm(x) + self.time.bias[:, None]
        x = x + mixed
        out: torch.Tensor = x + self.channel_out(torch.relu(self.channel_in(self.channel_norm(x))))
        return out


class Generator(nn.Module):
    """Seen positions -> future positions, by way of the tangent space.

    Args:
        config: Shape of the network.
        reference: Karcher mean of the training SRVFs (future * joints * 3,), unit norm.
    """

    reference: torch.Tensor
    average: torch.Tensor
    dct_in: torch.Tensor
    dct_out: torch.Tensor

    def __init__(self, config: NetworkConfig, reference: torch.Tensor) -> None:
        super().__init__()
        self.config = config
        coordinates = 3 * config.joints
        self.register_buffer("reference", reference)
        self.register_buffer("dct_in", dct_matrix(config.seen))
        self.register_buffer(
            "dct_out", dct_matrix(config.future)[: config.coefficients].T.contiguous()
        )
        self.register_buffer("average", torch.full((1, config.seen), 1.0 / config.seen))
        self.embed = nn.Linear(3 * coordinates, config.channels)
        self.blocks = nn.ModuleList(
            MixerBlock(config.seen, config.channels) for _ in range(config.blocks)
        )
        self.norm = nn.LayerNorm(config.channels)
        self.stretch = nn.Linear(config.seen, config.coefficients)
        self.tangent = nn.Linear(config.channels, coordinates)
        self.log_length = nn.Linear(config.channels, 1)
        nn.init.normal_(self.tangent.weight, std=0.002)
        nn.init.zeros_(self.tangent.bias)

    def tangent_and_length(self, front: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """(B, seen, joints * 3) facing the front -> tangent vector (B, D), log-length (B,)."""
        steps = front[:, 1:] - front[:, :-1]
        steps = torch.cat([steps[:, :1], steps], dim=1) * VELOCITY_SCALE
        last = front[:, -1:]
        features = torch.cat(
            [front * POSITION_SCALE, steps, (front - last) * POSITION_SCALE], dim=-1
        )
        x = self.embed(self.dct_in @ features)  # (B, seen, C)
        for block in self.blocks:
            x = block(x)
        x = self.norm(x)
        # A frame each and averaged by a product: see models.ops.heading about equal bits.
        log_length = (self.average @ self.log_length(x))[:, 0, 0].clamp(*LOG_LENGTH_RANGE)
        coefficients = self.stretch.weight @ x + self.stretch.bias[:, None]
        raw = self.dct_out @ self.tangent(coefficients)  # (B, future, joints * 3)
        return sphere.project(raw.flatten(1), self.reference), log_length

    def decode(
        self, tangent: torch.Tensor, log_length: torch.Tensor, start: torch.Tensor
    ) -> torch.Tensor:
        """Tangent vector (B, D), log-length (B,), last pose (B, J * 3) -> (B, future, J * 3)."""
        point = sphere.exp(tangent, self.reference)
        curve = point.reshape(-1, self.config.future, 3 * self.config.joints)
        return srvf.from_sphere(curve, torch.exp(log_length), start)

    def forward(self, seen: torch.Tensor) -> torch.Tensor:
        """(B, seen, joints, 3) -> (B, future, joints, 3), metres, normalised, unrotated."""
        direction = heading(seen)
        front = to_front(seen, direction).flatten(2)
        tangent, log_length = self.tangent_and_length(front)
        future = self.decode(tangent, log_length + log_liveliness(front), front[:, -1])
        shape = (-1, self.config.future, self.config.joints, 3)
        return from_front(future.reshape(shape), direction)


class Critic(nn.Module):
    """Scores tangent vectors: three strided convolutions over time, then two dense layers."""

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        width = config.critic_channels
        self.frames, self.coordinates = config.future, 3 * config.joints
        self.convolutions = nn.Sequential(
            nn.Conv1d(self.coordinates, width, 5, stride=2, padding=2),
            nn.LeakyReLU(0.2),
            nn.Conv1d(width, width, 5, stride=2, padding=2),
            nn.LeakyReLU(0.2),
            nn.Conv1d(width, width, 5, stride=2, padding=2),
            nn.LeakyReLU(0.2),
        )
        self.dense = nn.Sequential(
            nn.Linear(width * -(-config.future // 8), 128), nn.LeakyReLU(0.2), nn.Linear(128, 1)
        )

    def forward(self, tangent: torch.Tensor) -> torch.Tensor:
        """(B, D) -> (B,)."""
        frames = tangent.reshape(-1, self.frames, self.coordinates).transpose(1, 2)
        # Unit norm spread over D coordinates is small; the scale brings them near one.
        scaled = frames * self.frames**0.5
        score: torch.Tensor = self.dense(self.convolutions(scaled).flatten(1))[:, 0]
        return score
