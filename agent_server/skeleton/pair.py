"""Two people with 15 joints each: the one who acts, and the one who reacts.

Poses stand in the frame of the pair: metres, y up, origin in the middle between both torsos at
the first frame, x from the first person to the second.
"""

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.skeleton import CORE_BONES, CORE_JOINTS, CoreJoint

JOINT_NAMES = (
    *("head", "neck", "torso", "left_shoulder", "left_elbow", "left_hand"),
    *("right_shoulder", "right_elbow", "right_hand", "left_hip", "left_knee", "left_foot"),
    *("right_hip", "right_knee", "right_foot"),
)
PARENTS = (1, 2, -1, 1, 3, 4, 1, 6, 7, 2, 9, 10, 2, 12, 13)
"""Of each joint; the torso has none."""
TORSO = 2
UPPER_BODY = CORE_JOINTS
"""The first nine joints are the core joints, in their order: a torso is a navel, a hand a wrist."""
ARMS = (4, 5, 7, 8)
"""Elbows and hands."""
BONES = tuple((PARENTS[child], child) for child in (1, 0, 3, 4, 5, 6, 7, 8, *range(9, 15)))
"""(parent, child), outwards from the torso."""
_UP = np.array([0.0, 1.0, 0.0])


def bone_vectors(poses: Float32) -> Float32:
    """Every bone of :data:`BONES`, shape (..., 14, 3), of poses (..., 15, 3)."""
    parents, children = np.array(BONES).T
    bones: Float32 = poses[..., children, :] - poses[..., parents, :]
    return bones


def with_lengths(poses: Float32, lengths: Float32) -> Float32:
    """Poses (..., 15, 3) whose bones are turned as they were and have these lengths (14,)."""
    bones = bone_vectors(poses)
    bones = bones * (lengths / np.maximum(np.linalg.norm(bones, axis=-1), 1e-6))[..., None]
    fixed = np.array(poses)
    for place, (parent, child) in enumerate(BONES):
        fixed[..., child, :] = fixed[..., parent, :] + bones[..., place, :]
    return fixed


def as_action(core: Float32, first: Float32) -> Float32:
    """A person's motion as the one of who acts, in the frame of the pair.

    The person is taken to face the agent: at the first frame the torso is where that of ``first``
    is, and the shoulders look along x. The size becomes that of ``first``. Legs are not among the
    core joints: those of ``first`` go along with the torso.

    Args:
        core: Shape (T, 9, 3), metres in the camera frame.
        first: Shape (15, 3), how who acts begins.

    Returns:
        Shape (T, 15, 3).
    """
    right, left = CoreJoint.RIGHT_SHOULDER, CoreJoint.LEFT_SHOULDER
    to_left = (core[:, left] - core[:, right]).mean(0)
    ahead = np.cross(to_left, _UP)
    x, _, z = ahead / max(float(np.linalg.norm(ahead)), 1e-6)
    turn = np.array([[x, 0.0, -z], [0.0, 1.0, 0.0], [z, 0.0, x]])
    size = _size(first) / max(_size(core), 1e-6)
    moved = size * (core - core[0, CoreJoint.NAVEL]) @ turn + first[TORSO]
    legs = moved[:, None, TORSO] + (first - first[TORSO])[UPPER_BODY:]
    action: Float32 = np.concatenate([moved, legs], axis=1).astype(np.float32)
    return action


def _size(poses: Float32) -> float:
    """Summed length of the core bones, the median of all frames of poses (..., 9 or 15, 3)."""
    parents, children = np.array(CORE_BONES).T
    bones = poses[..., children, :] - poses[..., parents, :]
    return float(np.median(np.linalg.norm(bones, axis=-1).sum(-1)))


def as_agent(reaction: Float32, first: Float32) -> Float32:
    """A reaction as the agent sees itself.

    Args:
        reaction: Shape (..., 15, 3), in the frame of the pair.
        first: Shape (15, 3), how who reacts begins.

    Returns:
        The same shape: y up, z forward out of the agent, x to its left, origin on the floor below
        the torso of ``first``.
    """
    origin = np.array([first[TORSO, 0], first[:, 1].min(), first[TORSO, 2]])
    x, y, z = np.moveaxis(reaction - origin, -1, 0)
    agent: Float32 = np.stack([z, y, -x], axis=-1).astype(np.float32)
    return agent
