"""The trousers: straight legs that fall on the shoes, with folds at knees and ankles."""

import numpy as np

from agent_server.web.tools.human import cloth
from agent_server.web.tools.human.figure import SOLE, Figure
from agent_server.web.tools.human.makehuman import Array
from agent_server.web.tools.human.mesh import Mesh, cut, normals
from agent_server.web.tools.human.noise import bump, crease, noise, step

WAIST = 0.015
"""Metres from the hip bone up to where they begin, under the shirt."""
CUFF = 0.054
"""Metres above the bare foot, where they end."""
TRIANGLES = 2700
HEM = 0.022


def trousers(skin: Mesh, figure: Figure) -> Mesh:
    """Make the trousers.

    Args:
        skin: The tights.
        figure: The body.

    Returns:
        The cloth, with ``normal``, ``weights`` and ``colour``, which is white but for seams.
    """
    waist = figure.rig["Hips"][1] + WAIST
    skin = cut(skin, waist - skin.positions[:, 1])
    skin = cut(skin, skin.positions[:, 1] - SOLE - CUFF + 0.04)
    legs = cloth.draped(skin, 0.008, 0.004, 10)
    legs = legs.moved(_straightened(legs, figure))
    legs = legs.moved(legs.positions + _folds(legs, figure))
    legs = cut(legs, _above_cuff(legs))
    legs = cloth.banded(legs, _above_cuff(legs), HEM)
    return cloth.finished(legs.only("weights", "seam", "line"), TRIANGLES)


def _above_cuff(mesh: Mesh) -> Array:
    """Metres above the cuff, which is lower behind than in front."""
    return mesh.positions[:, 1] - SOLE - CUFF - 0.08 * (mesh.positions[:, 2] - 0.02)


def _straightened(legs: Mesh, figure: Figure) -> Array:
    """Below the hips the leg is at least as wide as a straight trouser leg."""
    points = legs.positions.copy()
    y = points[:, 1]
    for side in ("Left", "Right"):
        hip, knee, ankle = (figure.rig[side + bone] for bone in ("UpLeg", "Leg", "Foot"))
        rows = [ankle, knee, hip]
        middle = np.stack(
            [np.interp(y, [p[1] for p in rows], [p[k] for p in rows]) for k in (0, 2)], axis=1
        )
        # The front falls over the instep.
        middle[:, 1] += 0.007 * step(0.5 * (knee[1] + ankle[1]), ankle[1], y)
        away = points[:, [0, 2]] - middle
        radius = np.linalg.norm(away, axis=1)
        wanted = np.interp(y, [ankle[1], knee[1], hip[1]], [0.066, 0.072, 0.08])
        # A soft maximum, so that the calf does not show as a step.
        wider = wanted + 0.5 * (radius - wanted + np.hypot(radius - wanted, 0.008))
        share = step(hip[1] - 0.12, hip[1] - 0.34, y) * (points[:, 0] * hip[0] > 0)
        grown = middle + away * (wider / np.maximum(radius, 1e-6))[:, None]
        points[:, [0, 2]] += share[:, None] * (grown - points[:, [0, 2]])
    return points


def _folds(legs: Mesh, figure: Figure) -> Array:
    """Creases: stacked above the shoe, across the knee, and from the crotch."""
    points = legs.positions
    x, y, z = points.T
    knee = figure.rig["LeftLeg"]
    side = np.sign(x)
    turn = np.arctan2(np.abs(x) - knee[0], z - 0.02)
    stacked = step(0.36, 0.10, y) * crease(
        np.stack([turn * 0.9, y * 21 + 0.9 * np.sin(turn + side), side * 5], axis=1), 11
    )
    behind = step(0.03, -0.03, z - knee[2])
    bend = bump(((y - knee[1] + 0.01) / 0.09) ** 2) * (0.35 + behind)
    across = crease(np.stack([turn * 0.8, y * 24, side * 5], axis=1), 12)
    crotch = figure.rig["LeftUpLeg"][1] - 0.07
    angle = np.arctan2(y - crotch, np.abs(x) + 0.02)
    distance = np.hypot(x, y - crotch)
    rays = noise(np.stack([angle * 5, distance * 6, np.sign(z) * 3], axis=1), 13)
    groin = 0.0035 * rays * bump(((distance - 0.09) / 0.07) ** 2)
    long = 0.003 * noise(np.stack([x * 22, y * 3.2, z * 22], axis=1), 14) * step(0.95, 0.75, y)
    amount = 0.0034 * stacked + 0.0026 * bend * across + groin + long
    return amount[:, None] * normals(points, legs.triangles)
