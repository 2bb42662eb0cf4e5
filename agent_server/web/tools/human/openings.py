"""Where clothes end and skin begins, as fields that clothes and skin are both cut by."""

import numpy as np

from agent_server.web.tools.human.figure import Figure
from agent_server.web.tools.human.makehuman import Array
from agent_server.web.tools.human.mesh import Mesh

FAR = 1.0
"""Metres, where an opening is nowhere near."""
NECK_CENTRE, NECK_RADII = 0.022, (0.096, 0.100)
"""Of the neckline seen from above: where it lies in front of the x axis, and how wide it is to
the sides and to the front, metres."""
NECK_BEHIND, NECK_AHEAD = -0.012, -0.072
"""How high the neckline lies behind and in front, metres above the neck bone."""
SLEEVE = 0.56
"""Where the sleeve ends, as a share of the way from the shoulder to the elbow."""


def from_neckline(mesh: Mesh, figure: Figure) -> Array:
    """Metres outwards from the neckline, negative on the neck and the head, (N,)."""
    x, z = mesh.positions[:, 0], mesh.positions[:, 2] - NECK_CENTRE
    y = mesh.positions[:, 1] - figure.rig["Neck"][1]
    beside = (np.hypot(x / NECK_RADII[0], z / NECK_RADII[1]) - 1) * NECK_RADII[0]
    share = (z / NECK_RADII[1] + 1) / 2
    below = NECK_BEHIND + (NECK_AHEAD - NECK_BEHIND) * share - y
    # Clothes are what is beside the neck or below it; the corner between them is rounded.
    distance = (beside + below + np.sqrt((beside - below) ** 2 + 0.03**2)) / 2
    is_head = y + 0.35 * z > 0.03
    return np.where(is_head, -FAR, distance)


def along_arm(mesh: Mesh, figure: Figure) -> Array:
    """The share of the way from shoulder to elbow, -1 on all that is not of an arm, (N,)."""
    share = np.full(len(mesh.positions), -FAR)
    for side in ("Left", "Right"):
        shoulder, elbow = figure.rig[f"{side}Arm"], figure.rig[f"{side}ForeArm"]
        axis = elbow - shoulder
        along = (mesh.positions - shoulder) @ axis / (axis @ axis)
        of_arm = mesh["weights"][:, arm_bones(figure, side)].sum(1) > 0.4
        share = np.where(of_arm, along, share)
    return share


def arm_bones(figure: Figure, side: str) -> list[int]:
    """The bones from the upper arm to the finger tips."""
    return [
        k
        for k, name in enumerate(figure.rig.names)
        if f"{side}Arm" in name or f"{side}ForeArm" in name or f"{side}Hand" in name
    ]
