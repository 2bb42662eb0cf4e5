"""Bones that keep their length."""

from collections.abc import Sequence

import torch

from models.ops.losses import TINY


def with_lengths(
    poses: torch.Tensor, lengths: torch.Tensor, bones: Sequence[tuple[int, int]]
) -> torch.Tensor:
    """Poses whose bones keep their direction and get a length; the root stays where it is.

    Args:
        poses: Shape (..., J, 3), metres.
        lengths: Shape (..., number of bones), metres; broadcasts against the poses.
        bones: (parent, child) outwards from one root, which is no bone's child.
    """
    joints = list(poses.unbind(-2))
    for index, (parent, child) in enumerate(bones):
        line = poses[..., child, :] - poses[..., parent, :]
        long = torch.sqrt((line * line).sum(-1, keepdim=True) + TINY)
        joints[child] = joints[parent] + line * (lengths[..., index, None] / long)
    return torch.stack(joints, dim=-2)
