"""What the generator is asked for beside the discriminator's favour."""

from collections.abc import Sequence

import torch

from models.ops.losses import TINY, bone_loss

LEAST_APART_M = 0.01
"""How far apart the futures of a body are wanted that does not move at all."""


def consistency(seen: torch.Tensor, future: torch.Tensor) -> torch.Tensor:
    """How much the first step differs from the last seen one, in metres a frame.

    Args:
        seen: Shape (B, T, J, 3), metres.
        future: Shape (B, F, J, 3), metres.
    """
    first, last = future[:, 0] - seen[:, -1], seen[:, -1] - seen[:, -2]
    return torch.sqrt(((first - last) ** 2).sum(-1) + TINY).mean()


def diversity(
    futures: Sequence[torch.Tensor],
    draws: Sequence[torch.Tensor],
    true: torch.Tensor,
    last: torch.Tensor,
) -> torch.Tensor:
    """1 where two futures of one past are alike, 0 where they are as far apart as wanted.

    They are wanted as far apart as the body goes in truth, and no farther, so that a body at rest
    need not be thrown about. Futures whose random vectors are close may be close too.

    Args:
        futures: Two of shape (B, F, J, 3), metres.
        draws: What they were drawn with, shape (B, Z) each.
        true: What came, shape (B, F, J, 3).
        last: The last seen pose, shape (B, J, 3).
    """
    apart = _distance(futures[0], futures[1])
    away = (draws[0] - draws[1]).norm(dim=1) / (2 * draws[0].shape[1]) ** 0.5  # 1 on average
    wanted = away * (_distance(true, last[:, None]) + LEAST_APART_M)
    return torch.relu(1 - apart / wanted).mean()


def nearest(futures: Sequence[torch.Tensor], true: torch.Tensor) -> torch.Tensor:
    """How far the nearer of several futures is from what came, in metres.

    Gupta et al., "Social GAN: Socially Acceptable Trajectories with Generative Adversarial
    Networks" (CVPR 2018): one of them ought to come true; the others are free.

    Args:
        futures: Each of shape (B, F, J, 3), metres.
        true: What came, shape (B, F, J, 3).
    """
    off = torch.stack([_distance(future, true) for future in futures])
    return off.min(dim=0).values.mean()


def _distance(one: torch.Tensor, other: torch.Tensor) -> torch.Tensor:
    """Mean over frames and joints, shape (B,)."""
    return torch.sqrt(((one - other) ** 2).sum(-1) + TINY).mean(dim=(1, 2))


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
