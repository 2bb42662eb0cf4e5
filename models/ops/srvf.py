"""The square-root velocity function of a sampled curve, in torch.

A curve of T + 1 points is T steps d_t; its SRVF on the unit sphere is
q_t = d_t / sqrt(|d_t| L), with L the sum of |d_t|, so that sum |q_t|^2 = 1 and
d_t = L q_t |q_t|. The sphere forgets L and the starting point; both are kept beside it.
"""

import torch

TINY = 1e-9


def _norm(vectors: torch.Tensor, floor: float = TINY) -> torch.Tensor:
    """Norm over the last axis, which stays with length 1; never zero, so it has a gradient.

    The sum is a product of matrices, see models.ops.sphere about equal bits.
    """
    ones = torch.ones(vectors.shape[-1], 1, dtype=vectors.dtype, device=vectors.device)
    # In units of the floor, because the exporter takes the square of a tiny constant for zero.
    scaled = vectors / floor
    return floor * torch.sqrt((scaled * scaled) @ ones + 1.0)


def to_sphere(curve: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """SRVF and length of a curve.

    Args:
        curve: Shape (..., T + 1, D), in any unit of length.

    Returns:
        SRVF of unit norm, shape (..., T, D), zero for a curve that stands still; and the
        length, shape (...,), in the curve's unit.
    """
    return steps_to_sphere(curve[..., 1:, :] - curve[..., :-1, :])


def steps_to_sphere(steps: torch.Tensor, floor: float = TINY) -> tuple[torch.Tensor, torch.Tensor]:
    """SRVF and length of the curve that takes these steps.

    Args:
        steps: Shape (..., T, D), in any unit of length.
        floor: Added to each speed at right angles. It bounds the gradient where the curve
            stands still; the norm of the SRVF then falls below one.

    Returns:
        SRVF, shape (..., T, D), and the length, shape (...,).
    """
    speed = _norm(steps, floor)
    ones = torch.ones(1, steps.shape[-2], dtype=steps.dtype, device=steps.device)
    length = ones @ speed
    return steps / torch.sqrt(speed * length), length[..., 0, 0]


def from_sphere(srvf: torch.Tensor, length: torch.Tensor, start: torch.Tensor) -> torch.Tensor:
    """The curve after its starting point.

    Args:
        srvf: Shape (..., T, D), of unit norm.
        length: Shape (...,), the curve's length.
        start: Shape (..., D), the point before the first of the result.

    Returns:
        Shape (..., T, D), in the unit of ``length``.
    """
    norm = _norm(srvf)
    steps = length[..., None, None] * srvf * norm
    return start[..., None, :] + steps.cumsum(-2)
