"""The losses of the manifold-aware WGAN papers, in torch."""

from collections.abc import Callable

import torch

from agent_server.domain.skeleton import CORE_BONES

TINY = 1e-12


def gradient_penalty(
    critic: Callable[[torch.Tensor], torch.Tensor],
    real: torch.Tensor,
    fake: torch.Tensor,
    generator: torch.Generator,
) -> torch.Tensor:
    """Mean of (|gradient| - 1)^2 at random points between real and fake tangent vectors (B, D).

    The tangent space is flat, so a straight line between two of its points stays in it.
    """
    share = torch.rand(len(real), 1, generator=generator).to(real.device)
    between = (share * real + (1 - share) * fake).detach().requires_grad_(True)
    score = critic(between).sum()
    (gradient,) = torch.autograd.grad(score, between, create_graph=True)
    return ((torch.sqrt((gradient * gradient).sum(-1) + TINY) - 1) ** 2).mean()


def gram_distance(predicted: torch.Tensor, true: torch.Tensor) -> torch.Tensor:
    """Distance of the Gram matrices of two poses (Chopin et al. 2021, eq. 7 and 8).

    With the poses as matrices P and Q of J x 3 it is |P|^2 + |Q|^2 - 2 |P^T Q|_*, the
    Procrustes distance: what is left after the best rotation, so the shape alone counts.

    Args:
        predicted: Shape (..., J, 3), metres.
        true: The same shape.

    Returns:
        Shape (...,), square metres.
    """
    nuclear: torch.Tensor = torch.linalg.svdvals(predicted.transpose(-1, -2) @ true).sum(-1)
    return (predicted**2).sum((-1, -2)) + (true**2).sum((-1, -2)) - 2 * nuclear


def bone_lengths(poses: torch.Tensor) -> torch.Tensor:
    """Lengths of the eight bones: (..., 9, 3) -> (..., 8), metres."""
    parents = [parent for parent, _ in CORE_BONES]
    children = [child for _, child in CORE_BONES]
    bones = poses[..., children, :] - poses[..., parents, :]
    return torch.sqrt((bones * bones).sum(-1) + TINY)


def bone_loss(predicted: torch.Tensor, true: torch.Tensor) -> torch.Tensor:
    """Mean absolute difference of bone lengths in metres (Chopin et al. 2021, eq. 9)."""
    return (bone_lengths(predicted) - bone_lengths(true)).abs().mean()
