"""Low shoes lofted around the feet, and socks that close the gap to the trousers."""

import numpy as np

from agent_server.web.tools.human.cloth import welded
from agent_server.web.tools.human.decimate import decimated
from agent_server.web.tools.human.figure import SOLE, Figure
from agent_server.web.tools.human.makehuman import Array, Indices, MakeHuman
from agent_server.web.tools.human.mesh import Mesh, cut, merged, normals
from agent_server.web.tools.human.noise import step

STATIONS, AROUND = 18, 13
ROOM = 0.006
"""Metres between the foot and the shoe."""
COLLAR = 0.058
"""How high the shoe reaches at the ankle, metres above the insole."""
TOE_SPRING = 0.008
"""How far the sole rises at the toes, metres."""


def socks(skin: Mesh) -> Mesh:
    """A ring around each ankle, from inside the shoe to inside the trouser leg."""
    y = skin.positions[:, 1] - SOLE
    ring = cut(skin.moved(skin.positions + 0.002 * skin["normal"]), y - 0.05)
    ring = cut(ring, 0.17 - (ring.positions[:, 1] - SOLE))
    return decimated(ring.only("weights", "normal"), 280)


def shoes(data: MakeHuman, figure: Figure) -> tuple[Mesh, Mesh]:
    """Make both shoes.

    Args:
        data: MakeHuman's data.
        figure: The body.

    Returns:
        The uppers and the soles, with ``normal``, ``weights`` and, for the uppers, ``colour``.
    """
    foot = _foot(data, figure)
    sections = _sections(foot)
    count = len(sections)
    uppers = Mesh(sections.reshape(-1, 3), _grid(count, AROUND), {"colour": _colour(count)})
    uppers = _finished(welded(uppers), figure)
    soles = _finished(_sole(sections), figure)
    return _pair(uppers, figure), _pair(soles, figure)


def _foot(data: MakeHuman, figure: Figure) -> Array:
    """The vertices of the left foot below the collar, (F, 3)."""
    body = figure.positions[np.unique(data.groups["body"].vertices)]
    near = body[:, 1] < SOLE + COLLAR + 0.01
    foot: Array = body[near & (body[:, 0] > 0)]
    return foot


def _sections(foot: Array) -> Array:
    """Arches over the foot from the outer to the inner edge, heel first, (S, AROUND, 3)."""
    back, front = foot[:, 2].min() - ROOM, foot[:, 2].max() + ROOM + 0.008
    share = (1 - np.cos(np.linspace(0, np.pi, STATIONS))) / 2
    share = 0.35 * share + 0.65 * np.linspace(0, 1, STATIONS)
    stations = back + (front - back) * share
    low, high, top = (np.zeros(STATIONS) for _ in range(3))
    for k, z in enumerate(stations):
        near = foot[np.abs(foot[:, 2] - np.clip(z, back + 0.02, front - 0.03)) < 0.015]
        low[k], high[k], top[k] = near[:, 0].min(), near[:, 0].max(), near[:, 1].max()
    for values in (low, high, top):
        values[1:-1] = (values[:-2] + 2 * values[1:-1] + values[2:]) / 4
    # The ends are rounded off like an ellipse.
    heel = np.sqrt(np.clip(1 - ((back + 0.035 - stations) / 0.035).clip(0) ** 2.2, 0, 1))
    toes = np.sqrt(np.clip(1 - ((stations - front + 0.07) / 0.07).clip(0) ** 2.4, 0, 1))
    middle, half = (low + high) / 2, (high - low) / 2 + ROOM
    half = half * np.minimum(heel, toes)
    half[[0, -1]] = 0
    height = np.clip(top - SOLE + ROOM, 0.046, COLLAR)
    height = height * (0.35 + 0.65 * np.sqrt(toes)) * np.where(heel < 1, 0.93 + 0.07 * heel, 1)
    height[1:-1] = (height[:-2] + 2 * height[1:-1] + height[2:]) / 4
    turn = np.linspace(0, np.pi, AROUND)
    across = np.sign(np.cos(turn)) * np.abs(np.cos(turn)) ** 0.72
    up = np.sin(turn) ** 0.8
    return np.stack(
        [
            middle[:, None] + half[:, None] * across,
            SOLE - 0.006 + (height[:, None] + 0.006) * up + _spring(stations, front)[:, None],
            np.repeat(stations[:, None], AROUND, axis=1),
        ],
        axis=2,
    )


def _spring(z: Array, front: float) -> Array:
    """How far the sole has risen at each place, metres."""
    return TOE_SPRING * step(front - 0.09, front + 0.03, z)


def _sole(sections: Array) -> Mesh:
    """A slab below the edge of the upper, closed below."""
    outline = np.concatenate([sections[:, 0], sections[::-1, -1]])
    centre = outline.mean(0)
    wide = outline + 0.004 * (outline - centre) / np.linalg.norm(
        (outline - centre)[:, [0, 2]], axis=1, keepdims=True
    )
    spring = (outline[:, 1] - outline[:, 1].min())[:, None] * [0.0, 1.0, 0.0]
    rows = []
    for source, y in ((outline, SOLE + 0.004), (wide, SOLE + 0.002), (wide, 0.004), (outline, 0.0)):
        rows.append(source * [1, 0, 1] + [0, y, 0] + spring)
    points = np.concatenate(rows)
    count = len(outline)
    ring = np.arange(count)
    following = np.roll(ring, -1)
    quads = [
        np.stack(
            [
                k * count + ring,
                k * count + following,
                (k + 1) * count + following,
                (k + 1) * count + ring,
            ],
            1,
        )
        for k in range(3)
    ]
    sides = np.concatenate(quads)
    below = 3 * count
    half = count // 2
    bottom = np.array(
        [
            [below + k, below + k + 1, below + count - 2 - k, below + count - 1 - k]
            for k in range(half - 1)
        ]
    )
    faces = np.concatenate([sides, bottom])
    triangles = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    return Mesh(points, triangles, {})


def _grid(rows: int, columns: int) -> Indices:
    """Triangles between the rows of a grid of vertices."""
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1)
    a, b, c, d = corner, corner + 1, corner + columns + 1, corner + columns
    return np.concatenate([np.c_[a, b, c], np.c_[a, c, d]])


def _finished(mesh: Mesh, figure: Figure) -> Mesh:
    """Let a left shoe follow foot and toes, and see that it faces outwards."""
    centre = mesh.positions.mean(0)
    corners = mesh.positions[mesh.triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    if ((corners.mean(1) - centre) * faces).sum() < 0:
        mesh = Mesh(mesh.positions, mesh.triangles[:, ::-1], mesh.attributes)
    ball = figure.rig["LeftToeBase"][2]
    toes = step(ball - 0.03, ball + 0.03, mesh.positions[:, 2])[:, None]
    count = len(mesh.positions)
    weights = toes * figure.rig.only("LeftToeBase", count)
    weights = weights + (1 - toes) * figure.rig.only("LeftFoot", count)
    return mesh.with_attributes(weights=weights, normal=normals(mesh.positions, mesh.triangles))


def _colour(stations: int) -> Array:
    """Darker at the collar and where the laces are, (S * AROUND, 4)."""
    along = np.linspace(0, 1, stations)[:, None]
    over = np.abs(np.linspace(-1, 1, AROUND))[None]
    tongue = step(0.42, 0.30, over) * step(0.36, 0.42, along) * step(0.74, 0.68, along)
    shade = 1 - 0.45 * tongue
    colour = np.repeat(shade[..., None], 4, axis=2)
    colour[..., 3] = 1
    return colour.reshape(-1, 4)


def _pair(left: Mesh, figure: Figure) -> Mesh:
    """A left shoe and its mirror image."""
    weights = left["weights"].copy()
    for bone in ("Foot", "ToeBase"):
        one, two = figure.rig.index(f"Left{bone}"), figure.rig.index(f"Right{bone}")
        weights[:, [one, two]] = weights[:, [two, one]]
    right = Mesh(left.positions * [-1, 1, 1], left.triangles[:, ::-1], left.attributes)
    right = right.with_attributes(weights=weights, normal=left["normal"] * [-1, 1, 1])
    return merged([left, right])
