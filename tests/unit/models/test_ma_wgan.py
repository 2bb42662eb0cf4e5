from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.errors import ConfigError  # noqa: E402
from models.data.layouts import CMU, CORE, H36M, Layout  # noqa: E402
from models.data.windows import Recording, WindowSet, cut  # noqa: E402
from models.ma_wgan.config import CONFIGS, NetworkConfig, TrainConfig  # noqa: E402
from models.ma_wgan.critic import make_critic  # noqa: E402
from models.ma_wgan.network import Flipped, Predictor, carry_on, log_liveliness  # noqa: E402
from models.ma_wgan.representation import Spheres, karcher_means  # noqa: E402
from models.ma_wgan.train import (  # noqa: E402
    PredictorLearner,
    load_predictor,
    load_trained,
    make_target,
    reference_point,
    train_on,
)
from models.ops.losses import gradient_penalty, near_weights  # noqa: E402
from models.ops.sphere import log as sphere_log  # noqa: E402
from models.training.errors import position_error, stand_still_error  # noqa: E402
from models.training.run import Run  # noqa: E402
from models.training.source import SensorSource, Windows, whole  # noqa: E402

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
        takes.append(Recording(motion, motion, None, "v00"))
    return cut(takes)


def source() -> SensorSource:
    windows = waving()
    return SensorSource(windows, windows, {"waving": whole(windows)})


def random_predictor(config: NetworkConfig = SMALL) -> Predictor:
    torch.manual_seed(0)
    size = config.future * 3
    shape = (1, size * config.joints) if config.spheres == "body" else (config.joints, size)
    reference = torch.nn.functional.normalize(torch.randn(shape), dim=1)
    network = Predictor(config, reference)
    for name, parameter in network.named_parameters():
        if "out" in name or "length" in name:
            torch.nn.init.normal_(parameter, std=0.02)
    return network.eval()


FAMILIES = [
    SMALL,
    replace(SMALL, output="curve"),
    replace(SMALL, spheres="body"),
    replace(SMALL, spheres="body", length=False),
    replace(SMALL, noise=4),
    replace(SMALL, family="convolutions", spheres="body", length=False, channels=16),
    replace(SMALL, seen=10, future=25),
]


@pytest.mark.parametrize("config", FAMILIES)
def test_every_family_gives_finite_futures_that_the_critic_scores(config: NetworkConfig) -> None:
    network = random_predictor(config)
    seen = waving().frames(torch.arange(3))[0][:, : config.seen]
    future = network(seen)
    assert future.shape == (3, config.future, 9, 3)
    assert torch.isfinite(future).all()
    point, poses = network.forecast(seen.flatten(2))
    score = make_critic(config)(point.tangent, poses - seen.flatten(2)[:, -1:])
    assert score.shape == (3,)
    # What lies on the spheres and what comes out are one and the same motion.
    decoded = network.spheres.decode(point.tangent, point.log_length, seen.flatten(2)[:, -1])
    torch.testing.assert_close(decoded, poses, atol=2e-2, rtol=0)


def test_tangent_vectors_are_tangent() -> None:
    network = random_predictor()
    point, _ = network.forecast(waving().frames(torch.arange(4))[0][:, :25].flatten(2))
    across = (point.tangent * network.spheres.reference).sum(-1)
    assert float(across.detach().abs().max()) < 1e-5


@pytest.mark.parametrize("kind", ["body", "joints"])
def test_a_motion_survives_the_way_to_the_spheres_and_back(kind: str) -> None:
    target = make_target(whole(waving()), front=True)
    poses = target.curve()
    reference = karcher_means(poses, kind)
    torch.testing.assert_close(reference.norm(dim=1), torch.ones(len(reference)))
    spheres = Spheres(reference, 50, kind)
    point = spheres.encode(poses)
    exact = torch.log((point.log_length.exp() - 1e-3).clamp(min=1e-9))
    back = spheres.decode(point.tangent, exact, poses[:, 0])
    torch.testing.assert_close(back, poses[:, 1:], atol=5e-4, rtol=0)


def test_the_published_clipping_changes_only_what_is_far_away() -> None:
    target = make_target(whole(waving()), front=True)
    reference = karcher_means(target.curve(), "body")
    exact = Spheres(reference, 50, "body").encode(target.curve()).tangent
    clipped = Spheres(reference, 50, "body", log_clip=0.98).encode(target.curve()).tangent
    angle = exact.norm(dim=-1)
    near = angle < torch.arccos(torch.tensor(-0.98))
    torch.testing.assert_close(clipped[near], exact[near], rtol=0.01, atol=1e-4)
    opposite = -reference[None] + 1e-3 * torch.randn(reference.shape)
    assert (
        make_log(opposite, reference, None).norm() > 2 * make_log(opposite, reference, 0.98).norm()
    )


def make_log(point: torch.Tensor, base: torch.Tensor, clip: float | None) -> torch.Tensor:
    return sphere_log(torch.nn.functional.normalize(point, dim=-1), base, clip)


def test_turning_the_body_turns_the_future() -> None:
    network = random_predictor()
    seen = waving().frames(torch.arange(4))[0][:, :25]
    angle = torch.tensor(0.6)
    turn = torch.tensor([[angle.cos(), 0, -angle.sin()], [0, 1, 0], [angle.sin(), 0, angle.cos()]])
    # The tiny fallback along x keeps this from being exact.
    torch.testing.assert_close(network(seen @ turn), network(seen) @ turn, atol=2e-3, rtol=0)


@pytest.mark.parametrize("output", ["tangent", "curve"])
def test_degenerate_bodies_give_finite_futures_and_gradients(output: str) -> None:
    network = random_predictor(replace(SMALL, output=output))
    seen = torch.zeros(2, 25, 9, 3, requires_grad=True)
    point, poses = network.forecast(seen.flatten(2))
    (poses.sum() + point.tangent.sum() + point.log_length.sum()).backward()
    assert torch.isfinite(poses).all()
    assert seen.grad is not None
    assert torch.isfinite(seen.grad).all()


def test_a_frozen_stream_stays_and_a_trembling_one_is_left_alone() -> None:
    network = random_predictor()
    pose = waving().frames(torch.arange(4))[0][:, :1]
    frozen = pose.expand(-1, 25, -1, -1)
    torch.testing.assert_close(network(frozen), pose.expand(-1, 50, -1, -1), atol=1e-4, rtol=0)
    trembling = frozen + 3e-4 * torch.randn(
        frozen.shape, generator=torch.Generator().manual_seed(0)
    )
    shares = torch.exp(log_liveliness(trembling.flatten(2)))
    assert float(shares.min()) > 0.99


def test_noise_gives_several_futures_and_none_gives_one() -> None:
    network = random_predictor(replace(SMALL, noise=4))
    seen = waving().frames(torch.arange(2))[0][:, :25]
    generator = torch.Generator().manual_seed(0)
    futures = network.futures(seen, 3, generator)
    assert futures.shape == (2, 3, 50, 9, 3)
    assert float((futures[:, 0] - futures[:, 1]).detach().abs().max()) > 1e-4
    torch.testing.assert_close(network(seen), network(seen))


def test_a_long_future_goes_on_from_its_own_end() -> None:
    network = random_predictor()
    seen = waving().frames(torch.arange(2))[0][:, :25]
    long = carry_on(network, seen, 100)
    assert long.shape == (2, 100, 9, 3)
    torch.testing.assert_close(long[:, :50], network(seen))
    torch.testing.assert_close(long[:, 50:], network(network(seen)[:, -25:]))


def test_a_mirrored_body_has_the_mirrored_future() -> None:
    network = Flipped(random_predictor(replace(SMALL, front=False)), CORE.mirror).eval()
    seen = waving().frames(torch.arange(2))[0][:, :25]
    sign = torch.tensor([-1.0, 1.0, 1.0])
    mirror = list(CORE.mirror)
    torch.testing.assert_close(
        network(seen[:, :, mirror] * sign), network(seen)[:, :, mirror] * sign
    )


@pytest.mark.parametrize("layout", [CORE, H36M, CMU])
def test_mirroring_twice_changes_nothing_and_bones_swap_with_their_joints(layout: Layout) -> None:
    mirror = layout.mirror
    assert [mirror[mirror[joint]] for joint in range(len(mirror))] == list(range(len(mirror)))
    bones = {tuple(sorted(bone)) for bone in layout.bones}
    assert {tuple(sorted((mirror[a], mirror[b]))) for a, b in bones} == bones


def test_gradient_penalty_is_zero_for_slope_one() -> None:
    direction = torch.nn.functional.normalize(torch.ones(20), dim=0)
    generator = torch.Generator().manual_seed(0)
    a, b = torch.randn(2, 5, 20)
    assert float(gradient_penalty(lambda x: x @ direction, [a], [b], generator)) < 1e-8
    steep = gradient_penalty(lambda x: 3 * x @ direction, [a], [b], generator)
    assert float(steep) == pytest.approx(4.0, rel=1e-4)
    ignored = gradient_penalty(lambda x, _: x @ direction, [a, a], [b, b], generator)
    assert float(ignored.detach()) < 1e-8


@pytest.mark.parametrize("output", ["tangent", "curve"])
def test_a_few_windows_are_learnt_by_heart(output: str) -> None:
    class Same(SensorSource):
        def draw(self, count: int, generator: torch.Generator) -> Windows:
            windows = whole(waving())
            return Windows(windows.seen[::10], windows.future[::10])

    windows = waving()
    same = Same(windows, windows, {"waving": whole(windows)})
    generator = torch.Generator().manual_seed(0)
    torch.manual_seed(0)
    network = replace(SMALL, output=output)
    config = TrainConfig(network=network, steps=150, learning_rate=3e-3, ema=0.9)
    learner = PredictorLearner(config, same, reference_point(same, network, generator))
    first = learner.step(generator)
    for _ in range(149):
        last = learner.step(generator)
    assert last["position"] < 0.4 * first["position"]
    assert last["reconstruction"] < 0.7 * first["reconstruction"]
    assert learner.validate()["waving"] < 0.5 * stand_still_error(whole(windows))


def test_drawn_futures_come_to_lie_as_far_apart_as_the_truth_is_away() -> None:
    torch.manual_seed(0)
    config = TrainConfig(network=replace(SMALL, noise=4), steps=120, batch=32, learning_rate=3e-3)
    generator = torch.Generator().manual_seed(0)
    one = source()
    learner = PredictorLearner(config, one, reference_point(one, config.network, generator))
    terms = [learner.step(generator)["spread"] for _ in range(120)]
    assert np.mean(terms[-20:]) < 0.6 * np.mean(terms[:5])
    seen = one.draw(8, generator).seen
    futures = learner.network.eval().futures(seen, 2, generator)
    apart = (futures[:, 0] - futures[:, 1]).norm(dim=-1).mean()
    assert float(apart.detach()) > 0.002


def test_near_frames_weigh_more_and_all_weigh_one_on_average() -> None:
    weights = near_weights(25, 0.5)
    assert float(weights.mean()) == pytest.approx(1.0)
    assert (weights[:-1] > weights[1:]).all()
    assert float(weights[0] / weights[24]) == pytest.approx(5.0)
    assert torch.equal(near_weights(25, 0.0), torch.ones(25))


def test_every_published_configuration_can_be_built() -> None:
    for name, config in CONFIGS.items():
        if name == "paper":
            continue  # 100 million parameters; paper_quarter is the same code
        network = random_predictor(config.network)
        assert sum(p.numel() for p in network.parameters()) < 40_000_000, name


def test_a_resumed_run_ends_where_an_unbroken_one_does(tmp_path: Path) -> None:
    config = TrainConfig(network=replace(SMALL, flip=True), steps=6, batch=8, validate_every=3)

    def go(folder: Path, seed: int = 1, *, resume: bool = False) -> None:
        run = Run(folder, config, seed, "train", resume)
        train_on(config, run, source())

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
        train_on(config, interrupted, source())
    go(tmp_path / "broken", resume=True)

    def weights(name: str) -> torch.Tensor:
        state = torch.load(tmp_path / name / "last.pt", weights_only=True)
        return torch.cat([w.flatten() for w in state["learner"]["network"].values()])

    assert torch.equal(weights("whole"), weights("again"))
    assert torch.equal(weights("whole"), weights("broken"))
    assert not torch.equal(weights("whole"), weights("other"))
    with pytest.raises(ConfigError, match="--resume"):
        go(tmp_path / "whole")
    with pytest.raises(ConfigError, match="another configuration"):
        Run(tmp_path / "whole", replace(config, steps=7), 1, "train", resume=True)

    windows = whole(waving())
    network = load_predictor(tmp_path / "whole")
    assert position_error(network, windows, CPU) > 0
    flipped = load_trained(tmp_path / "whole", CORE)
    assert isinstance(flipped, Flipped)
    assert float((flipped(windows.seen[:4]) - network(windows.seen[:4])).detach().abs().max()) > 0


def test_contradictions_are_refused() -> None:
    with pytest.raises(ConfigError, match="coefficients is 60"):
        NetworkConfig(coefficients=60)
