"""The tee shirt: short sleeves, a round neck with a rib, hems, and a few folds."""

import numpy as np

from agent_server.web.tools.human import cloth
from agent_server.web.tools.human.figure import Figure
from agent_server.web.tools.human.makehuman import Array
from agent_server.web.tools.human.mesh import Mesh, cut, normals, smoothed
from agent_server.web.tools.human.noise import bump, crease, step
from agent_server.web.tools.human.openings import FAR, SLEEVE, along_arm, from_neckline

HEM_BELOW_HIPS = 0.05
"""Metres from the hip bone down to the hem."""
TRIANGLES = 3100
RIB, HEM = 0.019, 0.021
"""Widths, metres."""


def tee(skin: Mesh, figure: Figure) -> Mesh:
    """Make the shirt.

    Args:
        skin: The tights.
        figure: The body.

    Returns:
        The cloth, with ``normal``, ``weights`` and ``colour``, which is white but for seams.
    """
    hem = figure.rig["Hips"][1] - HEM_BELOW_HIPS
    skin = cut(skin, skin.positions[:, 1] - hem + 0.06)
    skin = cut(skin, SLEEVE + 0.25 - along_arm(skin, figure))
    shirt = cloth.draped(skin, 0.012, 0.006, 14)
    arm = along_arm(skin, figure)
    shirt = shirt.moved(shirt.positions + _looseness(shirt, skin, arm, figure, hem))
    shirt = shirt.moved(shirt.positions + _folds(shirt, arm, figure, hem))
    shirt = shirt.with_attributes(arm=arm[:, None], neck=from_neckline(shirt, figure)[:, None])
    shirt = cut(shirt, shirt["neck"][:, 0])
    shirt = cut(shirt, SLEEVE - shirt["arm"][:, 0])
    shirt = cut(shirt, _above(shirt, hem))
    shirt = _rounded_neck(shirt)
    shirt = cloth.banded(shirt, shirt["neck"][:, 0], RIB)
    shirt = cloth.banded(shirt, (SLEEVE - shirt["arm"][:, 0]) * _upper_arm(figure), HEM)
    shirt = cloth.banded(shirt, _above(shirt, hem), HEM)
    return cloth.finished(shirt.only("weights", "seam", "line"), TRIANGLES)


def _rounded_neck(shirt: Mesh) -> Mesh:
    """Round the corners of the neckline."""
    near = step(0.035, 0.01, shirt["neck"])
    return shirt.moved(smoothed(shirt.positions, shirt.triangles, 10, 0.5 * near))


def _above(mesh: Mesh, hem: float) -> Array:
    """Metres above the hem; the sleeves are far from it."""
    of_arm = mesh["arm"][:, 0] > 0.15 if "arm" in mesh.attributes else False
    return np.where(of_arm, FAR, mesh.positions[:, 1] - hem)


def _upper_arm(figure: Figure) -> float:
    """Its length, metres."""
    return float(np.linalg.norm(figure.rig["LeftForeArm"] - figure.rig["LeftArm"]))


def _looseness(shirt: Mesh, skin: Mesh, arm: Array, figure: Figure, hem: float) -> Array:
    """Cloth hangs from the chest, and sleeves stand off the arm."""
    height = shirt.positions[:, 1] - hem
    out = cloth.sideways(skin["normal"])
    body = (0.013 * step(0.36, 0.0, height) * (arm < 0.1))[:, None] * out
    opening = step(-0.05, SLEEVE, arm)[:, None]
    sleeve = opening * (0.011 * skin["normal"] + [0.0, -0.006, 0.0])
    return body + sleeve


def _folds(shirt: Mesh, arm: Array, figure: Figure, hem: float) -> Array:
    """Creases: slanting from the armpits, gathered at the waist, upright above the hem."""
    points = shirt.positions
    x, y, z = points.T
    height = y - hem
    turn = np.arctan2(x, z + 0.01) * 0.16  # metres around the trunk
    waist = bump(((height - 0.14) / 0.11) ** 2)
    slant = np.abs(turn) * 9
    gathered = crease(np.stack([turn * 6, height * 17 + slant, np.sign(z)], axis=1), 1)
    upright = crease(np.stack([turn * 15, height * 3.5, 0 * x], axis=1), 2)
    amount = 0.0042 * waist * gathered + 0.0045 * step(0.26, 0.02, height) * upright
    for side in (-1, 1):
        armpit = figure.rig["LeftArm"] * [side, 1, 1] - [side * 0.03, 0.09, 0]
        away = points - armpit
        distance = np.linalg.norm(away, axis=1)
        angle = np.arctan2(np.hypot(away[:, 0], 0.3 * away[:, 2]), -away[:, 1])
        rays = crease(np.stack([angle * 3.5, distance * 4, np.sign(z)], axis=1), 5 + side)
        amount = amount + 0.0045 * rays * bump(((distance - 0.13) / 0.08) ** 2)
    sleeve = step(0.0, 0.3, arm)
    rolls = crease(np.stack([arm * 3.5, x * 3, z * 8 + y * 4], axis=1), 7)
    amount = amount * (1 - sleeve) + 0.003 * sleeve * rolls
    amount = amount * step(0.02, 0.07, from_neckline(shirt, figure))
    return amount[:, None] * normals(points, shirt.triangles)
