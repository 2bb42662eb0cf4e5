"""The losses of the manifold-aware WGAN papers, in torch."""

from collections.abc import Callable, Sequence

import torch

TINY = 1e-12


def gradient_penalty(
    critic: Callable[..., torch.Tensor],
    real: Sequence[torch.Tensor],
    fake: Sequence[torch.Tensor],
    generator: torch.Generator,
) -> torch.Tensor:
    """Mean of (|gradient| - 1)^2 at random points between real and fake inputs of the critic.

    The tangent space is flat, so a straight line between two of its points stays in it.

    Args:
        critic: Takes the inputs, gives a score each.
        real: The inputs, shape (B, ...) each: the tangent vectors, and what goes with them.
        fake: The same of the generator.
        generator: Draws the points.
    """
    share = torch.rand(len(real[0]), generator=generator).to(real[0].device)
    between = [
        torch.lerp(a, b, share.view(-1, *[1] * (a.dim() - 1))).detach().requires_grad_(True)
        for a, b in zip(fake, real, strict=True)
    ]
    score = critic(*between).sum()
    # A critic that ignores one of its inputs has no gradient there: zeros stand for it.
    gradients = torch.autograd.grad(score, between, create_graph=True, materialize_grads=True)
    squared = [(g * g).flatten(1).sum(1) for g in gradients]
    return ((torch.sqrt(torch.stack(squared).sum(0) + TINY) - 1) ** 2).mean()


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


def bone_lengths(poses: torch.Tensor, bones: Sequence[tuple[int, int]]) -> torch.Tensor:
    """Lengths of bones (parent, child): (..., J, 3) -> (..., number of bones), metres."""
    parents = [parent for parent, _ in bones]
    children = [child for _, child in bones]
    lines = poses[..., children, :] - poses[..., parents, :]
    return torch.sqrt((lines * lines).sum(-1) + TINY)


def bone_loss(
    predicted: torch.Tensor, true: torch.Tensor, bones: Sequence[tuple[int, int]]
) -> torch.Tensor:
    """Mean absolute difference of bone lengths in metres (Chopin et al. 2021, eq. 9)."""
    return (bone_lengths(predicted, bones) - bone_lengths(true, bones)).abs().mean()


def joint_distance(
    predicted: torch.Tensor, true: torch.Tensor, weights: torch.Tensor | None = None
) -> torch.Tensor:
    """Mean Euclidean distance of the joints of motions (B, T, J, 3), in their unit.

    Args:
        predicted: Positions or steps.
        true: The same of the truth.
        weights: Of the frames, shape (T,) with mean one.
    """
    frames = torch.sqrt(((predicted - true) ** 2).sum(-1) + TINY).mean(dim=(0, 2))
    return frames.mean() if weights is None else (weights * frames).mean()


def near_weights(frames: int, power: float) -> torch.Tensor:
    """Weights t**-power of the frames 1, 2, ..., with mean one, shape (frames,)."""
    weights = torch.arange(1, frames + 1, dtype=torch.float32) ** -power
    return weights / weights.mean()
