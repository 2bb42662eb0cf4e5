"""Turning a body about the vertical, so that a network sees it from the front."""

import torch

from agent_server.domain.skeleton import CoreJoint

FALLBACK_M = 1e-3
"""Added along x, so that shoulders that coincide leave the axes as they are."""


def heading(motion: torch.Tensor) -> torch.Tensor:
    """Direction of the shoulder line, left to right, averaged over the frames.

    Args:
        motion: Shape (B, T, 9, 3), metres.

    Returns:
        Shape (B, 2): its x and z part, of unit norm. (1, 0) faces the sensor.
    """
    line = motion[:, :, CoreJoint.RIGHT_SHOULDER] - motion[:, :, CoreJoint.LEFT_SHOULDER]
    # A product from the left instead of mean(): onnxruntime then gives a row of a batch the
    # bits that it has alone, which its reductions do not.
    average = (
        torch.full((1, line.shape[1]), 1.0 / line.shape[1], dtype=line.dtype, device=line.device)
        @ line
    )
    x = average[:, 0, 0:1] + FALLBACK_M
    z = average[:, 0, 2:3]
    return torch.cat([x, z], dim=1) / torch.sqrt(x * x + z * z + 1e-12)


def to_front(motion: torch.Tensor, direction: torch.Tensor) -> torch.Tensor:
    """Turn (B, T, 9, 3) so that ``direction`` (B, 2) becomes (1, 0)."""
    return _turn(motion, direction[:, 0, None, None], direction[:, 1, None, None])


def from_front(motion: torch.Tensor, direction: torch.Tensor) -> torch.Tensor:
    """Undo :func:`to_front`."""
    return _turn(motion, direction[:, 0, None, None], -direction[:, 1, None, None])


def _turn(motion: torch.Tensor, cosine: torch.Tensor, sine: torch.Tensor) -> torch.Tensor:
    x, y, z = motion[..., 0], motion[..., 1], motion[..., 2]
    return torch.stack([cosine * x + sine * z, y, cosine * z - sine * x], dim=-1)
