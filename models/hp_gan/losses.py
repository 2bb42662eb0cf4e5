"""What the generator is asked for beside the discriminator's favour."""

from collections.abc import Sequence

import torch

from models.ops.losses import TINY, bone_loss

APART_M = 0.1
"""Two futures that are so far apart on average have about a third of the diversity term left."""


def consistency(seen: torch.Tensor, future: torch.Tensor) -> torch.Tensor:
    """How much the first step differs from the last seen one, in metres a frame.

    Args:
        seen: Shape (B, T, J, 3), metres.
        future: Shape (B, F, J, 3), metres.
    """
    first, last = future[:, 0] - seen[:, -1], seen[:, -1] - seen[:, -2]
    return torch.sqrt(((first - last) ** 2).sum(-1) + TINY).mean()


def diversity(
    one: torch.Tensor, other: torch.Tensor, z: torch.Tensor, other_z: torch.Tensor
) -> torch.Tensor:
    """1 where two futures of one past are alike, towards 0 the farther apart they are.

    Futures whose random vectors are close may be close too: distances are divided by that of the
    vectors, which is 1 on average.

    Args:
        one: Shape (B, F, J, 3), metres.
        other: The same.
        z: Shape (B, Z), what ``one`` was drawn with.
        other_z: The same of ``other``.
    """
    apart = torch.sqrt(((one - other) ** 2).sum(-1) + TINY).mean(dim=(1, 2))
    away = (z - other_z).norm(dim=1) / (2 * z.shape[1]) ** 0.5
    return torch.exp(-apart / (APART_M * away)).mean()


def energy(future: torch.Tensor, true: torch.Tensor, last: torch.Tensor) -> torch.Tensor:
    """How far mean speed and acceleration of the centre of mass are from the truth's.

    Args:
        future: Shape (B, F, J, 3), metres.
        true: The same.
        last: The last seen pose, shape (B, J, 3).

    Returns:
        The sum of both differences, in metres a frame (and a frame).
    """
    total = torch.zeros((), device=future.device)
    paths = [torch.cat([last[:, None], motion], dim=1).mean(dim=2) for motion in (future, true)]
    for _ in range(2):
        paths = [path.diff(dim=1) for path in paths]
        sizes = [torch.sqrt((path**2).sum(-1) + TINY).mean(dim=1) for path in paths]
        total = total + (sizes[0] - sizes[1]).abs().mean()
    return total


def physical_terms(
    seen: torch.Tensor,
    future: torch.Tensor,
    true: torch.Tensor,
    bones: Sequence[tuple[int, int]],
) -> dict[str, torch.Tensor]:
    """The terms that look at one future, by their name in the configuration."""
    return {
        "consistency": consistency(seen, future),
        "energy": energy(future, true, seen[:, -1]),
        "bones": bone_loss(future, true, bones),
    }
