"""Real reactions varied, so that a judge does not learn how one person makes them."""

import torch

from models.data.interactions import TORSO, at_places
from models.data.layouts import KINECT15

LEAST_FRAMES = 8
"""No motion is made shorter than this."""


def vary_bodies(
    motion: torch.Tensor, generator: torch.Generator, limbs: float, turn: float
) -> torch.Tensor:
    """The same motions by people with other limbs, who look another way.

    Args:
        motion: Shape (B, T, 15, 3), metres, y up.
        generator: Of everything random.
        limbs: Deviation of a bone's length, as a share of it.
        turn: Largest turn about the vertical through the first torso, radians.
    """
    count = len(motion)
    factors = 1 + limbs * torch.randn(count, len(KINECT15.bones), generator=generator)
    grown = motion.clone()
    for number, (inner, outer) in enumerate(KINECT15.bones):
        bone = motion[:, :, outer] - motion[:, :, inner]
        grown[:, :, outer] = grown[:, :, inner] + factors[:, number, None, None] * bone
    angle = turn * (2 * torch.rand(count, generator=generator) - 1)
    cos, sin, zero, one = angle.cos(), angle.sin(), angle * 0.0, angle * 0.0 + 1.0
    rows = torch.stack([cos, zero, -sin, zero, one, zero, sin, zero, cos], dim=-1)
    around = motion[:, :1, TORSO : TORSO + 1]
    turned: torch.Tensor = (grown - around) @ rows.view(-1, 1, 3, 3) + around
    return turned


def vary_pace(
    motion: torch.Tensor, lengths: torch.Tensor, generator: torch.Generator, amount: float
) -> tuple[torch.Tensor, torch.Tensor]:
    """The same motions faster or slower, as a whole and from one moment to the next.

    Args:
        motion: Shape (B, T, 15, 3); what lies behind a length repeats the last pose.
        lengths: Shape (B,), frames that count.
        generator: Of everything random.
        amount: Largest change of the length, and of where the middle comes, as a share; below 1.

    Returns:
        Motions of the same shape, and their lengths, T at most.
    """
    count, frames = motion.shape[:2]
    longer, bend = 1 + amount * (2 * torch.rand(2, count, generator=generator) - 1)
    new = (lengths * longer).round().clamp(min(LEAST_FRAMES, frames), frames).long()
    at = torch.arange(frames) / (new[:, None] - 1)
    share = at.clamp(max=1.0)
    share = share + (bend[:, None] - 1) * share * (1 - share)
    return at_places(motion, share * (lengths[:, None] - 1)), new
