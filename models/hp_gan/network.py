"""The generator of HP-GAN: recurrent, from a sequence to a sequence, with chance in its states.

After Barsoum, Kender and Liu, "HP-GAN: Probabilistic 3D human motion prediction via GAN" (CVPR
Workshops 2018): gated recurrent units read what was seen; a random vector ``z`` goes through a
learnt map of its own into every layer's state; from there on the decoder reads what it has said
last. Where this differs from the paper: 128 units instead of 1,024 and five frames a step of the
recurrence instead of one, so that ten futures fit into a decision; the decoder says how fast the
body goes at the end of each step, and in between its speed changes evenly, so that a future goes
on as the past ended; bones keep the lengths that they had; inside, the body faces the front.
"""

import torch
from torch import nn

from agent_server.domain.skeleton import CORE_BONES
from models.hp_gan.config import NetworkConfig
from models.ops.bones import with_lengths
from models.ops.heading import from_front, heading, to_front
from models.ops.losses import bone_lengths

POSITION_SCALE = 3.0
"""Brings positions in metres to about unit size."""
STEP_SCALE = 30.0
"""Brings steps in metres a frame to about unit size."""
STEADY_FRAMES = 5
"""The last speed is the mean over so many steps."""


def motion_features(motion: torch.Tensor) -> torch.Tensor:
    """Positions and steps of about unit size: (B, T, J, 3) -> (B, T, 6 J).

    It is linear, so that a point between two motions has the features between theirs.
    """
    flat = motion.flatten(2)
    steps = torch.cat([torch.zeros_like(flat[:, :1]), flat[:, 1:] - flat[:, :-1]], dim=1)
    return torch.cat([flat * POSITION_SCALE, steps * STEP_SCALE], dim=2)


def patches(features: torch.Tensor, frames: int) -> torch.Tensor:
    """Some frames as one moment each: (B, T, D) -> (B, T / frames, frames D)."""
    return features.reshape(features.shape[0], -1, frames * features.shape[2])


class Generator(nn.Module):
    """Seen positions and ``z`` -> one future.

    Args:
        config: Shape of the network.
    """

    def __init__(self, config: NetworkConfig) -> None:
        super().__init__()
        self.config = config
        coordinates = 3 * config.joints
        self.embed = nn.Linear(2 * coordinates * config.patch, config.width)
        self.encoder = nn.GRU(config.width, config.width, config.layers, batch_first=True)
        self.chance = nn.ModuleList(
            nn.Linear(config.noise, config.width) for _ in range(config.layers)
        )
        self.decoder = nn.ModuleList(
            nn.GRUCell(config.width, config.width) for _ in range(config.layers)
        )
        self.start = nn.Linear(config.width, 2 * coordinates)
        self.turn = nn.Linear(config.width, coordinates)
        self.keep = nn.Linear(config.width, 1)
        for layer in (self.start, self.turn):
            nn.init.normal_(layer.weight, std=0.01)
            nn.init.zeros_(layer.bias)

    def forward(self, seen: torch.Tensor, z: torch.Tensor) -> torch.Tensor:
        """(B, seen, J, 3) in metres, (B, Z) standard normal -> (B, future, J, 3) in metres."""
        direction = heading(seen)
        future = self.front_future(to_front(seen, direction), z)
        return from_front(future, direction)

    def front_future(self, seen: torch.Tensor, z: torch.Tensor) -> torch.Tensor:
        """The same for a body that faces the front."""
        features = motion_features(seen)
        moments = patches(features, self.config.patch)
        _, last = self.encoder(torch.tanh(self.embed(moments)))  # (layers, B, width)
        states = [
            state + chance(z) for state, chance in zip(last.unbind(0), self.chance, strict=True)
        ]
        patch = self.config.patch
        said, pose = moments[:, -1], seen[:, -1].flatten(1)
        step = (pose - seen[:, -1 - STEADY_FRAMES].flatten(1)) * (STEP_SCALE / STEADY_FRAMES)
        # Sensors shake: where the body is, and how fast it goes, is set right first.
        off, faster = self.start(last[-1]).chunk(2, dim=1)
        pose, step = pose + off / POSITION_SCALE, step + faster
        ramp = torch.arange(1, patch + 1, device=seen.device)[:, None] / patch
        poses = []
        for _ in range(self.config.future // patch):
            x = torch.tanh(self.embed(said))
            for layer, cell in enumerate(self.decoder):
                x = states[layer] = cell(x, states[layer])
            then = torch.sigmoid(self.keep(x)) * step + self.turn(x)
            steps = torch.lerp(step[:, None], then[:, None], ramp)  # (B, patch, 3 J)
            poses.append(pose[:, None] + torch.cumsum(steps, dim=1) / STEP_SCALE)
            pose, step = poses[-1][:, -1], then
            said = torch.cat([poses[-1] * POSITION_SCALE, steps], dim=2).flatten(1)
        future = torch.cat(poses, dim=1).unflatten(2, (-1, 3))
        lengths = bone_lengths(seen, CORE_BONES).mean(dim=1, keepdim=True)
        return with_lengths(future, lengths, CORE_BONES)

    def futures(self, seen: torch.Tensor, count: int, generator: torch.Generator) -> torch.Tensor:
        """Several futures of one past: (B, seen, J, 3) -> (B, count, future, J, 3)."""
        z = torch.randn(len(seen) * count, self.config.noise, generator=generator)
        future = self.forward(seen.repeat_interleave(count, 0), z.to(seen.device))
        drawn: torch.Tensor = future.unflatten(0, (len(seen), count))
        return drawn
