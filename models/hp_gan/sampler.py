"""The generator and the quality network as one graph that draws by number."""

import torch
from torch import nn

from models.hp_gan.judge import Judge

DRAWS = 16
"""Random vectors that the graph holds: as many futures as it can draw of one motion."""
SEED = 0


class Sampler(nn.Module):
    """Seen positions and the number of a draw -> a future and its quality.

    The random vectors are part of the graph, so that a number means the same future on every
    machine, now and in a replay.

    Args:
        generator: (B, seen, J, 3), (B, Z) -> (B, future, J, 3), metres.
        noise: Z.
        judge: Says how probably a motion is real.
    """

    table: torch.Tensor

    def __init__(self, generator: nn.Module, noise: int, judge: Judge) -> None:
        super().__init__()
        self.generator, self.judge = generator, judge
        draws = torch.Generator().manual_seed(SEED)
        self.register_buffer("table", torch.randn(DRAWS, noise, generator=draws))

    def forward(self, seen: torch.Tensor, draw: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """(B, seen, J, 3), (B,) in 0..DRAWS - 1 -> (B, future, J, 3), (B,) in [0, 1]."""
        future = self.generator(seen, self.table[draw])
        return future, self.judge.quality(seen, future)
