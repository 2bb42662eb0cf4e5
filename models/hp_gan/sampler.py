"""The generator and the quality network as one graph that draws by number."""

from collections.abc import Iterable

import torch
from torch import nn

from models.hp_gan.judge import JUDGED_REAL, Judge

DRAWS = 16
"""Random vectors that the graph holds: as many futures as it can draw of one motion."""
CANDIDATES, LIKELY = 256, 64
ASKED = 100
"""Windows of each kind that random vectors are chosen with."""
SEED = 0


class Sampler(nn.Module):
    """Seen positions and the number of a draw -> a future and its quality.

    The random vectors are part of the graph, so that a number means the same future on every
    machine, now and in a replay.

    Args:
        generator: (B, seen, J, 3), (B, Z) -> (B, future, J, 3), metres.
        judge: Says how probably a motion is real.
        table: Random vectors, shape (draws, Z).
    """

    table: torch.Tensor

    def __init__(self, generator: nn.Module, judge: Judge, table: torch.Tensor) -> None:
        super().__init__()
        self.generator, self.judge = generator, judge
        self.register_buffer("table", table)

    def forward(self, seen: torch.Tensor, draw: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """(B, seen, J, 3), (B,) in 0..draws - 1 -> (B, future, J, 3), (B,) in [0, 1]."""
        future = self.generator(seen, self.table[draw])
        return future, self.judge.quality(seen, future)


def random_vectors(noise: int, count: int = DRAWS) -> torch.Tensor:
    """The first standard normal vectors (count, noise) of one sequence."""
    return torch.randn(count, noise, generator=torch.Generator().manual_seed(SEED))


@torch.no_grad()
def likely_vectors(
    generator: nn.Module, noise: int, judge: Judge, kinds: Iterable[torch.Tensor]
) -> torch.Tensor:
    """Random vectors (draws, noise) whose futures are judged real more often than most.

    A few vectors throw every body about. Of many candidates the likeliest quarter is kept, and
    of it the first, in the order in which they were drawn: the likeliest alone are alike.

    Args:
        generator: (B, seen, J, 3), (B, Z) -> (B, future, J, 3), metres.
        noise: Z.
        judge: Says how probably a motion is real.
        kinds: Windows (N, seen, J, 3) that nothing is measured on; each kind counts the same.
    """
    candidates = random_vectors(noise, CANDIDATES)
    shares = torch.zeros(CANDIDATES)
    for windows in kinds:
        seen = windows[:: -(-len(windows) // ASKED)]
        for index, z in enumerate(candidates):
            future = generator(seen, z.expand(len(seen), -1))
            shares[index] += (judge.quality(seen, future) > JUDGED_REAL).float().mean()
    likely = shares.argsort(descending=True, stable=True)[:LIKELY].sort().values
    return candidates[likely[:DRAWS]]
