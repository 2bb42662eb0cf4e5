from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.errors import ConfigError  # noqa: E402
from models.data.windows import Recording, WindowSet, cut  # noqa: E402
from models.ma_wgan.config import NetworkConfig, TrainConfig  # noqa: E402
from models.ma_wgan.network import Critic, Generator, log_liveliness  # noqa: E402
from models.ma_wgan.train import (  # noqa: E402
    Trainer,
    load_predictor,
    make_target,
    position_error,
    reference_point,
    stand_still_error,
    train,
)
from models.ops.losses import gradient_penalty  # noqa: E402
from models.training.run import Run  # noqa: E402

SMALL = NetworkConfig(channels=32, blocks=2, critic_channels=16)
CPU = torch.device("cpu")


def waving(count: int = 6, frames: int = 100) -> WindowSet:
    """Bodies whose hands swing at various speeds."""
    rng = np.random.default_rng(0)
    pose = np.array(
        [[0, 0.5, 0], [0, 0.3, 0], [0, 0, 0], [-0.2, 0.25, 0], [-0.25, 0, 0], [-0.25, -0.2, 0],
         [0.2, 0.25, 0], [0.25, 0, 0], [0.25, -0.2, 0]]
    )  # fmt: skip
    takes = []
    for _ in range(count):
        time = np.arange(frames)[:, None] / 25
        swing = 0.2 * np.sin(2 * np.pi * rng.uniform(0.3, 1) * time + rng.uniform(0, 6, 3))
        motion = np.repeat(pose[None], frames, axis=0)
        motion[:, 8] += swing
        motion[:, 5] -= 0.5 * swing
        motion = (motion + np.array([0.0, 0.0, 2.0])).astype(np.float32)
        takes.append(Recording(motion, motion, None, 0, 0, "v00"))
    return cut(takes)


def random_generator(config: NetworkConfig = SMALL) -> Generator:
    torch.manual_seed(0)
    reference = torch.randn(config.future * config.joints * 3)
    return Generator(config, reference / reference.norm()).eval()


def test_shapes_from_seen_to_future() -> None:
    seen = torch.randn(3, 25, 9, 3) * 0.3
    assert random_generator()(seen).shape == (3, 50, 9, 3)
    assert Critic(SMALL)(torch.randn(3, 1350)).shape == (3,)


def test_tangent_vectors_are_tangent_and_points_lie_on_the_sphere() -> None:
    network = random_generator()
    tangent, _ = network.tangent_and_length(torch.randn(4, 25, 27))
    assert float((tangent @ network.reference).detach().abs().max()) < 1e-5


def test_the_future_starts_at_the_last_seen_pose() -> None:
    network = random_generator()
    tangent, log_length = network.tangent_and_length(torch.randn(2, 25, 27))
    start = torch.randn(2, 27)
    still = network.decode(tangent, torch.full_like(log_length, -20.0), start)
    torch.testing.assert_close(still, start[:, None].expand_as(still), atol=1e-6, rtol=0)


def test_turning_the_body_turns_the_future() -> None:
    network = random_generator()
    seen = waving().frames(torch.arange(4))[0][:, :25]
    angle = torch.tensor(0.6)
    turn = torch.tensor([[angle.cos(), 0, -angle.sin()], [0, 1, 0], [angle.sin(), 0, angle.cos()]])
    # The tiny fallback along x keeps this from being exact.
    torch.testing.assert_close(network(seen @ turn), network(seen) @ turn, atol=2e-3, rtol=0)


def test_degenerate_bodies_give_finite_futures_and_gradients() -> None:
    network = random_generator()
    seen = torch.zeros(2, 25, 9, 3, requires_grad=True)
    future = network(seen)
    future.sum().backward()
    assert torch.isfinite(future).all()
    assert seen.grad is not None
    assert torch.isfinite(seen.grad).all()


def test_a_frozen_stream_stays_and_a_trembling_one_is_left_alone() -> None:
    network = random_generator()
    pose = waving().frames(torch.arange(4))[0][:, :1]
    frozen = pose.expand(-1, 25, -1, -1)
    torch.testing.assert_close(network(frozen), pose.expand(-1, 50, -1, -1), atol=1e-4, rtol=0)
    trembling = frozen + 3e-4 * torch.randn(
        frozen.shape, generator=torch.Generator().manual_seed(0)
    )
    shares = torch.exp(log_liveliness(trembling.flatten(2)))
    assert float(shares.min()) > 0.99


def test_the_target_decodes_to_the_true_future() -> None:
    windows = waving()
    reference = reference_point(windows, torch.Generator().manual_seed(0))
    assert float(reference.norm()) == pytest.approx(1.0, abs=1e-5)
    target = make_target(*windows.frames(torch.arange(8)), reference)
    network = Generator(SMALL, reference)
    future = network.decode(
        target.tangent, torch.log(torch.exp(target.log_length) - 1e-2), target.seen[:, -1]
    )
    torch.testing.assert_close(future, target.future, atol=2e-4, rtol=0)


def test_gradient_penalty_is_zero_for_slope_one() -> None:
    direction = torch.nn.functional.normalize(torch.ones(20), dim=0)
    generator = torch.Generator().manual_seed(0)
    a, b = torch.randn(2, 5, 20)
    assert float(gradient_penalty(lambda x: x @ direction, a, b, generator)) < 1e-8
    steep = gradient_penalty(lambda x: 3 * x @ direction, a, b, generator)
    assert float(steep) == pytest.approx(4.0, rel=1e-4)


def test_a_few_windows_are_learnt_by_heart() -> None:
    windows = waving()
    generator = torch.Generator().manual_seed(0)
    reference = reference_point(windows, generator)
    torch.manual_seed(0)
    config = TrainConfig(network=SMALL, steps=150, learning_rate=3e-3, ema=0.9)
    trainer = Trainer(config, reference, CPU)
    target = make_target(*windows.frames(torch.arange(0, len(windows), 10)), reference)
    first = trainer.step(target, generator)
    for _ in range(149):
        last = trainer.step(target, generator)
    assert last["position"] < 0.4 * first["position"]
    assert last["reconstruction"] < 0.7 * first["reconstruction"]


def test_a_resumed_run_ends_where_an_unbroken_one_does(tmp_path: Path) -> None:
    windows = waving()
    config = TrainConfig(network=SMALL, steps=6, batch=8, validate_every=3)

    def go(folder: Path, seed: int = 1, *, resume: bool = False) -> None:
        run = Run(folder, config, seed, "train", resume)
        train(config, run, [(1.0, windows)], {"waving": windows})

    go(tmp_path / "whole")
    go(tmp_path / "again")
    go(tmp_path / "other", seed=2)
    interrupted = Run(tmp_path / "broken", config, 1, "train", resume=False)

    class Stopped(Exception):
        pass

    def stop(row: dict[str, float]) -> None:
        if row["step"] == 6:
            raise Stopped

    interrupted.log = stop  # type: ignore[method-assign]
    with pytest.raises(Stopped):
        train(config, interrupted, [(1.0, windows)], {"waving": windows})
    go(tmp_path / "broken", resume=True)

    def weights(name: str) -> torch.Tensor:
        state = torch.load(tmp_path / name / "last.pt", weights_only=True)
        return torch.cat([w.flatten() for w in state["network"].values()])

    assert torch.equal(weights("whole"), weights("again"))
    assert torch.equal(weights("whole"), weights("broken"))
    assert not torch.equal(weights("whole"), weights("other"))
    with pytest.raises(ConfigError, match="--resume"):
        go(tmp_path / "whole")
    with pytest.raises(ConfigError, match="another configuration"):
        Run(tmp_path / "whole", replace(config, steps=7), 1, "train", resume=True)

    network = load_predictor(tmp_path / "whole")
    assert position_error(network, windows, CPU) > 0
    assert stand_still_error(windows) > 0


def test_contradictions_are_refused() -> None:
    with pytest.raises(ConfigError, match="coefficients is 60"):
        NetworkConfig(coefficients=60)
