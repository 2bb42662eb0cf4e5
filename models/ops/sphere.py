"""The unit sphere in torch: exp and log map, safe in values and gradients at the poles.

Vectors are flat: the last axis holds all coordinates.
"""

import torch
import torch.nn.functional as F

TINY = 1e-12
FLAT = 1e-5
"""Added to a sine at right angles, so that a point at the base has a direction."""
NEAR = 1e-4
"""Below this angle in radians the series replace the quotients, which lose all digits."""
LANES = 16


def _dot(a: torch.Tensor, b: torch.Tensor) -> torch.Tensor:
    """Inner product over the last axis, which stays with length 1.

    A product of matrices and no sum(): onnxruntime then gives a row of a batch the bits that it
    has alone. Where one of the two has no batch axis it comes first, for the same reason.
    """
    return (a.unsqueeze(-2) @ b.unsqueeze(-1)).squeeze(-1)


def _sinc(angle: torch.Tensor) -> torch.Tensor:
    """sin(angle) / angle, with its limit 1 at zero."""
    near = angle < NEAR
    safe = torch.where(near, torch.ones_like(angle), angle)
    return torch.where(near, 1.0 - angle * angle / 6.0, torch.sin(safe) / safe)


def project(vector: torch.Tensor, base: torch.Tensor) -> torch.Tensor:
    """The part of ``vector`` (..., D) that is tangent to the sphere at ``base`` (..., D)."""
    return vector - _dot(base, vector) * base


def exp(tangent: torch.Tensor, base: torch.Tensor) -> torch.Tensor:
    """The point reached from ``base`` along ``tangent``; both (..., D)."""
    angle = torch.sqrt(_dot(tangent, tangent) + TINY**2)
    # A full vector register a row: onnxruntime's sine rounds its leftovers differently, and
    # the bits of a row must not depend on where in the batch it lies.
    lanes = angle.expand(*angle.shape[:-1], LANES)
    return torch.cos(lanes)[..., :1] * base + _sinc(lanes)[..., :1] * tangent


def log(point: torch.Tensor, base: torch.Tensor, clip: float | None = None) -> torch.Tensor:
    """The tangent vector at ``base`` whose exp is ``point``; both (..., D).

    The angle comes from atan2, which keeps its digits where arccos has none left, so the
    published clipping of the cosine is not needed. Antipodal points have no unique answer
    and give zero.

    Args:
        point: Unit vectors.
        base: Unit vectors.
        clip: Take the angle from the cosine clipped to this range, as the MA-WGAN authors' code
            does with 0.98. It bounds the factor near the antipode, where the map is then wrong.
    """
    cosine = _dot(base, point)
    across = point - cosine * base
    if clip is not None:
        angle = torch.acos(cosine.clamp(-clip, clip))
        return angle / torch.sin(angle) * across
    # In units of FLAT, because the exporter takes the square of a tiny constant for zero.
    scaled = across / FLAT
    sine = FLAT * torch.sqrt(_dot(scaled, scaled) + 1.0)
    return torch.atan2(sine, cosine) / sine * across


def karcher_mean(points: torch.Tensor, steps: int = 32, tolerance: float = 1e-9) -> torch.Tensor:
    """Karcher mean of ``points`` (N, D) by gradient descent from their normalised average."""
    mean = F.normalize(points.mean(0), dim=0)
    for _ in range(steps):
        step = log(points, mean).mean(0)
        mean = F.normalize(exp(step, mean), dim=0)
        if float(step.norm()) < tolerance:
            break
    return mean
