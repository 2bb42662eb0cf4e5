"""Bones and the shape of a pose, for checks and for training losses.

Poses are joint positions of shape (..., J, 3); all leading axes are batch axes.
"""

from collections.abc import Sequence

import numpy as np

from agent_server.domain.arrays import Float64


def bone_lengths(poses: Float64, bones: Sequence[tuple[int, int]]) -> Float64:
    """Length of every bone.

    Args:
        poses: Shape (..., J, 3), in any unit.
        bones: B pairs (parent, child) of joint indices.

    Returns:
        Shape (..., B), in the unit.
    """
    parents, children = np.asarray(bones, dtype=np.intp).T
    bone = poses[..., children, :] - poses[..., parents, :]
    length: Float64 = np.linalg.norm(bone, axis=-1)
    return length


def bone_length_error(poses: Float64, truth: Float64, bones: Sequence[tuple[int, int]]) -> Float64:
    """Mean absolute difference of the bones' lengths.

    Args:
        poses: Shape (..., J, 3), in any unit.
        truth: Shape (..., J, 3), in the same unit.
        bones: Pairs (parent, child) of joint indices.

    Returns:
        Shape (...,), in the unit.
    """
    difference = bone_lengths(poses, bones) - bone_lengths(truth, bones)
    error: Float64 = np.abs(difference).mean(axis=-1)
    return error


def gram_matrix(poses: Float64) -> Float64:
    """Gram matrix P P^T of the joints, which forgets how the body is turned.

    Args:
        poses: Shape (..., J, 3), relative to a joint of the body, in any unit.

    Returns:
        Shape (..., J, J), positive semidefinite, in the unit squared.
    """
    return poses @ np.swapaxes(poses, -1, -2)


def gram_distance(a: Float64, b: Float64) -> Float64:
    """Squared distance between two poses' Gram matrices: the skeleton integrity loss.

    tr(A A^T) + tr(B B^T) - 2 sum of the singular values of B^T A, which is the least squared
    distance over all rotations and reflections of one pose (B. Chopin et al., "Human motion
    prediction using manifold-aware Wasserstein GAN", FG 2021, equations 7 and 8, which sum it
    over the frames). It is evaluated as the distance after the best rotation, because the
    traces cancel for poses that are nearly equal.

    Args:
        a: Shape (..., J, 3), relative to a joint of the body, in any unit.
        b: Shape (..., J, 3), likewise.

    Returns:
        Shape (...,), in the unit squared; 0 where a rotation or a reflection takes one pose to
        the other.
    """
    u, _, vt = np.linalg.svd(np.swapaxes(b, -1, -2) @ a)
    difference = a - b @ (u @ vt)
    squared: Float64 = (difference * difference).sum(axis=(-2, -1))
    return squared
