"""Lengths of vectors at any scale."""

import numpy as np

from agent_server.domain.arrays import Float64


def norm(vectors: Float64) -> Float64:
    """Euclidean length over the last axis, which stays with length 1.

    Scaled by the largest coordinate, so that no square underflows or overflows: two points
    1e-200 apart are not equal.

    Args:
        vectors: Shape (..., n) with n >= 1.

    Returns:
        Shape (..., 1).
    """
    largest = np.abs(vectors).max(axis=-1, keepdims=True)
    scaled = vectors / np.where(largest > 0.0, largest, 1.0)
    length: Float64 = largest * np.sqrt((scaled * scaled).sum(axis=-1, keepdims=True))
    return length
