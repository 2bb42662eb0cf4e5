"""The unit sphere in n dimensions with its angle metric.

Points and tangent vectors are flat: the last axis holds their n >= 2 coordinates, all others are
batch axes that broadcast. The maps are accurate to rounding everywhere, near equal and near
antipodal points too (a norm that is off by e costs no more than e; more than 1e-6 is refused):

- Angles come from W. Kahan's 2 atan2(|p - q|, |p + q|); arccos loses half of the digits near 0
  and near pi.
- The direction from p to q is that of the tangent part of q - p in p's hemisphere and of q + p in
  the other: the differences are exact where p and q nearly cancel.
- From a point to its antipode every direction is shortest. :func:`log` then takes a fixed one, so
  that it still has the length pi and exp(log) still arrives.

(A. Srivastava and E. Klassen, "Functional and shape data analysis", Springer 2016, section 7;
B. Chopin et al., "Human motion prediction using manifold-aware Wasserstein GAN", FG 2021,
section III, uses exp and log at the Karcher mean of the training SRVFs.)
"""

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.errors import InvalidInput
from agent_server.geometry.norm import norm

_UNIT_TOLERANCE = 1e-6


def normalise(vectors: Float64) -> Float64:
    """Nearest points of the sphere.

    Args:
        vectors: Shape (..., n).

    Returns:
        Shape (..., n), of unit norm.

    Raises:
        InvalidInput: If a vector is zero: every point is as near.
    """
    norms = norm(vectors)
    if not (norms > 0.0).all():
        raise InvalidInput(
            "vectors holds a zero vector, which has no direction: leave it out",
            field="vectors",
            code="zero_vector",
        )
    # Twice, because a subnormal norm has few digits.
    scaled = vectors / norms
    return scaled / norm(scaled)


def distance(a: Float64, b: Float64) -> Float64:
    """Angle between points in radians.

    Args:
        a: Shape (..., n), of unit norm.
        b: Shape (..., n), of unit norm.

    Returns:
        Shape (...,), in [0, pi].

    Raises:
        InvalidInput: If a point is not on the sphere.
    """
    _require_unit("a", a)
    _require_unit("b", b)
    return _angle(a, b)[..., 0]


def exp(tangent: Float64, base: Float64) -> Float64:
    """The point where the geodesic from ``base`` along ``tangent`` arrives after time 1.

    Args:
        tangent: Shape (..., n), orthogonal to ``base``; its norm is the angle in radians.
        base: Shape (..., n), of unit norm.

    Returns:
        Shape (..., n), of unit norm; exactly ``base`` for a zero tangent.

    Raises:
        InvalidInput: If ``base`` is not on the sphere.
    """
    _require_unit("base", base)
    angle = norm(tangent)
    # numpy's sinc is sin(pi x) / (pi x), with its limit at zero.
    return np.cos(angle) * base + np.sinc(angle / np.pi) * tangent


def log(point: Float64, base: Float64) -> Float64:
    """The shortest tangent vector at ``base`` whose :func:`exp` is ``point``.

    Args:
        point: Shape (..., n), of unit norm.
        base: Shape (..., n), of unit norm.

    Returns:
        Shape (..., n), orthogonal to ``base``, of the distance's norm; zero for equal points. For
        antipodal points, where the direction is free, that of the coordinate axis which is
        farthest from ``base``.

    Raises:
        InvalidInput: If a point is not on the sphere.
    """
    _require_unit("point", point)
    _require_unit("base", base)
    point, base = np.broadcast_arrays(point, base)
    near = (base * point).sum(axis=-1, keepdims=True) >= 0.0
    direction = _tangent_unit(np.where(near, point - base, point + base), base)
    antipodal = ~near & ~direction.any(axis=-1, keepdims=True)
    if antipodal.any():
        axis = np.zeros_like(base)
        np.put_along_axis(axis, np.abs(base).argmin(axis=-1)[..., None], 1.0, axis=-1)
        direction = np.where(antipodal, _tangent_unit(axis, base), direction)
    return _angle(base, point) * direction


def karcher_mean(
    points: Float64, *, tolerance: float = 1e-12, max_iterations: int = 100
) -> Float64:
    """The point with the least sum of squared distances to ``points``.

    Gradient descent with step 1 from the normalised average, which converges to the only
    minimum where all points lie within a quarter turn of it (H. Karcher, "Riemannian center of
    mass and mollifier smoothing", 1977).

    Args:
        points: Shape (..., N, n), of unit norm; N is the axis that is averaged.
        tolerance: The gradient's norm in radians at which to stop.
        max_iterations: Steps after which to give up.

    Returns:
        Shape (..., n), of unit norm.

    Raises:
        InvalidInput: If a point is not on the sphere, the average of the points is zero, or the
            descent does not converge; the points then lie too far apart to have one mean.
    """
    _require_unit("points", points)
    average = points.mean(axis=-2)
    if not (norm(average) > _UNIT_TOLERANCE).all():
        raise _no_mean("their average is zero")
    mean = normalise(average)
    for _ in range(max_iterations):
        gradient = log(points, mean[..., None, :]).mean(axis=-2)
        if (norm(gradient) <= tolerance).all():
            return mean
        mean = normalise(exp(gradient, mean))
    raise _no_mean(f"no convergence to {tolerance:g} rad in {max_iterations} steps")


def _no_mean(why: str) -> InvalidInput:
    return InvalidInput(
        f"points have no single Karcher mean: {why}; give points that lie within a quarter turn "
        "of one another",
        field="points",
        code="no_mean",
    )


def _require_unit(field: str, points: Float64) -> None:
    worst = np.abs(norm(points) - 1.0).max(initial=0.0)
    if not worst <= _UNIT_TOLERANCE:
        raise InvalidInput(
            f"{field} holds a vector whose norm differs from 1 by {worst:g}: normalise it first",
            field=field,
            code="not_on_sphere",
        )


def _angle(a: Float64, b: Float64) -> Float64:
    angle: Float64 = 2.0 * np.arctan2(norm(a - b), norm(a + b))
    return angle


def _tangent_unit(vectors: Float64, base: Float64) -> Float64:
    """Direction of the part that is tangent at ``base``; zero where there is none.

    Taken twice, because rounding leaves something of ``base`` in a part that is tiny.
    """
    for _ in range(2):
        part = vectors - (vectors * base).sum(axis=-1, keepdims=True) * base
        length = norm(part)
        vectors = np.divide(part, length, out=np.zeros_like(part), where=length > 0.0)
    return vectors
