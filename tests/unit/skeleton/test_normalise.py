import numpy as np
import pytest

from agent_server.domain.skeleton import CoreJoint
from agent_server.skeleton.normalise import denormalise, normalise


@pytest.mark.parametrize("shape", [(25, 9, 3), (75, 9, 3), (4, 75, 9, 3), (2, 3, 25, 9, 3)])
def test_the_navel_of_the_last_seen_frame_becomes_the_origin(shape: tuple[int, ...]) -> None:
    positions = np.random.default_rng(0).normal(size=shape).astype(np.float32)
    moved, origin = normalise(positions)
    assert moved.dtype == origin.dtype == np.float32
    assert origin.shape == (*shape[:-3], 3)
    np.testing.assert_array_equal(moved[..., 24, CoreJoint.NAVEL, :], 0.0)
    # The axes stay as they are: differences within the motion do not change.
    np.testing.assert_allclose(np.diff(moved, axis=-2), np.diff(positions, axis=-2), atol=1e-6)
    np.testing.assert_allclose(denormalise(moved, origin), positions, atol=1e-6)


def test_a_forecast_is_brought_back_with_its_window() -> None:
    motion = np.random.default_rng(1).normal(size=(3, 75, 9, 3)).astype(np.float32)
    moved, _ = normalise(motion)
    _, origin = normalise(motion[:, :25])
    np.testing.assert_allclose(denormalise(moved[:, 25:], origin), motion[:, 25:], atol=1e-6)
