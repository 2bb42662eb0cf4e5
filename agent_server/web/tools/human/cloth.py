"""What every garment is made of: cloth that lies over the body, with hems that have thickness."""

import numpy as np

from agent_server.web.tools.human.decimate import decimated
from agent_server.web.tools.human.figure import Figure
from agent_server.web.tools.human.makehuman import Array, MakeHuman
from agent_server.web.tools.human.mesh import (
    Mesh,
    borders,
    halves,
    merged,
    normals,
    smoothed,
    subdivided,
    triangulated,
)
from agent_server.web.tools.human.noise import unit

TIGHTS = "helper-tights"
THICKNESS, HEM_RISE = 0.0035, 0.0004
"""Of the cloth, and how much thicker it is at a hem, metres."""
HEM_TONE = np.array([0.86, 0.86, 0.86, 1.0])
"""What the colour of hems is multiplied by."""
SLACK = 14
"""Rounds in which the weights of the cloth are smoothed."""


def tights(data: MakeHuman, figure: Figure) -> Mesh:
    """MakeHuman's second skin from the neck to wrists and toes, with four times its quads.

    Attributes: ``weights``, and ``normal`` of this skin.
    """
    quads = data.groups[TIGHTS].vertices
    used, packed = np.unique(quads, return_inverse=True)
    packed = packed.reshape(-1, 4)
    values = np.concatenate([figure.positions[used], figure.weights[used]], axis=1)
    values, packed = subdivided(values, packed)
    skin = triangulated(values[:, :3], packed, {"weights": values[:, 3:]})
    # Cloth bends less sharply than what is under it.
    skin = skin.with_attributes(weights=smoothed(skin["weights"], skin.triangles, SLACK, 0.5))
    return skin.with_attributes(normal=normals(skin.positions, skin.triangles))


def draped(skin: Mesh, offset: Array | float, least: float, rounds: int) -> Mesh:
    """Cloth over a skin: it bridges hollows and never comes closer than it must.

    Args:
        skin: The body, with its normals.
        offset: Where the cloth begins, metres from the skin, one or (N, 1).
        least: How close it may come, metres.
        rounds: How far it is pulled taut.
    """
    out = skin["normal"]
    positions = skin.positions + offset * out
    for _ in range(rounds):
        positions = smoothed(positions, skin.triangles, 1, 0.5)
        gap = ((positions - skin.positions) * out).sum(1, keepdims=True)
        positions = positions + out * np.clip(least - gap, 0, None)
    return skin.moved(positions)


def banded(mesh: Mesh, field: Array, width: float) -> Mesh:
    """Mark a hem along a border, with a line in the mesh where it ends.

    Args:
        mesh: The cloth.
        field: Metres from the border at each vertex, (N,).
        width: Of the hem, metres.

    Returns:
        The cloth; its attribute ``seam`` is 1 within a hem and ``line`` is 1 where one ends.
    """
    nothing = np.zeros((len(mesh.positions), 1))
    marked = mesh.with_attributes(
        seam=mesh.attributes.get("seam", nothing),
        line=mesh.attributes.get("line", nothing),
        field=field[:, None],
    )
    hem, cloth = halves(marked, field - width)
    whole = welded(merged([cloth, hem]))
    beyond = whole["field"] - width
    whole = whole.with_attributes(
        seam=np.maximum(whole["seam"], beyond < -1e-6),
        line=np.maximum(whole["line"], np.abs(beyond) <= 1e-6),
    )
    return whole.only(*(name for name in whole.attributes if name != "field"))


def finished(mesh: Mesh, triangles: int) -> Mesh:
    """Make cloth with hems coarse, and give its hems thickness and a tone of their own.

    Args:
        mesh: With ``weights``, ``seam`` and ``line``.
        triangles: How many to leave.

    Returns:
        The cloth with ``weights``, ``normal`` and ``colour``, which is white but for hems.
    """
    coarse = decimated(mesh, triangles, np.where(mesh["line"][:, 0] > 0.5, np.inf, 1.0))
    coarse = coarse.with_attributes(
        normal=normals(coarse.positions, coarse.triangles),
        colour=np.ones((len(coarse.positions), 4)),
    )
    whole = _rimmed(coarse)
    of_hem = (whole["seam"][whole.triangles, 0] > 0.5).any(1)
    hem = whole.kept(of_hem)
    hem = hem.moved(hem.positions + HEM_RISE * hem["normal"])
    hem = hem.with_attributes(colour=hem["colour"] * HEM_TONE)
    return merged([whole.kept(~of_hem), hem]).only("weights", "normal", "colour")


def _rimmed(mesh: Mesh) -> Mesh:
    """Turn every border inwards, so that the cloth has a visible thickness."""
    rim = borders(mesh.triangles)
    used, packed = np.unique(rim, return_inverse=True)
    packed = packed.reshape(-1, 2)
    count = len(used)
    edge = {name: np.concatenate([v[used], v[used]]) for name, v in mesh.attributes.items()}
    outside = mesh.positions[used]
    inside = outside - THICKNESS * mesh["normal"][used]
    positions = np.concatenate([outside, inside])
    a, b = packed[:, 1], packed[:, 0]
    triangles = np.concatenate([np.c_[a, b, b + count], np.c_[a, b + count, a + count]])
    strip = Mesh(positions, triangles, edge).with_attributes(
        normal=normals(positions, triangles), colour=edge["colour"] * HEM_TONE
    )
    return merged([mesh, strip])


def welded(mesh: Mesh) -> Mesh:
    """One vertex where several lie at the same place."""
    keys = np.round(mesh.positions * 1e7).astype(np.int64)
    _, first, packed = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    triangles = first[packed.reshape(-1)][mesh.triangles]
    whole = (
        (triangles[:, 0] != triangles[:, 1])
        & (triangles[:, 1] != triangles[:, 2])
        & (triangles[:, 2] != triangles[:, 0])
    )
    return mesh.compacted(triangles[whole])


def sideways(vectors: Array) -> Array:
    """The level part of vectors, unit, (N, 3)."""
    return unit(vectors * [1, 0, 1])
