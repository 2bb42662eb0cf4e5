"""Names of the joints that models predict, and how a body is turned towards the reader."""

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.skeleton import CORE_JOINT_NAMES
from models.data.layouts import CMU, CORE, H36M, Layout

_LEG = ("knee", "ankle", "ball of foot", "toe")
_H36M_ARM = ("shoulder", "elbow", "wrist", "thumb", "hand")
_CMU_ARM = ("shoulder", "elbow", "wrist", "hand", "fingers", "thumb")


def _side(side: str, parts: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(f"{side} {part}" for part in parts)


_NAMES = {
    H36M.name: (
        *_side("right", _LEG),
        *_side("left", _LEG),
        *("spine", "neck", "head", "crown"),
        *_side("left", _H36M_ARM),
        *_side("right", _H36M_ARM),
    ),
    CMU.name: (
        *_side("left", _LEG),
        *_side("right", _LEG),
        *("lower back", "chest", "lower neck", "upper neck", "head"),
        *_side("left", _CMU_ARM),
        *_side("right", _CMU_ARM),
    ),
    CORE.name: tuple(name.replace("_", " ") for name in CORE_JOINT_NAMES),
}


def joint_names(layout: Layout) -> tuple[str, ...]:
    """Name of each joint of a layout; those of a side begin with ``left`` or ``right``."""
    return _NAMES[layout.name]


def side_joints(layout: Layout, side: str) -> list[int]:
    """Places of the joints of a side, ``left`` or ``right``."""
    return [at for at, name in enumerate(joint_names(layout)) if name.startswith(f"{side} ")]


def head_joints(layout: Layout) -> list[int]:
    """Places of the joints between which the head lies."""
    return [at for at, name in enumerate(joint_names(layout)) if name in {"head", "crown"}]


def loose_ends(layout: Layout) -> list[int]:
    """Joints from which a separate part of the skeleton starts, none where it is all one piece.

    The literature's layouts leave out the pelvis and the hips, which their data hold at the origin,
    so that legs and trunk do not meet.
    """
    children = {child for _, child in layout.bones}
    roots = sorted({parent for parent, _ in layout.bones} - children)
    return roots if len(roots) > 1 else []


def oblique_axes(pose: Float32, layout: Layout) -> Float32:
    """Axes of a drawing that shows a body from its front, a little from its left and from above.

    Args:
        pose: Shape (J, 3), right-handed, y up; it decides where the front is.
        layout: Which joints are left and which are right.

    Returns:
        Shape (2, 3); its product with a position gives the place in the drawing (right, up).
    """
    up = np.array([0.0, 1.0, 0.0])
    names = joint_names(layout)
    across = pose[names.index("right shoulder")] - pose[names.index("left shoulder")]
    right = np.array([across[0], 0.0, across[2]])
    right /= max(float(np.linalg.norm(right)), 1e-9)
    front = np.cross(up, right)
    turn, tilt = np.radians(27), np.radians(10)
    viewer = np.cos(turn) * front - np.sin(turn) * right  # from the body towards the reader
    rightwards = np.cross(up, viewer)
    axes: Float32 = np.stack([rightwards, np.cos(tilt) * up - np.sin(tilt) * viewer])
    return axes.astype(np.float32)
