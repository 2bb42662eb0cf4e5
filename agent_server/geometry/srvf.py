"""The square-root velocity function (SRVF) of a sampled curve.

After A. Srivastava, E. Klassen, S. H. Joshi and I. H. Jermyn, "Shape analysis of elastic curves in
Euclidean spaces", IEEE TPAMI 33(7), 2011: q(t) = v(t) / sqrt(|v(t)|) for a curve with velocity v.

A curve of T + 1 points is T steps d_t, forward differences between neighbours. The sampling step
dt = 1 / T is folded into q: q_t = d_t / sqrt(|d_t|), which is sqrt(dt) times the function's value.
Sums then stand for integrals: sum |q_t|^2 is the curve's length, and scaled to length 1 the
flattened q is a point on the unit sphere of T * D coordinates
(B. Chopin, N. Otberdout, M. Daoudi and A. Bartolo, "Human motion prediction using manifold-aware
Wasserstein GAN", FG 2021, section III).

The discrete pair :func:`srvf` and :func:`inverse_srvf` is exact up to rounding. Where a curve
stands still q is exactly zero.
"""

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.errors import InvalidInput
from agent_server.geometry.norm import norm


def srvf(curve: Float64) -> Float64:
    """SRVF of a curve.

    Args:
        curve: Shape (..., T + 1, D) with T >= 1, in any unit.

    Returns:
        Shape (..., T, D), in the square root of the unit.

    Raises:
        InvalidInput: If the curve has fewer than two points.
    """
    steps = _steps(curve)
    return _divide(steps, np.sqrt(norm(steps)))


def inverse_srvf(q: Float64, start: Float64) -> Float64:
    """The curve with a given SRVF and first point.

    Args:
        q: Shape (..., T, D).
        start: Shape (..., D), the curve's first point.

    Returns:
        Shape (..., T + 1, D); its first point is ``start``.
    """
    first = np.broadcast_to(start, (*q.shape[:-2], q.shape[-1]))[..., None, :]
    steps = q * norm(q)
    return np.concatenate([first, first + np.cumsum(steps, axis=-2)], axis=-2)


def curve_length(curve: Float64) -> Float64:
    """Length of a polyline.

    Args:
        curve: Shape (..., T + 1, D) with T >= 1, in any unit.

    Returns:
        Shape (...,), in the unit.

    Raises:
        InvalidInput: If the curve has fewer than two points.
    """
    length: Float64 = norm(_steps(curve)).sum(axis=(-2, -1))
    return length


def to_sphere(curve: Float64) -> tuple[Float64, Float64]:
    """SRVF of a curve scaled to length 1, and the length that the scaling takes away.

    Args:
        curve: Shape (..., T + 1, D) with T >= 1, in any unit.

    Returns:
        q of unit norm over its last two axes, shape (..., T, D), and the curve's length in its
        unit, shape (...,). A curve that stands still has no direction: its q is zero, which
        is not on the sphere, and its length is 0.

    Raises:
        InvalidInput: If the curve has fewer than two points.
    """
    steps = _steps(curve)
    speed = norm(steps)
    length = speed.sum(axis=-2, keepdims=True)
    # Two roots, because the product of a tiny speed and a tiny length may underflow.
    return _divide(steps, np.sqrt(speed) * np.sqrt(length)), length[..., 0, 0]


def from_sphere(q: Float64, length: Float64, start: Float64) -> Float64:
    """Undo :func:`to_sphere`.

    Args:
        q: Shape (..., T, D), of unit norm over its last two axes, or zero.
        length: Shape (...,), the curve's length in its unit.
        start: Shape (..., D), the curve's first point.

    Returns:
        Shape (..., T + 1, D), in the unit of ``length``.
    """
    return inverse_srvf(q * np.sqrt(length)[..., None, None], start)


def _steps(curve: Float64) -> Float64:
    if curve.ndim < 2 or curve.shape[-2] < 2:
        raise InvalidInput(
            f"curve has shape {curve.shape}: give at least two points, shape (..., T + 1, D)",
            field="curve",
            code="too_short",
        )
    return np.diff(curve, axis=-2)


def _divide(vectors: Float64, by: Float64) -> Float64:
    """Quotient that is zero where ``by`` is zero."""
    return np.divide(vectors, by, out=np.zeros_like(vectors), where=by > 0.0)
