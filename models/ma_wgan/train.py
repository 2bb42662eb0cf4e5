"""Training of the predictor: generator and critic in turn."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch
from torch import nn

from models.data.layouts import Layout
from models.ma_wgan.config import NetworkConfig, TrainConfig
from models.ma_wgan.critic import make_critic
from models.ma_wgan.futures import spread_of_futures
from models.ma_wgan.network import Flipped, Predictor
from models.ma_wgan.representation import Forecast, Point, Target, karcher_means
from models.ops.heading import heading, to_front
from models.ops.losses import (
    bone_loss,
    gradient_penalty,
    gram_distance,
    joint_distance,
    near_weights,
)
from models.training.errors import validation_errors
from models.training.fit import fit, training_device
from models.training.run import Run, read_best, read_info
from models.training.schedule import warm_cosine
from models.training.source import Source, Windows, make_source
from models.training.updater import Updater

REFERENCE_WINDOWS = 4_000
LARGEST_GRADIENT = 1.0
GRAM_EVERY = 5
"""The Gram matrices of every fifth frame say the same as all of them."""


def make_target(windows: Windows, front: bool) -> Target:
    """What the generator ought to give for some windows."""
    seen, future = windows
    if front:
        direction = heading(seen)
        seen, future = to_front(seen, direction), to_front(future, direction)
    return Target(seen.flatten(2), future.flatten(2))


def reference_point(
    source: Source, config: NetworkConfig, generator: torch.Generator
) -> torch.Tensor:
    """Karcher mean of the SRVFs of training windows, shape (S, D)."""
    target = make_target(source.draw(REFERENCE_WINDOWS, generator), config.front)
    return karcher_means(target.curve(), config.spheres)


def generator_terms(
    forecast: Forecast, target: Target, true: Point, layout: Layout, weights: torch.Tensor
) -> dict[str, torch.Tensor]:
    """The loss terms by their name in the configuration, all but the critic's.

    Args:
        forecast: What the generator expects.
        target: What comes.
        true: The same on the spheres.
        layout: The joints.
        weights: Of the future frames in the position and velocity terms, (future,).
    """
    gap = (forecast.point.tangent - true.tangent).abs().sum(-1) / target.future.shape[1]
    stretch = (forecast.point.log_length - true.log_length).abs()
    pose, true_pose = forecast.poses.unflatten(2, (-1, 3)), target.future.unflatten(2, (-1, 3))
    start = target.start.unflatten(2, (-1, 3))
    steps = torch.diff(pose, dim=1, prepend=start)
    true_steps = torch.diff(true_pose, dim=1, prepend=start)
    return {
        "reconstruction": (true.moving * gap).mean(),
        "skeleton": gram_distance(centred(pose), centred(true_pose)).mean(),
        "bones": bone_loss(pose, true_pose, layout.bones),
        "length": (true.moving * stretch).mean(),
        "position": joint_distance(pose, true_pose, weights),
        "velocity": joint_distance(steps, true_steps, weights),
    }


def centred(poses: torch.Tensor) -> torch.Tensor:
    """Every fifth pose of (B, T, J, 3), relative to its own centre."""
    some = poses[:, ::GRAM_EVERY]
    return some - some.mean(dim=2, keepdim=True)


class PredictorLearner:
    """Generator, critic, and what updates them."""

    def __init__(self, config: TrainConfig, source: Source, reference: torch.Tensor) -> None:
        self.config, self.source = config, source
        self.device = training_device()
        self.network = Predictor(config.network, reference, config.half).to(self.device)
        self.critic = make_critic(config.network).to(self.device)
        self.weights = near_weights(config.network.future, config.near).to(self.device)
        optimizer = torch.optim.AdamW(
            self.network.parameters(), config.learning_rate, weight_decay=config.weight_decay
        )
        self.updater = Updater(
            self.network,
            optimizer,
            lambda step: warm_cosine(step, config.steps),
            ema=config.ema,
            clip=LARGEST_GRADIENT,
        )
        self.critic_optimizer = torch.optim.Adam(
            self.critic.parameters(), config.critic_rate, betas=(0.5, 0.9)
        )

    def step(self, generator: torch.Generator) -> dict[str, float]:
        """One update of both networks."""
        config = self.config
        windows = self.source.draw(config.batch, generator)
        moved = Windows(windows.seen.to(self.device), windows.future.to(self.device))
        target = make_target(moved, config.network.front)
        true = self.network.spheres.encode(target.curve())
        self.network.train()
        forecast = self.network.forecast(target.seen)
        terms = generator_terms(forecast, target, true, self.source.layout, self.weights)
        real: tuple[torch.Tensor, ...] = (true.tangent, target.future - target.start)
        fake: tuple[torch.Tensor, ...] = (forecast.point.tangent, forecast.poses - target.start)
        if config.network.noise:
            drawn, terms["spread"] = spread_of_futures(self.network, target, forecast, generator)
            starts = target.start[: len(drawn.poses) // 2].repeat_interleave(2, 0)
            fake = (
                torch.cat([fake[0], drawn.point.tangent]),
                torch.cat([fake[1], drawn.poses - starts]),
            )
            real = tuple(torch.cat([part, part[: len(drawn.poses)]]) for part in real)
        if config.adversarial:
            terms["adversarial"] = -self.critic(*fake).mean()
        weighted = [getattr(config, name) * term for name, term in terms.items()]
        self.updater.apply(torch.stack(weighted).sum())
        if config.adversarial:
            self._teach_critic(real, tuple(part.detach() for part in fake), generator)
        return {name: float(term.detach()) for name, term in terms.items()}

    def _teach_critic(
        self,
        real: tuple[torch.Tensor, ...],
        fake: tuple[torch.Tensor, ...],
        generator: torch.Generator,
    ) -> None:
        """Wasserstein loss with the gradient penalty on tangent interpolates."""
        gap = self.critic(*fake).mean() - self.critic(*real).mean()
        penalty = gradient_penalty(self.critic, real, fake, generator)
        self.critic_optimizer.zero_grad(set_to_none=True)
        torch.autograd.backward(gap + self.config.penalty * penalty)
        self.critic_optimizer.step()

    def validate(self) -> dict[str, float]:
        """Errors in mm by name, and the score."""
        return validation_errors(self.updater.ema.network, self.source.validation, self.device)

    def best(self) -> dict[str, Any]:
        """The averaged weights."""
        return self.updater.best()

    def state(self) -> dict[str, Any]:
        """Everything that a resumed run needs."""
        return {
            **self.updater.state(),
            "critic": self.critic.state_dict(),
            "critic_optimizer": self.critic_optimizer.state_dict(),
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Go on from :meth:`state`."""
        self.updater.load(state)
        self.critic.load_state_dict(state["critic"])
        self.critic_optimizer.load_state_dict(state["critic_optimizer"])


def train(config: TrainConfig, run: Run, data: Path, cache: Path) -> None:
    """Train a predictor.

    Args:
        config: What to do.
        run: Where to keep checkpoints; a run that was begun is gone on with.
        data: Folder that holds the set folders.
        cache: Folder of generated recordings.
    """
    seen, sequences = config.network.seen, config.synthetic_sequences
    train_on(config, run, make_source(config.data, seen, data, cache, sequences=sequences))


def train_on(config: TrainConfig, run: Run, source: Source) -> None:
    """The same, on windows of any source."""
    seed = run.info["seed"]
    torch.manual_seed(seed)
    # Drawn apart from the batches, so that a resumed run has the same reference point.
    reference = reference_point(source, config.network, torch.Generator().manual_seed(seed + 1))
    learner = PredictorLearner(config, source, reference)
    fit("ma_wgan", learner, run, config.steps, config.validate_every)


def load_predictor(folder: Path) -> Predictor:
    """The best network of a run, ready to evaluate."""
    config = NetworkConfig(**read_info(folder)["config"]["network"])
    weights = read_best(folder)["network"]
    network = Predictor(config, weights["spheres.reference"])
    network.load_state_dict(weights)
    return network.eval()


def load_trained(folder: Path, layout: Layout) -> nn.Module:
    """The same as it is used: averaged with its mirror image if the configuration says so."""
    network = load_predictor(folder)
    return Flipped(network, layout.mirror).eval() if network.config.flip else network
