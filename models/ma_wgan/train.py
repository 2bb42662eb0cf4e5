"""Training of the predictor."""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
from torch import nn

from agent_server.domain.motion import PREDICTED_FRAMES, SEEN_FRAMES
from agent_server.domain.skeleton import CoreJoint
from models.data.windows import HALF_QUARTER_TURN, Augmentation, WindowSet, augment
from models.ma_wgan.config import NetworkConfig, TrainConfig
from models.ma_wgan.network import Critic, Generator
from models.ops import sphere, srvf
from models.ops.heading import heading, to_front
from models.ops.losses import bone_loss, gradient_penalty, gram_distance
from models.training.ema import Ema
from models.training.progress import TrainingProgress
from models.training.run import Run, read_best, read_info
from models.training.schedule import warm_cosine

AUGMENTATION = Augmentation(yaw=HALF_QUARTER_TURN, scale=0.1, noise_m=0.015, drop=0.05)
REFERENCE_WINDOWS = 4_000
MOVING_M = 0.5
"""Curve length at which a window counts half in the tangent space: the direction of a curve
that hardly moves is noise."""
GRAM_EVERY = 5
"""The Gram matrices of every fifth frame say the same as all of them."""


@dataclass(frozen=True, slots=True)
class Target:
    """What the generator sees and ought to give; everything faces the front.

    Attributes:
        seen: Shape (B, 25, 27), metres, as the sensor saw it.
        future: Shape (B, 50, 27), metres, without sensor noise.
        tangent: Shape (B, 1350), at the reference point.
        log_length: Shape (B,).
        moving: Shape (B,), in [0, 1]: how much the tangent vector means.
    """

    seen: torch.Tensor
    future: torch.Tensor
    tangent: torch.Tensor
    log_length: torch.Tensor
    moving: torch.Tensor


def future_curve(observed: torch.Tensor, clean: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
    """Seen (B, 25, 27) and the curve from the last seen pose on, (B, 51, 27), facing the front."""
    seen = observed[:, :SEEN_FRAMES]
    direction = heading(seen)
    front = to_front(seen, direction).flatten(2)
    future = to_front(clean[:, SEEN_FRAMES:], direction).flatten(2)
    return front, torch.cat([front[:, -1:], future], dim=1)


def reference_point(windows: WindowSet, generator: torch.Generator) -> torch.Tensor:
    """Karcher mean of the SRVFs of moving training windows, shape (1350,)."""
    index = torch.randint(len(windows), (REFERENCE_WINDOWS,), generator=generator)
    observed, clean = augment(*windows.frames(index), AUGMENTATION, generator)
    _, curve = future_curve(observed, clean)
    points, length = srvf.to_sphere(curve.double())
    return sphere.karcher_mean(points[length > MOVING_M].flatten(1)).float()


def make_target(observed: torch.Tensor, clean: torch.Tensor, reference: torch.Tensor) -> Target:
    """What the generator ought to give for windows (B, 75, 9, 3)."""
    seen, curve = future_curve(observed, clean)
    point, length = srvf.to_sphere(curve)
    return Target(
        seen=seen,
        future=curve[:, 1:],
        tangent=sphere.log(point.flatten(1), reference),
        log_length=torch.log(length + 1e-2),
        moving=length / (length + MOVING_M),
    )


def about_navel(poses: torch.Tensor) -> torch.Tensor:
    """Every fifth pose of (B, T, 9, 3), relative to its own navel."""
    some = poses[:, ::GRAM_EVERY]
    return some - some[:, :, CoreJoint.NAVEL : CoreJoint.NAVEL + 1]


def generator_terms(
    network: Generator, critic: Critic, target: Target
) -> tuple[dict[str, torch.Tensor], torch.Tensor]:
    """The loss terms by their name in the configuration, and the tangent vectors."""
    tangent, log_length = network.tangent_and_length(target.seen)
    start = target.seen[:, -1]
    future = network.decode(tangent, log_length, start)
    truth = target.future
    steps = torch.diff(future, dim=1, prepend=start[:, None])
    true_steps = torch.diff(truth, dim=1, prepend=start[:, None])
    joints = (*future.shape[:2], -1, 3)
    pose, true_pose = future.reshape(joints), truth.reshape(joints)
    gap = (tangent - target.tangent).abs().sum(-1) / PREDICTED_FRAMES
    terms = {
        "adversarial": -critic(tangent).mean(),
        "reconstruction": (target.moving * gap).mean(),
        "skeleton": gram_distance(about_navel(pose), about_navel(true_pose)).mean(),
        "bones": bone_loss(pose, true_pose),
        "length": (target.moving * (log_length - target.log_length).abs()).mean(),
        "position": torch.sqrt(((pose - true_pose) ** 2).sum(-1) + 1e-8).mean(),
        "velocity": torch.sqrt(((steps - true_steps).reshape(joints) ** 2).sum(-1) + 1e-8).mean(),
    }
    return terms, tangent


def critic_loss(
    critic: Critic,
    real: torch.Tensor,
    fake: torch.Tensor,
    penalty: float,
    generator: torch.Generator,
) -> torch.Tensor:
    """Wasserstein loss with the gradient penalty on tangent interpolates."""
    gap: torch.Tensor = critic(fake).mean() - critic(real).mean()
    return gap + penalty * gradient_penalty(critic, real, fake, generator)


@torch.no_grad()
def position_error(network: nn.Module, windows: WindowSet, device: torch.device) -> float:
    """Mean distance of predicted and true joints over all windows and frames, in mm."""
    total = 0.0
    for index in torch.split(torch.arange(len(windows)), 512):
        observed, clean = windows.frames(index)
        future = network(observed[:, :SEEN_FRAMES].to(device)).cpu()
        total += float((future - clean[:, SEEN_FRAMES:]).norm(dim=-1).mean(dim=(1, 2)).sum())
    return 1000 * total / len(windows)


@torch.no_grad()
def stand_still_error(windows: WindowSet) -> float:
    """The same for a prediction that repeats the last pose, in mm."""
    observed, clean = windows.frames(torch.arange(len(windows)))
    still = observed[:, SEEN_FRAMES - 1 : SEEN_FRAMES]
    return 1000 * float((still - clean[:, SEEN_FRAMES:]).norm(dim=-1).mean())


class Trainer:
    """Alternates critic and generator; the state of both can be saved and restored."""

    def __init__(self, config: TrainConfig, reference: torch.Tensor, device: torch.device) -> None:
        self.config = config
        self.network = Generator(config.network, reference).to(device)
        self.critic = Critic(config.network).to(device)
        self.ema = Ema(self.network, config.ema)
        self.optimizer = torch.optim.AdamW(
            self.network.parameters(), config.learning_rate, weight_decay=config.weight_decay
        )
        self.critic_optimizer = torch.optim.Adam(
            self.critic.parameters(), config.critic_rate, betas=(0.5, 0.9)
        )
        self.schedule = torch.optim.lr_scheduler.LambdaLR(
            self.optimizer, lambda step: warm_cosine(step, config.steps)
        )

    def step(self, target: Target, generator: torch.Generator) -> dict[str, float]:
        """One update of both networks; gives the loss terms."""
        config = self.config
        terms, tangent = generator_terms(self.network, self.critic, target)
        loss = torch.stack([getattr(config, name) * term for name, term in terms.items()]).sum()
        self.optimizer.zero_grad(set_to_none=True)
        torch.autograd.backward(loss)
        nn.utils.clip_grad_norm_(self.network.parameters(), 1.0)
        self.optimizer.step()
        self.schedule.step()
        self.ema.update(self.network)
        gap = critic_loss(self.critic, target.tangent, tangent.detach(), config.penalty, generator)
        self.critic_optimizer.zero_grad(set_to_none=True)
        torch.autograd.backward(gap)
        self.critic_optimizer.step()
        return {name: float(term.detach()) for name, term in terms.items()}

    def state(self) -> dict[str, Any]:
        """Everything that a resumed run needs, in plain tensors and numbers."""
        return {
            "network": self.network.state_dict(),
            "critic": self.critic.state_dict(),
            "ema": self.ema.network.state_dict(),
            "ema_updates": self.ema.updates,
            "optimizer": self.optimizer.state_dict(),
            "critic_optimizer": self.critic_optimizer.state_dict(),
            "schedule": self.schedule.state_dict(),
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Go on from :meth:`state`."""
        self.network.load_state_dict(state["network"])
        self.critic.load_state_dict(state["critic"])
        self.ema.network.load_state_dict(state["ema"])
        self.ema.updates = state["ema_updates"]
        self.optimizer.load_state_dict(state["optimizer"])
        self.critic_optimizer.load_state_dict(state["critic_optimizer"])
        self.schedule.load_state_dict(state["schedule"])


def train(
    config: TrainConfig,
    run: Run,
    training: list[tuple[float, WindowSet]],
    validation: dict[str, WindowSet],
) -> None:
    """Train a predictor.

    Args:
        config: What to do.
        run: Where to keep checkpoints; a run that was begun is gone on with.
        training: Share of each batch, and the windows that it is drawn from.
        validation: Windows by name; the checkpoint with the lowest mean of the errors, each
            over that of standing still, is kept as the best.
    """
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    generator = torch.Generator().manual_seed(run.info["seed"])
    torch.manual_seed(run.info["seed"])
    state = run.resume()
    if state is None:
        largest = max(training, key=lambda pair: pair[0])[1]
        reference = reference_point(largest, generator)
    else:
        reference = state["network"]["reference"].cpu()
    trainer = Trainer(config, reference, device)
    first, best, spent = 0, float("inf"), 0.0
    if state is not None:
        trainer.load(state["trainer"])
        generator.set_state(state["generator"])
        first, best, spent = state["step"], state["best"], run.info["wall_s"]
    still = {name: stand_still_error(windows) for name, windows in validation.items()}
    began = time.monotonic() - spent
    with TrainingProgress("ma_wgan", config.steps, first) as progress:
        for step in range(first, config.steps):
            observed, clean = draw(training, config.batch, generator)
            target = make_target(observed.to(device), clean.to(device), reference.to(device))
            terms = trainer.step(target, generator)
            progress.advance(terms)
            done = step + 1
            if done % config.validate_every and done != config.steps:
                continue
            errors = {
                name: position_error(trainer.ema.network, windows, device)
                for name, windows in validation.items()
            }
            score = sum(errors[name] / still[name] for name in errors) / len(errors)
            if score < best:
                best = score
                run.save_best({"network": trainer.ema.network.state_dict(), "step": done})
            wall = time.monotonic() - began
            row = {"step": done, "wall_s": wall, "score": score, **errors, **terms}
            run.log(row)
            progress.report(done, row)
            run.save(
                {
                    "network": trainer.network.state_dict(),
                    "trainer": trainer.state(),
                    "generator": generator.get_state(),
                    "step": done,
                    "best": best,
                },
                wall,
            )


def draw(
    training: list[tuple[float, WindowSet]], batch: int, generator: torch.Generator
) -> tuple[torch.Tensor, torch.Tensor]:
    """An augmented batch of observed and clean windows, each set with its share."""
    parts = []
    total = sum(share for share, _ in training)
    for share, windows in training:
        count = max(1, round(batch * share / total))
        index = torch.randint(len(windows), (count,), generator=generator)
        parts.append(windows.frames(index))
    observed = torch.cat([part[0] for part in parts])
    clean = torch.cat([part[1] for part in parts])
    return augment(observed, clean, AUGMENTATION, generator)


def load_predictor(folder: Path) -> Generator:
    """The best network of a run, ready to evaluate."""
    config = NetworkConfig(**read_info(folder)["config"]["network"])
    weights = read_best(folder)["network"]
    network = Generator(config, weights["reference"])
    network.load_state_dict(weights)
    return network.eval()
