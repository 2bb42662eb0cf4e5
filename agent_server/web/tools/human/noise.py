"""Smooth random fields that are the same each time, and other small maths of shape and colour."""

import numpy as np

from agent_server.web.tools.human.makehuman import Array, Indices


def noise(points: Array, seed: int = 0) -> Array:
    """Value noise with cells of size 1.

    Args:
        points: (..., 3).
        seed: Which of the fields.

    Returns:
        -1 to 1, (...).
    """
    cell = np.floor(points)
    share = points - cell
    share = share * share * (3 - 2 * share)
    corner = cell.astype(np.int64)
    total = np.zeros(points.shape[:-1])
    for offset in np.ndindex(2, 2, 2):
        weight = np.prod(np.where(offset, share, 1 - share), axis=-1)
        total = total + weight * _hashed(corner + np.array(offset), seed)
    return total


def crease(points: Array, seed: int = 0) -> Array:
    """Noise with narrow ridges and wide valleys, -0.4 to 1, (...)."""
    ridge: Array = np.clip(1 - 2 * np.abs(noise(points, seed)), 0, 1) ** 1.5
    return 1.4 * ridge - 0.4


def _hashed(cells: Indices, seed: int) -> Array:
    """A number from -1 to 1 for each cell of a grid."""
    keys = cells.astype(np.uint64)
    mixed = keys[..., 0] * np.uint64(0x9E3779B97F4A7C15)
    mixed ^= keys[..., 1] * np.uint64(0xC2B2AE3D27D4EB4F)
    mixed ^= keys[..., 2] * np.uint64(0x165667B19E3779F9)
    mixed ^= np.uint64(seed * 0x27D4EB2F + 0x85EBCA77)
    for shift in (29, 32):
        mixed ^= mixed >> np.uint64(shift)
        mixed *= np.uint64(0xBF58476D1CE4E5B9)
    return (mixed >> np.uint64(11)).astype(float) / 2.0**52 - 1.0


def step(low: float, high: float, values: Array) -> Array:
    """0 below ``low``, 1 above ``high`` and smooth between; the other way where low > high."""
    share = np.clip((values - low) / (high - low), 0, 1)
    return share * share * (3 - 2 * share)


def bump(squares: Array) -> Array:
    """A bell over a squared distance in units of its width."""
    return np.exp(-squares)


def linear(colour: str) -> Array:
    """A colour as written on the web, ``#rrggbb``, in linear light, (3,)."""
    srgb = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def unit(vectors: Array) -> Array:
    """Vectors of length 1, (..., 3)."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    directions: Array = vectors / np.maximum(lengths, 1e-12)
    return directions
