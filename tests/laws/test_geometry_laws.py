"""Laws of curves, the sphere and skeletons, in float64."""

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from agent_server.domain.arrays import Float64
from agent_server.geometry import bones, sphere, srvf

law = settings(derandomize=True, deadline=None, max_examples=150)
seeds = st.integers(0, 2**32 - 1)


@st.composite
def moving(draw: st.DrawFn) -> Float64:
    """Shape (B, T + 1, D): curves that may stand still, from 0.1 nm to a kilometre."""
    batch, steps, width = draw(st.tuples(st.integers(1, 3), st.integers(1, 8), st.integers(1, 6)))
    element = st.one_of(st.just(0.0), st.floats(-1.0, 1.0))
    path = draw(hnp.arrays(np.float64, (batch, steps, width), elements=element))
    scale = draw(st.sampled_from([1e-10, 1e-3, 1.0, 1e3]))
    start = draw(hnp.arrays(np.float64, (batch, 1, width), elements=st.floats(-1.0, 1.0)))
    return scale * np.cumsum(np.concatenate([start, path], axis=-2), axis=-2)


def random_rotation(rng: np.random.Generator, size: int) -> Float64:
    q, r = np.linalg.qr(rng.normal(size=(size, size)))
    q *= np.sign(np.diag(r))
    if np.linalg.det(q) < 0:
        q[:, 0] *= -1
    return q


def random_points(rng: np.random.Generator, *shape: int) -> Float64:
    return sphere.normalise(rng.normal(size=shape))


def random_tangent(rng: np.random.Generator, base: Float64, angle: float) -> Float64:
    free = rng.normal(size=base.shape)
    for _ in range(2):
        free = sphere.normalise(free - (free * base).sum(-1, keepdims=True) * base)
    return angle * free


# --------------------------------------------------------------------------- SRVF


@law
@given(curve=moving())
def test_srvf_and_its_inverse(curve: Float64) -> None:
    size = np.abs(curve).max()
    q = srvf.srvf(curve)
    np.testing.assert_allclose(srvf.inverse_srvf(q, curve[:, 0]), curve, rtol=0, atol=1e-14 * size)
    np.testing.assert_allclose(
        srvf.srvf(srvf.inverse_srvf(q, np.zeros_like(curve[:, 0]))),
        q,
        rtol=0,
        atol=1e-6 * np.sqrt(size),
    )


@law
@given(curve=moving())
def test_sphere_form_and_its_inverse(curve: Float64) -> None:
    size = np.abs(curve).max()
    q, length = srvf.to_sphere(curve)
    np.testing.assert_allclose(length, srvf.curve_length(curve))
    norms = np.sqrt((q * q).sum(axis=(-2, -1)))
    np.testing.assert_allclose(norms, length > 0, atol=1e-12)
    back = srvf.from_sphere(q, length, curve[:, 0])
    np.testing.assert_allclose(back, curve, rtol=0, atol=1e-14 * size)


@law
@given(curve=moving())
def test_squared_norm_of_the_srvf_is_the_length(curve: Float64) -> None:
    q = srvf.srvf(curve)
    np.testing.assert_allclose((q * q).sum(axis=(-2, -1)), srvf.curve_length(curve), rtol=1e-12)


@law
@given(curve=moving(), seed=seeds, factor=st.floats(0.01, 100.0))
def test_srvf_forgets_place_and_follows_rotation_and_size(
    curve: Float64, seed: int, factor: float
) -> None:
    turn = random_rotation(np.random.default_rng(seed), curve.shape[-1])
    still = np.abs(curve).max() * 1e-13
    steps = np.abs(np.diff(curve, axis=-2))
    assume(((steps == 0.0) | (steps > 1e6 * still)).all())
    q, length = srvf.to_sphere(curve)
    turned, turned_length = srvf.to_sphere(factor * (curve @ turn.T))
    np.testing.assert_allclose(turned_length, factor * length, rtol=1e-6)
    np.testing.assert_allclose(turned, q @ turn.T, atol=2e-3)
    np.testing.assert_allclose(srvf.srvf(curve - curve[:, :1]), srvf.srvf(curve), atol=1e-6)


@law
@given(curve=moving())
def test_srvf_of_a_batch_equals_a_loop(curve: Float64) -> None:
    q, length = srvf.to_sphere(curve)
    for index, one in enumerate(curve):
        alone, alone_length = srvf.to_sphere(one)
        np.testing.assert_array_equal(alone, q[index])
        np.testing.assert_array_equal(alone_length, length[index])
        np.testing.assert_array_equal(srvf.srvf(one), srvf.srvf(curve)[index])


# --------------------------------------------------------------------------- sphere

# Angles from nothing at all to all but antipodal.
angles = st.one_of(
    st.floats(0.0, np.pi),
    st.floats(-16.0, 0.0).map(lambda power: 10.0**power),
    st.floats(-17.0, 0.0).map(lambda power: np.pi - 10.0**power),
    st.just(0.0),
)


@law
@given(seed=seeds, size=st.integers(2, 60), angle=angles)
def test_log_undoes_exp(seed: int, size: int, angle: float) -> None:
    rng = np.random.default_rng(seed)
    base = random_points(rng, size)
    tangent = random_tangent(rng, base, angle)
    point = sphere.exp(tangent, base)
    back = sphere.log(point, base)
    np.testing.assert_allclose(np.linalg.norm(back), sphere.distance(base, point), rtol=2e-15)
    # A rounding error of the point turns the direction the more, the nearer the antipode is.
    conditioning = angle / np.sin(angle) if angle > 1.0 else 1.0
    np.testing.assert_allclose(back, tangent, rtol=0, atol=4e-15 * conditioning)


@law
@given(seed=seeds, size=st.integers(2, 60), angle=angles)
def test_exp_undoes_log(seed: int, size: int, angle: float) -> None:
    rng = np.random.default_rng(seed)
    base = random_points(rng, size)
    point = sphere.exp(random_tangent(rng, base, angle), base)
    tangent = sphere.log(point, base)
    np.testing.assert_allclose(sphere.exp(tangent, base), point, rtol=0, atol=2e-15)
    assert abs(tangent @ base) <= 2e-15


@law
@given(seed=seeds, size=st.integers(2, 60), angle=angles)
def test_distance_is_the_length_of_the_geodesic(seed: int, size: int, angle: float) -> None:
    rng = np.random.default_rng(seed)
    base = random_points(rng, size)
    tangent = random_tangent(rng, base, angle)
    point = sphere.exp(tangent, base)
    np.testing.assert_allclose(sphere.distance(base, point), angle, rtol=0, atol=2e-15)
    assert sphere.distance(base, point) == sphere.distance(point, base)
    halfway = sphere.exp(0.5 * tangent, base)
    np.testing.assert_allclose(sphere.distance(halfway, point), angle / 2, rtol=0, atol=2e-15)


@law
@given(seed=seeds, size=st.integers(2, 60))
def test_antipodal_points_are_reached(seed: int, size: int) -> None:
    base = random_points(np.random.default_rng(seed), size)
    tangent = sphere.log(-base, base)
    assert sphere.distance(base, -base) == np.pi
    np.testing.assert_allclose(np.linalg.norm(tangent), np.pi, rtol=1e-15)
    np.testing.assert_allclose(sphere.exp(tangent, base), -base, rtol=0, atol=2e-15)
    axis = np.eye(size)[np.abs(base).argmin()]
    direction = sphere.normalise(axis - (axis @ base) * base)
    np.testing.assert_allclose(tangent, np.pi * direction, rtol=0, atol=2e-15)


@law
@given(seed=seeds, size=st.integers(2, 60), error=st.floats(-16.0, -7.0))
def test_norms_that_are_slightly_off_cost_no_more_than_they_are_off(
    seed: int, size: int, error: float
) -> None:
    base = random_points(np.random.default_rng(seed), size)
    for sign in (1.0, -1.0):
        point = sign * (1.0 + 10.0**error) * base
        tangent = sphere.log(point, base)
        assert abs(tangent @ base) <= 2e-15
        np.testing.assert_allclose(
            sphere.exp(tangent, base), point, rtol=0, atol=3 * 10.0**error + 2e-15
        )


@law
@given(seed=seeds, size=st.integers(2, 30))
def test_distance_is_a_metric_that_rotations_keep(seed: int, size: int) -> None:
    rng = np.random.default_rng(seed)
    a, b, c = random_points(rng, 3, size)
    turn = random_rotation(rng, size)
    assert sphere.distance(a, a) == 0.0
    assert sphere.distance(a, c) <= sphere.distance(a, b) + sphere.distance(b, c) + 1e-15
    np.testing.assert_allclose(
        sphere.distance(a @ turn.T, b @ turn.T), sphere.distance(a, b), rtol=0, atol=1e-14
    )
    np.testing.assert_allclose(
        sphere.log(b @ turn.T, a @ turn.T), sphere.log(b, a) @ turn.T, rtol=0, atol=1e-12
    )


@law
@given(seed=seeds, size=st.integers(2, 30))
def test_sphere_maps_of_a_batch_equal_a_loop(seed: int, size: int) -> None:
    rng = np.random.default_rng(seed)
    base, points = random_points(rng, 4, size), random_points(rng, 4, size)
    points[1], points[2] = base[1], -base[2]
    logs, distances = sphere.log(points, base), sphere.distance(base, points)
    back = sphere.exp(logs, base)
    for index in range(4):
        alone = sphere.log(points[index], base[index])
        np.testing.assert_allclose(alone, logs[index], rtol=0, atol=1e-15)
        np.testing.assert_allclose(
            sphere.distance(base[index], points[index]), distances[index], rtol=0, atol=1e-15
        )
        np.testing.assert_allclose(sphere.exp(alone, base[index]), back[index], rtol=0, atol=1e-15)


def cluster(rng: np.random.Generator, count: int, size: int, radius: float) -> Float64:
    """Points within ``radius`` of one point."""
    centre = np.broadcast_to(random_points(rng, size), (count, size))
    free = random_tangent(rng, centre, 1.0)
    return sphere.exp(radius * rng.random((count, 1)) * free, centre)


@law
@given(
    seed=seeds,
    count=st.integers(1, 8),
    size=st.integers(2, 20),
    radius=st.sampled_from([1e-9, 1e-3, 0.5, 1.2]),
)
def test_karcher_mean_is_where_the_logs_cancel_and_turns_with_the_points(
    seed: int, count: int, size: int, radius: float
) -> None:
    rng = np.random.default_rng(seed)
    points = cluster(rng, count, size, radius)
    mean = sphere.karcher_mean(points)
    np.testing.assert_allclose(sphere.log(points, mean).sum(0), 0.0, atol=1e-10)
    turn = random_rotation(rng, size)
    np.testing.assert_allclose(sphere.karcher_mean(points @ turn.T), mean @ turn.T, atol=1e-10)
    np.testing.assert_allclose(sphere.karcher_mean(points[::-1]), mean, atol=1e-10)

    def spread(candidate: Float64) -> float:
        return float((sphere.distance(points, candidate) ** 2).sum())

    for _ in range(3):
        elsewhere = sphere.exp(random_tangent(rng, mean, 0.1), mean)
        assert spread(elsewhere) > spread(mean)


@law
@given(seed=seeds, angle=st.floats(0.0, 3.0))
def test_karcher_mean_of_two_points_is_halfway(seed: int, angle: float) -> None:
    rng = np.random.default_rng(seed)
    a = random_points(rng, 12)
    tangent = random_tangent(rng, a, angle)
    mean = sphere.karcher_mean(np.stack([a, sphere.exp(tangent, a)]))
    np.testing.assert_allclose(mean, sphere.exp(0.5 * tangent, a), rtol=0, atol=1e-13)


@law
@given(seed=seeds)
def test_karcher_mean_of_a_batch_equals_a_loop(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points = np.stack([cluster(rng, 5, 8, radius) for radius in (0.01, 0.4, 1.0)])
    means = sphere.karcher_mean(points)
    for one, mean in zip(points, means, strict=True):
        np.testing.assert_allclose(sphere.karcher_mean(one), mean, rtol=0, atol=1e-11)


# --------------------------------------------------------------------------- bones

BONES = ((0, 1), (1, 2), (1, 3), (3, 4))


@law
@given(seed=seeds, factor=st.floats(0.1, 10.0))
def test_skeleton_measures_forget_how_the_body_is_turned(seed: int, factor: float) -> None:
    rng = np.random.default_rng(seed)
    pose, other = rng.normal(size=(2, 5, 3))
    turn = random_rotation(rng, 3)
    turned, mirrored = pose @ turn.T, pose * [-1, 1, 1]
    lengths = bones.bone_lengths(pose, BONES)
    np.testing.assert_allclose(bones.bone_lengths(turned + 3.0, BONES), lengths, rtol=1e-12)
    np.testing.assert_allclose(bones.bone_lengths(factor * pose, BONES), factor * lengths)
    np.testing.assert_allclose(bones.gram_matrix(turned), bones.gram_matrix(pose), atol=1e-12)
    for same in (turned, mirrored):
        np.testing.assert_allclose(bones.gram_distance(same, pose), 0.0, atol=1e-25)
        np.testing.assert_allclose(
            bones.gram_distance(same, other), bones.gram_distance(pose, other), rtol=1e-10
        )


@law
@given(seed=seeds)
def test_gram_distance_equals_its_formula(seed: int) -> None:
    a, b = np.random.default_rng(seed).normal(size=(2, 4, 9, 3))
    trace = np.einsum("bjj->b", bones.gram_matrix(a) + bones.gram_matrix(b))
    singular = np.linalg.svd(np.swapaxes(b, -1, -2) @ a, compute_uv=False).sum(-1)
    np.testing.assert_allclose(bones.gram_distance(a, b), trace - 2 * singular, rtol=1e-9)
    np.testing.assert_allclose(bones.gram_distance(a, b), bones.gram_distance(b, a), rtol=1e-9)
    # No rotation brings the poses nearer than the distance says.
    assert (bones.gram_distance(a, b) <= ((a - b) ** 2).sum((-2, -1))).all()
    for index in range(4):
        np.testing.assert_allclose(
            bones.gram_distance(a[index], b[index]), bones.gram_distance(a, b)[index], rtol=1e-12
        )
