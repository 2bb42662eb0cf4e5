"""How much of the sky each vertex sees: soft shadows in folds, sockets and under the chin."""

import numpy as np

from agent_server.web.tools.human.makehuman import Array
from agent_server.web.tools.human.mesh import Mesh
from agent_server.web.tools.human.noise import unit

DIRECTIONS = 128
SKYWARDS = 0.5
"""How much more light comes from above than from below."""


def openness(points: Array, normals: Array, around: Mesh, cell: float) -> Array:
    """The share of the light around that reaches points on a surface.

    Depth is drawn from many directions onto a grid, as a shadow map does it.

    Args:
        points: (N, 3), metres.
        normals: (N, 3).
        around: What stands in the light.
        cell: The grid's cell, metres. What is closer than two cells casts no shadow.

    Returns:
        0 to 1, (N,).
    """
    samples = _scattered(around, cell * 0.8)
    seen = np.zeros(len(points))
    total = np.zeros(len(points))
    for direction in _sphere(DIRECTIONS):
        light = np.clip(normals @ direction, 0, None) * (1 + SKYWARDS * direction[1])
        side = unit(np.cross(direction, [0.3, 0.2, 0.9]))
        plane = np.stack([side, np.cross(direction, side)], axis=1)
        flat = np.concatenate([samples, points]) @ plane / cell
        low = flat.min(0) - 1
        cells = np.floor(flat - low).astype(np.int64)
        width = int(cells[:, 1].max()) + 2
        number = cells[:, 0] * width + cells[:, 1]
        depth = np.full((int(cells[:, 0].max()) + 2) * width, -np.inf)
        np.maximum.at(depth, number[: len(samples)], samples @ direction)
        free = points @ direction > depth[number[len(samples) :]] - 2 * cell
        seen += light * free
        total += light
    return seen / np.maximum(total, 1e-9)


def _sphere(count: int) -> Array:
    """Directions spread evenly, (count, 3)."""
    k = np.arange(count) + 0.5
    height = 1 - 2 * k / count
    turn = k * np.pi * (1 + 5**0.5)
    radius = np.sqrt(1 - height**2)
    return np.stack([radius * np.cos(turn), height, radius * np.sin(turn)], axis=1)


def _scattered(mesh: Mesh, distance: float) -> Array:
    """Points on a surface, about this far apart, (S, 3)."""
    corners = mesh.positions[mesh.triangles]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    counts = np.maximum(np.ceil(areas / distance**2), 1).astype(int)
    owner = np.repeat(np.arange(len(corners)), counts)
    number = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
    one = (number + 0.5) / counts[owner]
    two = (0.5 + number * 0.6180339887) % 1
    root = np.sqrt(one)[:, None]
    two = two[:, None]
    a, b, c = (corners[owner, k] for k in range(3))
    points: Array = (1 - root) * a + root * (1 - two) * b + root * two * c
    return points
