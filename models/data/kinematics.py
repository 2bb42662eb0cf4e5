"""Forward kinematics of a tree of joints, for every reader that has rotations and no positions.

Column vectors throughout: a joint's global rotation is G(i) = G(parent) R(i), and its position is
p(i) = p(parent) + G(parent) offset(i). Sets that are written for row vectors, G(i) = R(i)
G(parent) and p(i) = offset(i) G(parent) + p(parent), give the same positions once every R(i)
is transposed, so they need no second walk.
"""

from collections.abc import Sequence

import torch
from kornia.geometry.conversions import axis_angle_to_rotation_matrix


def rotation_matrices(exponential_maps: torch.Tensor) -> torch.Tensor:
    """Rotation matrices of axis-angle vectors.

    Args:
        exponential_maps: Shape (..., 3), axis times angle in radians.

    Returns:
        Shape (..., 3, 3); a column vector is turned by multiplying from the left.
    """
    flat = axis_angle_to_rotation_matrix(exponential_maps.reshape(-1, 3))
    return flat.reshape(*exponential_maps.shape, 3)


def forward_kinematics(
    rotations: torch.Tensor, parents: Sequence[int], offsets: torch.Tensor
) -> torch.Tensor:
    """Positions of all joints of a tree.

    Args:
        rotations: Shape (T, J, 3, 3), each joint's rotation in its parent's axes.
        parents: For each joint the index of its parent, which comes before it; -1 for a root.
        offsets: Shape (J, 3), or (T, J, 3) where they change with time; each joint in its
            parent's axes, any unit. A root's offset is its position.

    Returns:
        Shape (T, J, 3), in the unit of the offsets.
    """
    away = offsets.expand(len(rotations), len(parents), 3)[..., None]
    turned: list[torch.Tensor] = []
    positions: list[torch.Tensor] = []
    for joint, parent in enumerate(parents):
        if parent < 0:
            turned.append(rotations[:, joint])
            positions.append(away[:, joint])
        else:
            turned.append(turned[parent] @ rotations[:, joint])
            positions.append(positions[parent] + turned[parent] @ away[:, joint])
    return torch.stack(positions, dim=1).squeeze(-1)
