"""HP-GAN: the generator, its losses, the quality network, training and the sampler's bundle."""

import copy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from agent_server.domain.skeleton import CORE_BONES, CoreJoint  # noqa: E402
from agent_server.errors import ConfigError  # noqa: E402
from models.data.windows import AMBIGUOUS, Augmentation, Recording, Stretch, WindowSet, cut  # noqa: E402
from models.evaluation.sampled import trained_sampler  # noqa: E402
from models.export.sampler import write_sampler  # noqa: E402
from models.hp_gan.config import NetworkConfig, TrainConfig  # noqa: E402
from models.hp_gan.discriminator import Discriminator, whole_features  # noqa: E402
from models.hp_gan.judge import Judge  # noqa: E402
from models.hp_gan.losses import consistency, diversity, energy, nearest  # noqa: E402
from models.hp_gan.network import Generator, motion_features  # noqa: E402
from models.hp_gan.sampler import (  # noqa: E402
    CANDIDATES,
    DRAWS,
    LIKELY,
    Sampler,
    likely_vectors,
    random_vectors,
)
from models.hp_gan.source import Named, NamedSource, Part, named_windows  # noqa: E402
from models.hp_gan.train import HpGanLearner, load_hp_gan, train_on  # noqa: E402
from models.ops.losses import bone_lengths  # noqa: E402
from models.training.run import Run  # noqa: E402

SMALL = NetworkConfig(noise=8, width=16, critic_width=16, judge_width=8)
CONFIG = TrainConfig(
    network=SMALL, steps=4, batch=8, validate_every=2, judged_from=3, synthetic_sequences=1
)
POSE = np.array(
    [
        *((0.0, 0.7, 0.0), (0.0, 0.45, 0.0), (0.0, 0.0, 0.0)),
        *((-0.2, 0.42, 0.0), (-0.3, 0.15, 0.0), (-0.3, -0.1, 0.1)),
        *((0.2, 0.42, 0.0), (0.3, 0.15, 0.0), (0.3, -0.1, 0.1)),
    ],
    np.float32,
)


def waving(frames: int = 120, seed: int = 0) -> np.ndarray:
    """A body whose right hand swings, (T, 9, 3)."""
    rng = np.random.default_rng(seed)
    motion = np.repeat(POSE[None], frames, axis=0)
    time = np.arange(frames) / 25
    motion[:, CoreJoint.RIGHT_WRIST, 0] += 0.2 * np.sin(rng.uniform(3, 6) * time)
    return motion


def windows() -> WindowSet:
    recordings = [
        Recording(motion, motion, (Stretch("hello", 0, 110),), f"p{seed}")
        for seed in range(3)
        for motion in [waving(seed=seed)]
    ]
    return cut(recordings)


def source() -> NamedSource:
    held = named_windows(windows().take(torch.arange(0, 60, 12)))
    still = Augmentation(yaw=0.3, scale=0.1, noise_m=0.0, drop=0.0)
    return NamedSource((Part(windows(), 1.0),), {"waving": held}, still)


def seen(count: int = 4) -> torch.Tensor:
    return named_windows(windows()).seen[:count]


def z(count: int, seed: int = 0) -> torch.Tensor:
    return torch.randn(count, SMALL.noise, generator=torch.Generator().manual_seed(seed))


@pytest.fixture
def generator() -> Generator:
    torch.manual_seed(0)
    return Generator(SMALL).eval()


def test_other_chance_gives_another_future_and_the_same_chance_the_same(
    generator: Generator,
) -> None:
    one, again, other = (generator(seen(), z(4, seed)) for seed in (0, 0, 1))
    assert one.shape == (4, 50, 9, 3)
    assert torch.equal(one, again)
    assert (one - other).abs().max() > 1e-4


def test_bones_keep_the_lengths_that_they_had(generator: Generator) -> None:
    past = seen()
    lengths = bone_lengths(past, CORE_BONES).mean(dim=1, keepdim=True)
    future = bone_lengths(generator(past, z(4)), CORE_BONES)
    torch.testing.assert_close(future, lengths.expand_as(future), atol=1e-4, rtol=0)


def test_a_future_goes_on_at_the_speed_at_which_the_past_has_ended(generator: Generator) -> None:
    for layer in (generator.start, generator.turn):
        torch.nn.init.zeros_(layer.weight)
    torch.nn.init.constant_(generator.keep.bias, 20.0)
    walk = torch.arange(75.0).view(1, 75, 1, 1) * torch.tensor([0.0, 0.0, 0.01])
    motion = torch.from_numpy(POSE) + walk
    future = generator(motion[:, :25], z(1))
    torch.testing.assert_close(future, motion[:, 25:], atol=2e-3, rtol=0)


def test_chance_enters_every_layer(generator: Generator) -> None:
    before = generator(seen(), z(4))
    for layer in range(SMALL.layers):
        with torch.no_grad():
            generator.chance[layer].weight += 0.5
        after = generator(seen(), z(4))
        assert not torch.allclose(before, after)
        before = after


def test_a_turned_body_has_the_turned_future(generator: Generator) -> None:
    angle = torch.tensor(0.7)
    turn = torch.tensor(
        [
            [torch.cos(angle), 0.0, torch.sin(angle)],
            [0.0, 1.0, 0.0],
            [-torch.sin(angle), 0.0, torch.cos(angle)],
        ]
    )
    plain, turned = generator(seen(), z(4)), generator(seen() @ turn, z(4))
    torch.testing.assert_close(turned, plain @ turn, atol=2e-3, rtol=0)  # heading adds 1 mm


def test_features_of_a_mixture_are_the_mixture_of_the_features() -> None:
    a, b = seen(2)[:1], seen(2)[1:] * 1.3
    mixed = motion_features(0.25 * a + 0.75 * b)
    torch.testing.assert_close(mixed, 0.25 * motion_features(a) + 0.75 * motion_features(b))


def test_only_the_nearer_future_of_each_window_has_to_come_true() -> None:
    true = torch.zeros(2, 50, 9, 3)
    near, far = (
        torch.tensor([0.1, 0.5]).view(2, 1, 1, 1),
        torch.tensor([0.4, 0.2]).view(2, 1, 1, 1),
    )
    axis = torch.tensor([1.0, 0.0, 0.0])
    futures = [true + each * axis for each in (near, far)]
    assert float(nearest(futures, true)) == pytest.approx(0.15, abs=1e-5)


def test_a_steady_motion_has_no_seam_and_a_jump_is_its_size() -> None:
    steady = torch.arange(75.0).view(1, 75, 1, 1).expand(2, -1, 9, 3) * 0.01
    past, future = steady[:, :25], steady[:, 25:]
    assert consistency(past, future) == pytest.approx(0, abs=2e-6)
    jump = torch.tensor([0.03, 0.0, 0.04])
    assert consistency(past, future + jump) == pytest.approx(0.05, abs=1e-5)


def test_equal_futures_cost_one_and_a_body_at_rest_need_not_move() -> None:
    past, true = seen(2)[:, -1], torch.zeros(2, 50, 9, 3)
    draws = z(2, 0), z(2, 1)
    assert diversity((true, true), draws, true, past) == pytest.approx(1.0, abs=1e-3)
    apart = torch.full_like(true, 0.02)
    resting = diversity((true, true + apart), draws, past[:, None].expand_as(true), past)
    moving = diversity((true, true + apart), draws, past[:, None] + 0.3, past)
    assert resting == 0 < moving < 1


def test_the_energy_of_the_truth_costs_nothing_and_a_frozen_body_its_speed() -> None:
    true = torch.arange(1.0, 51).view(1, 50, 1, 1) * torch.tensor([0.01, 0.0, 0.0])
    true = true.expand(1, 50, 9, 3)
    last = torch.zeros(1, 9, 3)
    assert energy(true, true, last) == pytest.approx(0, abs=1e-6)
    assert energy(torch.zeros_like(true), true, last) == pytest.approx(0.01, abs=1e-5)


def test_the_quality_network_teaches_the_generator_nothing() -> None:
    torch.manual_seed(0)
    learner = HpGanLearner(CONFIG, source())
    drawn = learner.source.draw(8, torch.Generator().manual_seed(0))
    before = copy.deepcopy(learner.generator.state_dict())
    learned = copy.deepcopy(learner.judge.state_dict())
    learner._teach_judge(drawn, torch.Generator().manual_seed(0))
    assert all(p.grad is None for p in learner.generator.parameters())
    assert all(torch.equal(before[k], v) for k, v in learner.generator.state_dict().items())
    assert not all(torch.equal(learned[k], v) for k, v in learner.judge.state_dict().items())


def test_windows_without_a_class_say_nothing_about_classes() -> None:
    learner = HpGanLearner(CONFIG, source())
    motion = torch.randn(4, 75, 54)
    unknown = torch.full((4,), AMBIGUOUS)
    assert learner._class_loss(motion, unknown) == 0
    some = torch.tensor([5, AMBIGUOUS, AMBIGUOUS, AMBIGUOUS])
    alone = learner._class_loss(motion[:1], some[:1])
    torch.testing.assert_close(learner._class_loss(motion, some), alone)


def test_the_quality_network_learns_to_tell_a_jump_from_real_motion() -> None:
    torch.manual_seed(0)
    judge = Judge(SMALL)
    optimizer = torch.optim.Adam(judge.parameters(), 1e-2)
    held = named_windows(windows())
    broken = held.future + 0.3 * torch.randn(held.future.shape)
    for _ in range(40):
        real, made = judge(held.seen, held.future), judge(held.seen, broken)
        loss = (
            torch.nn.functional.softplus(-real).mean() + torch.nn.functional.softplus(made).mean()
        )
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
    assert (judge.quality(held.seen, held.future) > 0.5).float().mean() > 0.9
    assert (judge.quality(held.seen, broken) > 0.5).float().mean() < 0.1


def test_a_checkpoint_that_a_young_judge_likes_counts_as_worse_than_any_later_one() -> None:
    learner = HpGanLearner(CONFIG, source())
    assert learner.validate()["score"] >= 1
    learner.done = CONFIG.judged_from
    found = learner.validate()
    assert found["score"] == pytest.approx(1 - found["plausible"])


def test_a_resumed_run_ends_where_an_unbroken_one_does(tmp_path: Path) -> None:
    train_on(CONFIG, Run(tmp_path / "whole", CONFIG, 0, "train", resume=False), source())
    with pytest.raises(InterruptedError):
        train_on(CONFIG, Run(tmp_path / "broken", CONFIG, 0, "train", resume=False), _stopping())
    train_on(CONFIG, Run(tmp_path / "broken", CONFIG, 0, "train", resume=True), source())
    whole, broken = (torch.load(tmp_path / name / "last.pt") for name in ("whole", "broken"))
    for part in ("network", "critic", "judge"):
        for name, value in whole["learner"][part].items():
            assert torch.equal(broken["learner"][part][name], value), (part, name)
    generator, critic, judge = load_hp_gan(tmp_path / "whole")
    assert generator(seen(), z(4)).shape == (4, 50, 9, 3)
    assert critic(whole_features(seen(), generator(seen(), z(4)))).shape == (4,)
    assert judge(seen(), generator(seen(), z(4))).shape == (4,)


class _Stops(NamedSource):
    """Gives three batches."""

    def draw(self, count: int, generator: torch.Generator) -> Named:
        global _given  # noqa: PLW0603
        _given += 1
        if _given > 3:
            raise InterruptedError
        return super().draw(count, generator)


_given = 0


def _stopping() -> NamedSource:
    whole = source()
    return _Stops(whole.parts, whole.validation, whole.how)


def test_the_bundle_draws_what_torch_draws_always_the_same(tmp_path: Path) -> None:
    torch.manual_seed(0)
    short = replace(SMALL, patch=25, layers=1)  # few steps are quick to export
    generator = Generator(short).eval()
    network = Sampler(generator, Judge(short), random_vectors(SMALL.noise)).eval()
    given = seen(20).contiguous().numpy()
    assert write_sampler(network, given, tmp_path) < 1e-4
    with np.load(tmp_path / "golden.npz") as golden:
        assert golden["future"].shape == (6, 50, 9, 3)
        assert ((golden["quality"] > 0) & (golden["quality"] < 1)).all()
        draw = trained_sampler(network)
        for row in range(6):
            drawn = draw(golden["seen"][row : row + 1], row + 1)
            np.testing.assert_allclose(drawn.futures[0, row], golden["future"][row], atol=1e-4)
            np.testing.assert_allclose(drawn.quality[0, row], golden["quality"][row], atol=1e-4)


class Swayed(torch.nn.Module):
    """Moves nobody, or everybody by as many metres as the first random number is above 0.5."""

    def forward(self, seen: torch.Tensor, z: torch.Tensor) -> torch.Tensor:
        return seen[:, -1:] + torch.relu(z[:, 0] - 0.5).view(-1, 1, 1, 1)


class Strict:
    """Holds for real what stays where it was."""

    def quality(self, seen: torch.Tensor, future: torch.Tensor) -> torch.Tensor:
        return ((future[:, -1] - seen[:, -1]).abs().amax(dim=(1, 2)) < 0.01).float()


def test_random_vectors_that_throw_bodies_about_are_left_out() -> None:
    candidates = random_vectors(SMALL.noise, CANDIDATES)
    assert (candidates[:DRAWS, 0] > 0.51).any()
    chosen = likely_vectors(Swayed(), SMALL.noise, Strict(), [seen(), seen(1)])
    calm = candidates[candidates[:, 0] < 0.51]
    assert len(calm) > LIKELY
    torch.testing.assert_close(chosen, calm[:DRAWS])


def test_skips_and_both_heads_of_the_discriminator_see_the_whole_motion() -> None:
    torch.manual_seed(0)
    critic = Discriminator(SMALL)
    motion = torch.randn(2, 75, 54, requires_grad=True)
    for head in (critic(motion).sum(), critic.classes(motion).sum()):
        (gradient,) = torch.autograd.grad(head, motion, retain_graph=True)
        assert (gradient.abs().amax(dim=2) > 0).all()


@pytest.mark.parametrize(
    ("change", "words"), [({"patch": 4}, "patch is 4"), ({"noise": 0}, "noise is 0")]
)
def test_shapes_that_cannot_be_are_refused(change: dict[str, int], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        replace(SMALL, **change)


def test_a_training_that_never_trusts_its_judge_is_refused() -> None:
    with pytest.raises(ConfigError, match="judged_from is 9"):
        replace(CONFIG, judged_from=9)
