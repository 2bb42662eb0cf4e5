"""What the reactions of a training set are like, for the limits of what a server plays."""

from collections.abc import Sequence

import numpy as np
import torch

from agent_server.domain.arrays import Float32
from agent_server.domain.reaction import Place, TrainingRange
from agent_server.skeleton.pair import ARMS, TORSO, UPPER_BODY, bone_vectors, with_lengths
from models.data.interactions import Interaction, facing

MOVING_SHARE = 0.99
"""Share of the training reactions' frames whose speed and acceleration lie within the limits ..."""
FORM_SHARE = 0.995
"""... and of those within the limit of each bone, and of each distance from the torso."""
BONE_SLACK = 0.5
"""A bone may be off by this share in any case: lengths are set right before they are played."""
UPPER_BONES = UPPER_BODY - 1


def training_range(interactions: Sequence[Interaction], rate_hz: int) -> TrainingRange:
    """Measure interactions: how they begin, and how their reactions move.

    Args:
        interactions: Of the training split.
        rate_hz: Frames a second.
    """
    pairs = [facing(one) for one in interactions]
    firsts = [_first_pose([pair[who] for pair in pairs]) for who in (0, 1)]
    lengths = np.linalg.norm(bone_vectors(firsts[1]), axis=-1)[:UPPER_BONES]
    bones, speeds, accelerations, reaches = [], [], [], []
    for _, motion in pairs:
        reaction = motion.numpy()
        upper = reaction[:, :UPPER_BODY]
        found = np.linalg.norm(bone_vectors(reaction), axis=-1)[:, :UPPER_BONES]
        bones.append(np.abs(found / lengths - 1))
        speeds.append(_fastest(np.diff(upper, axis=0)) * rate_hz)
        accelerations.append(_fastest(np.diff(upper, 2, axis=0)) * rate_hz**2)
        reaches.append(np.linalg.norm(upper[:, ARMS, :] - upper[:, [TORSO]], axis=-1))
    return TrainingRange(
        action=_places(firsts[0]),
        reaction=_places(firsts[1]),
        bones=tuple(max(BONE_SLACK, limit) for limit in _limits(bones, FORM_SHARE)),
        speed_m_s=_limits(speeds, MOVING_SHARE)[0],
        acceleration_m_s2=_limits(accelerations, MOVING_SHARE)[0],
        reach_m=_limits(reaches, FORM_SHARE),
    )


def _first_pose(motions: Sequence[torch.Tensor]) -> Float32:
    """Mean first pose, shape (15, 3), whose bones have the median length of all frames."""
    poses = torch.cat(list(motions)).numpy()
    lengths = np.median(np.linalg.norm(bone_vectors(poses), axis=-1), axis=0)
    mean: Float32 = np.mean([motion[0].numpy() for motion in motions], axis=0)
    return with_lengths(mean, lengths)


def _places(pose: Float32) -> tuple[Place, ...]:
    return tuple(map(tuple, pose.astype(np.float64).round(4).tolist()))


def _fastest(steps: Float32) -> Float32:
    """Length of the longest of the joints' steps (T, J, 3) in each frame, shape (T, 1)."""
    longest: Float32 = np.linalg.norm(steps, axis=-1).max(1, keepdims=True)
    return longest


def _limits(parts: Sequence[Float32], share: float) -> tuple[float, ...]:
    """What this share of all rows of (T, N) lies within, for each of the N."""
    limits = np.quantile(np.concatenate(parts).astype(np.float64), share, axis=0)
    return tuple(limits.round(3).tolist())
