"""siMLPe: a stack of linear maps over the DCT of the past.

After Guo et al., "Back to MLP: A Simple Baseline for Human Motion Prediction" (WACV 2023), with
the settings of their Human3.6M experiments: 48 blocks of a linear map over time and a layer
normalisation over the coordinates, each added to its input; one linear map over the coordinates
before and after; ten frames a pass, given as offsets from the last seen pose.
"""

import torch
from torch import nn

from models.ops.dct import dct_matrix
from models.ops.time import TimeLinear
from models.simlpe.config import NetworkConfig

SMALL = 1e-8
"""The published gain of the first weights: each block starts as the identity."""


class Block(nn.Module):
    """x + LN(W x), over time and over the coordinates."""

    def __init__(self, frames: int, coordinates: int, half: bool) -> None:
        super().__init__()
        self.time = TimeLinear(frames, frames, half)
        self.norm = nn.LayerNorm(coordinates)
        nn.init.xavier_uniform_(self.time.weight, gain=SMALL)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        """(T, B, C) -> (T, B, C)."""
        out: torch.Tensor = x + self.norm(self.time(x))
        return out


class SiMlpe(nn.Module):
    """Seen poses -> future poses.

    Args:
        config: Shape of the network.
        half: Multiply in bfloat16 while training.
    """

    dct: torch.Tensor
    idct: torch.Tensor

    def __init__(self, config: NetworkConfig, half: bool = False) -> None:
        super().__init__()
        self.config = config
        matrix = dct_matrix(config.seen)
        self.register_buffer("dct", matrix)
        self.register_buffer("idct", matrix.T[: config.step].contiguous())
        self.into = nn.Linear(config.coordinates, config.coordinates)
        self.blocks = nn.ModuleList(
            Block(config.seen, config.coordinates, half) for _ in range(config.blocks)
        )
        self.out = nn.Linear(config.coordinates, config.coordinates)
        nn.init.xavier_uniform_(self.out.weight, gain=SMALL)
        nn.init.zeros_(self.out.bias)

    def one_pass(self, seen: torch.Tensor) -> torch.Tensor:
        """(B, seen, C) -> (B, step, C), metres."""
        first = self.into((self.dct @ seen).transpose(0, 1).contiguous())  # (T, B, C)
        x = first
        for block in self.blocks:
            x = block(x)
        offsets = self.idct @ self.out(first + x).transpose(0, 1)
        future: torch.Tensor = seen[:, -1:] + offsets
        return future

    def forward(self, seen: torch.Tensor) -> torch.Tensor:
        """(B, seen, J, 3) -> (B, future, J, 3), metres, as many passes as it takes."""
        past = seen.flatten(2)
        parts: list[torch.Tensor] = []
        for _ in range(0, self.config.future, self.config.step):
            parts.append(self.one_pass(past))
            past = torch.cat([past, parts[-1]], dim=1)[:, -self.config.seen :]
        future = torch.cat(parts, dim=1)[:, : self.config.future]
        return future.reshape(*future.shape[:2], *seen.shape[2:])
