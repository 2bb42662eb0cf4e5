"""What affect models see of a face: points without their place, size and head pose, or shapes.

One implementation for training and for the server, batched over leading axes.
"""

import numpy as np

from agent_server.domain.arrays import Float32, Float64
from agent_server.errors import InvalidInput

SHARED_POINTS = 468
"""Points that both meshes have; the irises of the larger one are left out."""

# fmt: off
_RIGID_MESH = np.array((
    33, 133, 362, 263,  # corners of the eyes
    168, 6, 197, 195, 5, 4, 1,  # ridge of the nose
    10, 151, 9, 109, 338, 67, 297,  # forehead
    127, 356, 234, 454, 93, 323,  # temples and cheeks
    48, 278, 98, 327, 2,  # wings and base of the nose
))
# fmt: on
"""Points that an expression moves little; they tell the pose of the head."""
_RIGID_68 = np.array((36, 39, 42, 45, 27, 28, 29, 30, 31, 33, 35, 0, 16))
_SHAPES = 51
"""Blendshapes that every source has; the tongue comes last and is left out."""


def mesh_features(points: Float32) -> Float32:
    """Features of meshes.

    The head's turn is taken off by the depth that the mesh has: the axes of its rigid points
    (across the eyes, up the nose) become the axes of space.

    Args:
        points: Shape (..., N, 3) with N at least 468, in any unit, x right, y down.

    Returns:
        Shape (..., 936): x and y of the first 468 points, seen from the front.

    Raises:
        InvalidInput: If the points are no face: the eyes, or forehead and nose, lie on each other.
    """
    front, size, _ = front_view(points[..., :SHARED_POINTS, :])
    return _flat(front[..., :2] / size)


def front_view(points: Float32) -> tuple[Float64, Float64, Float64]:
    """Meshes turned to the front and centred.

    Args:
        points: Shape (..., N, 3) with N at least 468, in any unit, x right, y down.

    Returns:
        Points of the same shape; the size (..., 1, 1) of each head, the root mean square distance
        of its rigid points; and its axes (..., 3, 3), the rows, in the given space.

    Raises:
        InvalidInput: As ``mesh_features`` does.
    """
    mesh = np.asarray(points, dtype=np.float64)
    rigid = mesh[..., _RIGID_MESH, :]
    centre = rigid.mean(axis=-2, keepdims=True)
    across = mesh[..., (362, 263), :].mean(axis=-2) - mesh[..., (33, 133), :].mean(axis=-2)
    down = mesh[..., 2, :] - mesh[..., 10, :]
    axes = _frame(across, down)
    size = np.sqrt(np.square(rigid - centre).sum(axis=-1).mean(axis=-1))[..., None, None]
    return (mesh - centre) @ np.swapaxes(axes, -1, -2), size, axes


def points68_features(points: Float32) -> Float32:
    """Features of 68 points in dlib's order.

    Place, size and roll are taken off by the best similarity to a level face; the head's other
    turns cannot be without depth.

    Args:
        points: Shape (..., 68, 2), in any unit, x right, y down.

    Returns:
        Shape (..., 136).

    Raises:
        InvalidInput: If the points are no face: the eyes lie on each other.
    """
    flat = np.asarray(points, dtype=np.float64)
    rigid = flat[..., _RIGID_68, :]
    centre = rigid.mean(axis=-2, keepdims=True)
    across = flat[..., 42:48, :].mean(axis=-2) - flat[..., 36:42, :].mean(axis=-2)
    across = _unit(across)
    # Rows: along the eyes, and down.
    axes = np.stack((across, np.stack((-across[..., 1], across[..., 0]), axis=-1)), axis=-2)
    level = (flat - centre) @ np.swapaxes(axes, -1, -2)
    size = np.sqrt(np.square(rigid - centre).sum(axis=-1).mean(axis=-1))[..., None, None]
    return _flat(level / size)


def blendshape_features(values: Float32) -> Float32:
    """Features of blendshapes: the square roots of the 51 that every source has.

    Most lie near 0, where small differences mean much.

    Args:
        values: Shape (..., 52), in ARKit's order.

    Returns:
        Shape (..., 51).
    """
    return np.sqrt(np.asarray(values[..., :_SHAPES], dtype=np.float32))


def _frame(across: Float64, down: Float64) -> Float64:
    """Axes (..., 3, 3): the first along ``across``, the second near ``down``."""
    first = _unit(across)
    second = _unit(down - (down * first).sum(axis=-1, keepdims=True) * first)
    return np.stack((first, second, np.cross(first, second)), axis=-2)


def _unit(vectors: Float64) -> Float64:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    if not (lengths > 0).all():
        raise InvalidInput(
            "points has no face: its eyes, or its forehead and nose, lie on each other; "
            "send landmarks only while a face is found",
            field="points",
        )
    unit: Float64 = vectors / lengths
    return unit


def _flat(points: Float64) -> Float32:
    return points.reshape(*points.shape[:-2], -1).astype(np.float32)
