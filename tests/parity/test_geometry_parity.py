"""The torch operators give what the numpy reference gives."""

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.domain.skeleton import CORE_BONES  # noqa: E402
from agent_server.geometry import bones as reference_bones  # noqa: E402
from agent_server.geometry import sphere as reference_sphere  # noqa: E402
from agent_server.geometry import srvf as reference_srvf  # noqa: E402
from models.ops import losses, sphere, srvf  # noqa: E402

LIMIT = 1e-6


def curves(count: int = 20) -> np.ndarray:
    """Smooth curves (count, 51, 27), one of which stands still for a while."""
    rng = np.random.default_rng(3)
    steps = rng.standard_normal((count, 51, 27)).cumsum(axis=1).cumsum(axis=1) * 1e-3
    steps[0, 10:30] = steps[0, 10]
    return steps


def points(count: int = 50, size: int = 40) -> np.ndarray:
    vectors = np.random.default_rng(4).standard_normal((count, size))
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def test_srvf_and_length_agree() -> None:
    curve = curves()
    expected, length = reference_srvf.to_sphere(curve)
    got, got_length = srvf.to_sphere(torch.from_numpy(curve))
    np.testing.assert_allclose(got.numpy(), expected, atol=LIMIT)
    np.testing.assert_allclose(got_length.numpy(), length, atol=LIMIT)


def test_integration_agrees_and_undoes_the_srvf() -> None:
    curve = curves()
    q, length = reference_srvf.to_sphere(curve)
    expected = reference_srvf.from_sphere(q, length, curve[:, 0])[:, 1:]
    got = srvf.from_sphere(*(torch.from_numpy(x) for x in (q, length, curve[:, 0])))
    np.testing.assert_allclose(got.numpy(), expected, atol=LIMIT)
    np.testing.assert_allclose(got.numpy(), curve[:, 1:], atol=LIMIT)


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-5, 1e-3, 0.5, 3.0])
def test_exp_and_log_agree(angle: float) -> None:
    base = points()
    along = points()[::-1].copy()
    along -= (along * base).sum(-1, keepdims=True) * base
    tangent = angle * along / np.linalg.norm(along, axis=-1, keepdims=True)
    expected = reference_sphere.exp(tangent, base)
    got = sphere.exp(torch.from_numpy(tangent), torch.from_numpy(base))
    np.testing.assert_allclose(got.numpy(), expected, atol=LIMIT)
    back = sphere.log(torch.from_numpy(expected), torch.from_numpy(base))
    np.testing.assert_allclose(back.numpy(), reference_sphere.log(expected, base), atol=LIMIT)


def test_karcher_mean_agrees() -> None:
    cloud = points(30)
    cloud[:, 0] += 1.0
    cloud /= np.linalg.norm(cloud, axis=-1, keepdims=True)
    got = sphere.karcher_mean(torch.from_numpy(cloud))
    np.testing.assert_allclose(got.numpy(), reference_sphere.karcher_mean(cloud), atol=LIMIT)


def test_gram_distance_and_bones_agree() -> None:
    rng = np.random.default_rng(5)
    a, b = rng.standard_normal((2, 30, 9, 3))
    got = losses.gram_distance(torch.from_numpy(a), torch.from_numpy(b))
    np.testing.assert_allclose(got.numpy(), reference_bones.gram_distance(a, b), atol=LIMIT)
    lengths = losses.bone_lengths(torch.from_numpy(a), CORE_BONES)
    np.testing.assert_allclose(
        lengths.numpy(), reference_bones.bone_lengths(a, CORE_BONES), atol=LIMIT
    )
