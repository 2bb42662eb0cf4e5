"""The orthonormal discrete cosine transform as a matrix."""

import math

import torch


def dct_matrix(frames: int) -> torch.Tensor:
    """DCT-II of ``frames`` samples, shape (frames, frames); its transpose is its inverse."""
    time = torch.arange(frames, dtype=torch.float64) + 0.5
    order = torch.arange(frames, dtype=torch.float64)[:, None]
    matrix = torch.cos(math.pi / frames * order * time) * math.sqrt(2.0 / frames)
    matrix[0] /= math.sqrt(2.0)
    return matrix.float()
