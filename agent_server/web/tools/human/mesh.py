"""Triangle meshes whose attributes follow every cut, split and merge."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from agent_server.web.tools.human.makehuman import Array, Indices


@dataclass(frozen=True)
class Mesh:
    """A surface.

    Attributes:
        positions: (N, 3), metres.
        triangles: Anticlockwise seen from outside, (T, 3).
        attributes: Name -> (N, k). Each of them varies linearly over a triangle.
    """

    positions: Array
    triangles: Indices
    attributes: dict[str, Array]

    def __getitem__(self, name: str) -> Array:
        return self.attributes[name]

    def moved(self, positions: Array) -> "Mesh":
        """The same surface with its vertices elsewhere."""
        return replace(self, positions=positions)

    def with_attributes(self, **attributes: Array) -> "Mesh":
        """The same surface with more attributes, or others."""
        return replace(self, attributes={**self.attributes, **attributes})

    def only(self, *names: str) -> "Mesh":
        """The same surface with no other attributes than these."""
        return replace(self, attributes={name: self.attributes[name] for name in names})

    def kept(self, faces: NDArray[np.bool_]) -> "Mesh":
        """Only these triangles, and the vertices that they need."""
        return self.compacted(self.triangles[faces])

    def compacted(self, triangles: Indices) -> "Mesh":
        """Other triangles over the same vertices; vertices that none needs are dropped."""
        used, packed = np.unique(triangles, return_inverse=True)
        return Mesh(
            self.positions[used],
            packed.reshape(-1, 3),
            {name: values[used] for name, values in self.attributes.items()},
        )


def triangulated(positions: Array, quads: Indices, attributes: dict[str, Array]) -> Mesh:
    """A mesh of quads; each is split along its shorter diagonal."""
    a, b, c, d = (positions[quads[:, k]] for k in range(4))
    across = np.linalg.norm(a - c, axis=1) <= np.linalg.norm(b - d, axis=1) + 1e-9
    first = np.where(across[:, None], quads[:, [0, 1, 2]], quads[:, [0, 1, 3]])
    second = np.where(across[:, None], quads[:, [0, 2, 3]], quads[:, [1, 2, 3]])
    triangles = np.stack([first, second], axis=1).reshape(-1, 3)
    return Mesh(positions, triangles, attributes).compacted(triangles)


def merged(meshes: Iterable[Mesh]) -> Mesh:
    """Several surfaces as one; they share the attributes of the first."""
    parts = list(meshes)
    starts = np.cumsum([0, *(len(part.positions) for part in parts)])
    return Mesh(
        np.concatenate([part.positions for part in parts]),
        np.concatenate(
            [part.triangles + start for part, start in zip(parts, starts, strict=False)]
        ),
        {name: np.concatenate([part[name] for part in parts]) for name in parts[0].attributes},
    )


def normals(positions: Array, triangles: Indices) -> Array:
    """Normals of the vertices, weighted by the angles of their triangles, unit, (N, 3)."""
    sums = np.zeros_like(positions)
    corners = positions[triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    faces /= np.linalg.norm(faces, axis=1, keepdims=True) + 1e-20
    for k in range(3):
        one = corners[:, (k + 1) % 3] - corners[:, k]
        two = corners[:, (k + 2) % 3] - corners[:, k]
        lengths = np.linalg.norm(one, axis=1) * np.linalg.norm(two, axis=1) + 1e-20
        angles = np.arccos(np.clip((one * two).sum(1) / lengths, -1, 1))
        np.add.at(sums, triangles[:, k], faces * angles[:, None])
    lengths = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.where(lengths > 1e-12, sums / np.maximum(lengths, 1e-12), [0.0, 1.0, 0.0])


def edges(triangles: Indices) -> Indices:
    """Every edge once, the smaller vertex first, (E, 2)."""
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return np.unique(np.sort(sides, axis=1), axis=0)


def borders(triangles: Indices) -> Indices:
    """The edges with a triangle on one side only, as those triangles run, (E, 2)."""
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, found, counts = np.unique(
        np.sort(sides, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    single: Indices = sides[counts[found.reshape(-1)] == 1]
    return single


def smoothed(values: Array, triangles: Indices, rounds: int, strength: Array | float) -> Array:
    """Values moved towards the mean of their neighbours, on a border along the border.

    Args:
        values: (N, k).
        triangles: (T, 3).
        rounds: How often.
        strength: 0 to 1, the share of the way in one round, or one for each vertex, (N, 1).
    """
    pairs = edges(triangles)
    rim = borders(triangles)
    on_rim = np.zeros(len(values), dtype=bool)
    on_rim[rim] = True
    pairs = np.concatenate([pairs, pairs[:, ::-1]])
    pairs = np.concatenate([pairs[~on_rim[pairs[:, 0]]], rim, rim[:, ::-1]])
    counts = np.maximum(np.bincount(pairs[:, 0], minlength=len(values)), 1)[:, None]
    for _ in range(rounds):
        sums = np.zeros_like(values)
        np.add.at(sums, pairs[:, 0], values[pairs[:, 1]])
        values = values + strength * (sums / counts - values)
    return values


def halves(mesh: Mesh, field: Array) -> tuple[Mesh, Mesh]:
    """Cut a surface where a field is zero.

    Args:
        mesh: The surface.
        field: A value for each vertex, (N,).

    Returns:
        The part where the field is negative, and the part where it is positive. Both have
        the same new vertices along the cut.
    """
    field = np.where(np.abs(field) < 1e-7, 1e-7, field)
    pairs = edges(mesh.triangles)
    cut = pairs[(field[pairs[:, 0]] < 0) != (field[pairs[:, 1]] < 0)]
    share = (field[cut[:, 0]] / (field[cut[:, 0]] - field[cut[:, 1]]))[:, None]

    def extended(values: Array) -> Array:
        between = values[cut[:, 0]] * (1 - share) + values[cut[:, 1]] * share
        return np.concatenate([values, between])

    count = len(mesh.positions)
    new = {(int(a), int(b)): count + k for k, (a, b) in enumerate(cut)}
    sides: tuple[list[list[int]], list[list[int]]] = ([], [])
    below = field < 0
    for triangle in mesh.triangles.tolist():
        polygons: tuple[list[int], list[int]] = ([], [])
        for a, b in zip(triangle, triangle[1:] + triangle[:1], strict=True):
            polygons[0 if below[a] else 1].append(a)
            if below[a] != below[b]:
                vertex = new[min(a, b), max(a, b)]
                polygons[0].append(vertex)
                polygons[1].append(vertex)
        for side, polygon in zip(sides, polygons, strict=True):
            side.extend(
                [polygon[0], polygon[k], polygon[k + 1]] for k in range(1, len(polygon) - 1)
            )
    whole = Mesh(
        extended(mesh.positions),
        mesh.triangles,
        {name: extended(values) for name, values in mesh.attributes.items()},
    )
    low, high = (whole.compacted(np.array(side, dtype=int).reshape(-1, 3)) for side in sides)
    return low, high


def cut(mesh: Mesh, field: Array) -> Mesh:
    """The part of a surface where a field is positive."""
    return halves(mesh, field)[1]


def subdivided(values: Array, quads: Indices) -> tuple[Array, Indices]:
    """One round of Catmull-Clark.

    Args:
        values: What to interpolate at each vertex, (N, k).
        quads: (Q, 4).

    Returns:
        The values at the new vertices, and the new quads, (4 Q, 4).
    """
    count = len(values)
    sides = np.stack([quads, np.roll(quads, -1, axis=1)], axis=2)  # (Q, 4, 2)
    pairs, side, shared = np.unique(
        np.sort(sides.reshape(-1, 2), axis=1), axis=0, return_inverse=True, return_counts=True
    )
    side = side.reshape(quads.shape)
    centres = values[quads].mean(1)
    around = np.zeros((len(pairs), values.shape[1]))
    for k in range(4):
        np.add.at(around, side[:, k], centres)
    middles = values[pairs].mean(1)
    inner = (shared == 2)[:, None]
    on_edges = np.where(inner, (2 * middles + around) / 4, middles)

    def mean_at_vertices(vertices: Indices, parts: Array) -> tuple[Array, Indices]:
        sums = np.zeros_like(values)
        np.add.at(sums, vertices, parts)
        counts = np.bincount(vertices, minlength=count)[:, None]
        return sums / np.maximum(counts, 1), counts

    face_mean, valence = mean_at_vertices(quads.reshape(-1), np.repeat(centres, 4, axis=0))
    edge_mean, _ = mean_at_vertices(pairs.reshape(-1), np.repeat(middles, 2, axis=0))
    rim = pairs[shared == 1]
    rim_mean, on_rim = mean_at_vertices(rim.reshape(-1), np.repeat(values[rim].mean(1), 2, axis=0))
    valence = np.maximum(valence, 3)
    smooth = (face_mean + 2 * edge_mean + (valence - 3) * values) / valence
    corners = np.where(on_rim > 0, (values + rim_mean) / 2, smooth)
    middle = count + side
    centre = np.repeat(count + len(pairs) + np.arange(len(quads))[:, None], 4, axis=1)
    quartered = np.stack([quads, middle, centre, np.roll(middle, 1, axis=1)], axis=2)
    return np.concatenate([corners, on_edges, centres]), quartered.reshape(-1, 4)
