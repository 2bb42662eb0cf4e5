"""The predictor: a generator, the spheres that it works on, and the critic.

After Chopin et al., "Human Motion Prediction Using Manifold-Aware Wasserstein GAN" (FG 2021). Where
this differs from the paper, the configuration says so: a residual mixer over DCT coefficients in
place of the convolutions (faster and more exact), a sphere for each joint, the length of the curve
beside its direction, and the body turned to the front inside the network. The paper's own networks
are in ``models.ma_wgan.paper``.
"""

from collections.abc import Sequence

import torch
from torch import nn

from models.ma_wgan.config import NetworkConfig
from models.ma_wgan.mixer import Mixer
from models.ma_wgan.paper import Convolutions
from models.ma_wgan.representation import Forecast, Spheres
from models.ops.heading import from_front, heading, to_front

FROZEN_M = 2e-5
"""Steps a frame and coordinate at which half of the predicted motion is left."""


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


class Predictor(nn.Module):
    """Seen positions -> future positions.

    Args:
        config: Shape of the network.
        reference: Karcher mean of the training motions (S, D), see ``Spheres``.
        half: Multiply in bfloat16 while training.
    """

    def __init__(self, config: NetworkConfig, reference: torch.Tensor, half: bool = False) -> None:
        super().__init__()
        self.config = config
        self.spheres = Spheres(reference, config.future, config.spheres, config.log_clip)
        self.generator: nn.Module = (
            Mixer(config, half) if config.family == "mixer" else Convolutions(config)
        )

    def forecast(self, front: torch.Tensor, noise: torch.Tensor | None = None) -> Forecast:
        """Future of a body that faces the front.

        Args:
            front: Shape (B, seen, joints * 3), metres.
            noise: Shape (B, Z), standard normal; None for the expected future.
        """
        forecast: Forecast = self.generator(front, noise, self.spheres)
        return forecast

    def forward(self, seen: torch.Tensor, noise: torch.Tensor | None = None) -> torch.Tensor:
        """(B, seen, joints, 3) -> (B, future, joints, 3), metres."""
        shape = (-1, self.config.future, self.config.joints, 3)
        if not self.config.front:
            return self._alive(seen.flatten(2), noise).reshape(shape)
        direction = heading(seen)
        front = to_front(seen, direction).flatten(2)
        return from_front(self._alive(front, noise).reshape(shape), direction)

    def _alive(self, front: torch.Tensor, noise: torch.Tensor | None) -> torch.Tensor:
        start = front[:, -1:]
        share = torch.exp(log_liveliness(front))[:, None, None]
        return start + share * (self.forecast(front, noise).poses - start)

    def futures(self, seen: torch.Tensor, count: int, generator: torch.Generator) -> torch.Tensor:
        """Several futures of one past: (B, seen, J, 3) -> (B, count, future, J, 3)."""
        noise = torch.randn(len(seen) * count, self.config.noise, generator=generator)
        future = self.forward(seen.repeat_interleave(count, 0), noise.to(seen.device))
        return future.reshape(len(seen), count, *future.shape[1:])


class Flipped(nn.Module):
    """The average of a body's future and the mirrored future of its mirror image.

    Args:
        network: (B, seen, J, 3) -> (B, future, J, 3).
        mirror: For each joint, its counterpart.
    """

    mirror: torch.Tensor
    sign: torch.Tensor

    def __init__(self, network: nn.Module, mirror: tuple[int, ...]) -> None:
        super().__init__()
        self.network = network
        self.register_buffer("mirror", torch.tensor(mirror))
        self.register_buffer("sign", torch.tensor([-1.0, 1.0, 1.0]))

    def forward(self, seen: torch.Tensor) -> torch.Tensor:
        """(B, seen, J, 3) -> (B, future, J, 3), metres."""
        other = self._mirrored(self.network(self._mirrored(seen)))
        future: torch.Tensor = 0.5 * (self.network(seen) + other)
        return future

    def _mirrored(self, motion: torch.Tensor) -> torch.Tensor:
        return motion.index_select(2, self.mirror) * self.sign


class Averaged(nn.Module):
    """The average future of several trained networks.

    Args:
        networks: Each (B, seen, J, 3) -> (B, future, J, 3), for the same frames and joints.
    """

    def __init__(self, networks: Sequence[nn.Module]) -> None:
        super().__init__()
        self.networks = nn.ModuleList(networks)

    def forward(self, seen: torch.Tensor) -> torch.Tensor:
        """(B, seen, J, 3) -> (B, future, J, 3), metres."""
        total = self.networks[0](seen)
        for network in self.networks[1:]:
            total = total + network(seen)
        mean: torch.Tensor = total / len(self.networks)
        return mean


def carry_on(network: nn.Module, seen: torch.Tensor, frames: int) -> torch.Tensor:
    """Predict further than the network does, from its own predictions.

    Args:
        network: (B, seen, J, 3) -> (B, future, J, 3).
        seen: Shape (B, seen, J, 3).
        frames: How many are wanted.

    Returns:
        Shape (B, frames, J, 3).
    """
    parts: list[torch.Tensor] = []
    while sum(part.shape[1] for part in parts) < frames:
        parts.append(network(seen))
        seen = torch.cat([seen, parts[-1]], dim=1)[:, -seen.shape[1] :]
    return torch.cat(parts, dim=1)[:, :frames]
