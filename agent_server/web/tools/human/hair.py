"""Short hair: a cap over the scalp, and tufts that lie over it and break its edge."""

import numpy as np

from agent_server.web.tools.human.decimate import decimated
from agent_server.web.tools.human.figure import Figure
from agent_server.web.tools.human.makehuman import Array, Indices
from agent_server.web.tools.human.mesh import Mesh, cut, merged, normals, smoothed
from agent_server.web.tools.human.noise import noise, step, unit
from agent_server.web.tools.human.scalp import above_eyes, above_hairline

CROWN = (0.0, 0.112, -0.012)
"""Where the hair parts: to the side, above the eyes, to the front, metres."""
SPACING = 0.0079
"""Metres between tufts."""
CAP_TRIANGLES = 750
ROWS = 4
LIFT = np.array([-0.0015, 0.0020, 0.0030, 0.0022])
WIDTH = np.array([0.0032, 0.0040, 0.0029, 0.0002])
"""Of a tuft from its root to its tip, metres above the cap and from its middle."""


def hair(skin: Mesh, figure: Figure) -> Mesh:
    """Grow the hair.

    Args:
        skin: The whole skin, with its weights.
        figure: The body.

    Returns:
        Cap and tufts, with ``normal``, ``weights`` and ``colour``, which is around white.
    """
    cap = _cap(skin, figure)
    tufts = _tufts(cap, figure)
    tone = 0.62 + 0.12 * noise(cap.positions * 90, 41)
    cap = decimated(cap.with_attributes(colour=_grey(tone)), CAP_TRIANGLES)
    return merged([cap, tufts])


def _cap(skin: Mesh, figure: Figure) -> Mesh:
    scalp = cut(skin, skin.positions[:, 1] - figure.rig["LeftEye"][1] + 0.09)
    line = above_hairline(scalp.positions, figure)
    scalp = cut(scalp, line + 0.001).only("weights")
    out = normals(scalp.positions, scalp.triangles)
    line = above_hairline(scalp.positions, figure)
    y = above_eyes(scalp.positions, figure)
    high = step(0.035, 0.095, y)
    front = step(0.09, 0.14, scalp.positions[:, 2]) * high
    thickness = (0.0015 + (0.0045 + 0.0125 * high + 0.004 * front) * step(0.0, 0.032, line))[
        :, None
    ]
    positions = scalp.positions + thickness * out
    positions = smoothed(positions, scalp.triangles, 3, 0.4)
    return scalp.moved(positions).with_attributes(normal=normals(positions, scalp.triangles))


def _tufts(cap: Mesh, figure: Figure) -> Mesh:
    """Strips of three quads that follow the cap and end in a point."""
    roots, owner = _roots(cap)
    chance = np.stack([noise(roots * 7919 + k, 50 + k) for k in range(4)], axis=1)
    y = above_eyes(roots, figure)
    line = above_hairline(roots, figure)
    high = step(0.04, 0.085, y)
    length = (0.014 + 0.010 * step(0.0, 0.02, line) + 0.012 * high) * (1 + 0.25 * chance[:, 0])
    point, out = roots, cap["normal"][owner]
    turn = 0.28 * chance[:, 1] + 0.5 * noise(roots * 28, 60)
    rows, sides, outs = [], [], []
    for k in range(ROWS):
        flow = _flow(point, out, figure)
        side = unit(np.cross(out, flow))
        flow = unit(flow * np.cos(turn)[:, None] + side * np.sin(turn)[:, None])
        side = unit(np.cross(out, flow))
        lift = LIFT[k] * (1 + 0.5 * chance[:, 2] * (k > 0)) * (0.45 + 0.55 * step(0, 0.02, line))
        rows.append(point + lift[:, None] * out)
        sides.append(side)
        outs.append(out)
        point, out = _slid(cap, point + flow * (length / (ROWS - 1))[:, None])
    count = len(roots)
    positions, normal = [], []
    for row, side, out, width in zip(rows, sides, outs, WIDTH, strict=True):
        for sign in (-1, 1):
            positions.append(row + sign * width * side * (0.7 + 0.3 * high)[:, None])
            normal.append(unit(out + 0.30 * sign * side))
    index = np.arange(count)[:, None]
    triangles = []
    for k in range(0, 2 * ROWS - 2, 2):
        triangles.append(index + count * np.array([k, k + 2, k + 1]))
        if k < 2 * ROWS - 4:
            triangles.append(index + count * np.array([k + 1, k + 2, k + 3]))
    shade = np.repeat([0.72, 0.92, 1.03, 1.10], 2)[:, None] * (1 + 0.22 * chance[:, 3])
    mesh = Mesh(
        np.concatenate(positions),
        np.concatenate(triangles),
        {
            "weights": np.tile(cap["weights"][owner], (2 * ROWS, 1)),
            "normal": np.concatenate(normal),
            "colour": _grey(shade.reshape(-1)),
        },
    )
    return mesh.compacted(mesh.triangles)


def _roots(cap: Mesh) -> tuple[Array, Indices]:
    """Places spread over the cap, and the nearest vertex of each."""
    corners = cap.positions[cap.triangles]
    crosses = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    ends = np.cumsum(np.linalg.norm(crosses, axis=1) / 2 / SPACING**2)
    number = np.arange(int(ends[-1]))
    owner = np.searchsorted(ends, number + 0.5)
    row = np.stack([number * 1.7 + 0.5, 0.5 + 0 * number, 0.5 + 0 * number], axis=1)
    one, two = (0.5 + 0.5 * noise(row, 70 + k)[:, None] for k in range(2))
    one = np.sqrt(one)
    a, b, c = (corners[owner, k] for k in range(3))
    roots = (1 - one) * a + one * (1 - two) * b + one * two * c
    return roots, _nearest(cap, roots)


def _nearest(cap: Mesh, points: Array) -> Indices:
    distances = ((points[:, None] - cap.positions[None]) ** 2).sum(2)
    nearest: Indices = distances.argmin(1)
    return nearest


def _slid(cap: Mesh, points: Array) -> tuple[Array, Array]:
    """Points brought back onto the cap, and its normals there."""
    near = _nearest(cap, points)
    out = cap["normal"][near]
    height = ((points - cap.positions[near]) * out).sum(1, keepdims=True)
    return points - height * out, out


def _flow(points: Array, out: Array, figure: Figure) -> Array:
    """Which way hair lies: away from the crown, and over the forehead to one side, (N, 3)."""
    eyes = figure.rig["LeftEye"] * [0, 1, 0]
    away = unit(points - eyes - CROWN)
    y = above_eyes(points, figure)
    fringe = (step(0.06, 0.115, points[:, 2]) * step(0.05, 0.075, y))[:, None]
    at_edge = step(0.020, 0.003, above_hairline(points, figure))[:, None]
    swept = np.array([0.75, 0.45, -0.15]) * (1 - at_edge) + at_edge * [0.55, -0.45, 0.45]
    flow = away * (1 - fringe) + fringe * swept
    flow = flow + [0.0, -0.5, 0.0] * (1 - step(0.03, 0.08, y))[:, None]
    return unit(flow - (flow * out).sum(1, keepdims=True) * out)


def _grey(shade: Array) -> Array:
    colour = np.repeat(shade[:, None], 4, axis=1)
    colour[:, 3] = 1
    return colour
