"""Fewer triangles for the same shape: edges are collapsed in the order of their quadric error.

An edge collapses onto one of its two vertices, so every vertex that is left is one that was
there, with its weights, morphs and texture coordinates (Garland and Heckbert 1997).
"""

import heapq

import numpy as np
from numpy.typing import NDArray

from agent_server.web.tools.human.makehuman import Array, Indices
from agent_server.web.tools.human.mesh import Mesh, borders

RIM = 30.0
"""How much more an edge of the surface counts than the surface."""


def decimated(mesh: Mesh, triangles: int, importance: Array | None = None) -> Mesh:
    """Collapse edges until few triangles are left.

    Args:
        mesh: The surface.
        triangles: How many to leave.
        importance: How dear an error is at each vertex, 1 by default, (N,). Vertices of
            infinite importance stay.
    """
    count = len(mesh.positions)
    weight = np.ones(count) if importance is None else importance
    kept = np.isinf(weight)
    collapser = _Collapser(mesh.positions, mesh.triangles, np.where(kept, 1.0, weight), kept)
    collapser.run(triangles)
    return mesh.compacted(np.array(sorted(collapser.faces.values())))


class _Collapser:
    """The state of one run."""

    def __init__(
        self, positions: Array, triangles: Indices, weight: Array, kept: NDArray[np.bool_]
    ) -> None:
        self.faces = {k: tuple(face) for k, face in enumerate(triangles.tolist())}
        self._points = positions
        self._kept = kept
        self._around: list[set[int]] = [set() for _ in positions]
        for number, face in self.faces.items():
            for vertex in face:
                self._around[vertex].add(number)
        self._rim = np.zeros(len(positions), dtype=bool)
        self._rim[borders(triangles)] = True
        self._quadrics = _quadrics(positions, triangles) * weight[:, None, None]
        self._version = [0] * len(positions)
        self._heap: list[tuple[float, int, int, int, int]] = []

    def run(self, triangles: int) -> None:
        for vertex in range(len(self._points)):
            self._queue(vertex)
        while len(self.faces) > triangles and self._heap:
            _, start, end, one, two = heapq.heappop(self._heap)
            current = self._version[start] == one and self._version[end] == two
            if current and self._may_collapse(start, end):
                self._collapse(start, end)

    def _neighbours(self, vertex: int) -> set[int]:
        found = {other for number in self._around[vertex] for other in self.faces[number]}
        found.discard(vertex)
        return found

    def _queue(self, start: int) -> None:
        """Offer to collapse this vertex onto each of its neighbours."""
        if self._kept[start] or not self._around[start]:
            return
        ends = sorted(self._neighbours(start))
        points = np.c_[self._points[ends], np.ones(len(ends))]
        quadrics = self._quadrics[start] + self._quadrics[ends]
        costs = np.einsum("ni,nij,nj->n", points, quadrics, points)
        # Short edges first where nothing is lost, so that flat places stay even.
        costs = costs + 1e-9 * ((self._points[ends] - self._points[start]) ** 2).sum(1)
        for end, cost in zip(ends, costs.tolist(), strict=True):
            entry = (cost, start, end, self._version[start], self._version[end])
            heapq.heappush(self._heap, entry)

    def _may_collapse(self, start: int, end: int) -> bool:
        shared = self._around[start] & self._around[end]
        if not shared:
            return False
        if self._rim[start] and not (self._rim[end] and len(shared) == 1):
            return False
        if len(self._neighbours(start) & self._neighbours(end)) != len(shared):
            return False
        moved = [self.faces[number] for number in self._around[start] - shared]
        if not moved:
            return False
        corners = np.array(moved)
        before = self._points[corners]
        after = self._points[np.where(corners == start, end, corners)]
        one = np.cross(before[:, 1] - before[:, 0], before[:, 2] - before[:, 0])
        two = np.cross(after[:, 1] - after[:, 0], after[:, 2] - after[:, 0])
        sizes = np.linalg.norm(one, axis=1) * np.linalg.norm(two, axis=1)
        if not bool(((one * two).sum(1) > 0.3 * sizes).all()):
            return False
        sides = after - np.roll(after, 1, axis=1)
        longest = (sides**2).sum(2).max(1)
        return bool((np.linalg.norm(two, axis=1) > 0.04 * longest).all())

    def _collapse(self, start: int, end: int) -> None:
        for number in self._around[start] & self._around[end]:
            for vertex in self.faces.pop(number):
                self._around[vertex].discard(number)
        for number in self._around[start]:
            face = self.faces[number]
            self.faces[number] = tuple(end if vertex == start else vertex for vertex in face)
            self._around[end].add(number)
        self._around[start] = set()
        self._quadrics[end] += self._quadrics[start]
        self._version[start] += 1
        self._version[end] += 1
        self._queue(end)
        for vertex in sorted(self._neighbours(end)):
            self._version[vertex] += 1
        for vertex in sorted(self._neighbours(end)):
            self._queue(vertex)


def _quadrics(positions: Array, triangles: Indices) -> Array:
    """The sum of squared distances to the planes around each vertex, (N, 4, 4)."""
    corners = positions[triangles]
    crosses = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(crosses, axis=1) + 1e-20
    quadrics = np.zeros((len(positions), 4, 4))
    faces = _plane(crosses / areas[:, None], corners[:, 0]) * areas[:, None, None]
    for k in range(3):
        np.add.at(quadrics, triangles[:, k], faces)
    rim = borders(triangles)
    if len(rim):
        # A plane that stands on the rim, upright on its triangle.
        owner = {
            frozenset(pair): k
            for k, face in enumerate(triangles.tolist())
            for pair in ((face[0], face[1]), (face[1], face[2]), (face[2], face[0]))
        }
        face_of = [owner[frozenset(pair)] for pair in rim.tolist()]
        along = positions[rim[:, 1]] - positions[rim[:, 0]]
        upright = np.cross(along, crosses[face_of] / areas[face_of, None])
        lengths = np.linalg.norm(upright, axis=1, keepdims=True) + 1e-20
        planes = _plane(upright / lengths, positions[rim[:, 0]]) * (RIM * lengths[..., None] ** 2)
        for k in range(2):
            np.add.at(quadrics, rim[:, k], planes)
    return quadrics


def _plane(normal: Array, point: Array) -> Array:
    plane = np.c_[normal, -(normal * point).sum(1)]
    product: Array = plane[:, :, None] * plane[:, None, :]
    return product
