"""Training of the classifier on what was seen and what a frozen predictor expects."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import torch
import torch.nn.functional as F
from torch import nn

from agent_server.domain.gesture import GESTURES, IDLE
from agent_server.domain.motion import PREDICTED_FRAMES, SEEN_FRAMES
from agent_server.errors import InvalidInput
from models.data.windows import AMBIGUOUS, Augmentation, WindowSet, augment
from models.interformer.config import NetworkConfig, TrainConfig
from models.interformer.network import Classifier
from models.training.ema import Ema
from models.training.progress import TrainingProgress
from models.training.run import Run, read_best, read_info
from models.training.schedule import warm_cosine

AUGMENTATION = Augmentation(yaw=0.35, scale=0.1, noise_m=0.02, drop=0.08)
IDLE_INDEX = GESTURES.index(IDLE)


def hold_last(seen: torch.Tensor) -> torch.Tensor:
    """The future that repeats the last seen frame: (B, 25, 9, 3) -> (B, 50, 9, 3)."""
    return seen[:, -1:].expand(-1, PREDICTED_FRAMES, -1, -1)


@dataclass(frozen=True, slots=True)
class Pools:
    """Windows by label, so that a batch can be balanced.

    Attributes:
        windows: All of them.
        by_class: Index of the windows of each class.
    """

    windows: WindowSet
    by_class: tuple[torch.Tensor, ...]

    @classmethod
    def of(cls, windows: WindowSet) -> "Pools":
        """Sort windows by label; ambiguous ones are left out.

        Raises:
            InvalidInput: If a class has no window.
        """
        by_class = tuple((windows.labels == c).nonzero()[:, 0] for c in range(len(GESTURES)))
        for name, pool in zip(GESTURES, by_class, strict=True):
            if not len(pool):
                raise InvalidInput(f"no training window shows {name}: give more sequences")
        return cls(windows, by_class)

    def draw(self, batch: int, idle: float, generator: torch.Generator) -> torch.Tensor:
        """Indices of a batch with a share of ``idle`` and the gestures in equal parts."""
        others = torch.randint(IDLE_INDEX, (batch,), generator=generator)
        is_idle = torch.rand(batch, generator=generator) < idle
        classes = torch.where(is_idle, IDLE_INDEX, others)
        spot = torch.rand(batch, generator=generator)
        picked = [
            self.by_class[c][int(s * len(self.by_class[c]))]
            for c, s in zip(classes.tolist(), spot.tolist(), strict=True)
        ]
        return torch.stack(picked)


def complete(
    predictor: nn.Module,
    observed: torch.Tensor,
    config: TrainConfig,
    undecided: torch.Tensor,
    generator: torch.Generator,
) -> torch.Tensor:
    """Windows as the classifier gets them: seen frames, then predicted, held or true ones.

    Args:
        predictor: Frozen; seen (B, 25, 9, 3) -> future (B, 50, 9, 3).
        observed: Shape (B, 75, 9, 3).
        config: Its shares of true, held and predicted futures.
        undecided: Shape (B,), whether the true future shows what the label does not say.
        generator: Where the choice comes from.
    """
    seen = observed[:, :SEEN_FRAMES]
    with torch.no_grad():
        predicted = predictor(seen)
    draw = torch.rand(len(observed), generator=generator).to(observed.device)
    keep = (draw < config.true_future) & ~undecided
    hold = draw >= 1 - config.last_frame
    future = torch.where(keep[:, None, None, None], observed[:, SEEN_FRAMES:], predicted)
    future = torch.where(hold[:, None, None, None], hold_last(seen), future)
    return torch.cat([seen, future], dim=1)


@torch.no_grad()
def window_logits(
    classifier: nn.Module,
    predictor: Callable[[torch.Tensor], torch.Tensor],
    windows: WindowSet,
    device: torch.device,
) -> torch.Tensor:
    """Logits (N, C) with the futures that ``predictor`` gives for the seen frames."""
    logits = []
    for index in torch.split(torch.arange(len(windows)), 512):
        seen = windows.frames(index)[0][:, :SEEN_FRAMES].to(device)
        logits.append(classifier(torch.cat([seen, predictor(seen)], dim=1)).cpu())
    return torch.cat(logits)


def balanced_loss(logits: torch.Tensor, labels: torch.Tensor) -> float:
    """Cross entropy, averaged over the windows of each class and then over the classes."""
    each = F.cross_entropy(logits, labels, reduction="none")
    return float(torch.stack([each[labels == c].mean() for c in torch.unique(labels)]).mean())


def balanced_accuracy(logits: torch.Tensor, labels: torch.Tensor) -> float:
    """Share of right answers, averaged over the classes that occur."""
    right = (logits.argmax(-1) == labels).float()
    return float(torch.stack([right[labels == c].mean() for c in torch.unique(labels)]).mean())


class Trainer:
    """One network and what updates it; its state can be saved and restored."""

    def __init__(self, config: TrainConfig, device: torch.device) -> None:
        self.config = config
        self.network = Classifier(config.network).to(device)
        self.ema = Ema(self.network, config.ema)
        self.optimizer = torch.optim.AdamW(
            self.network.parameters(), config.learning_rate, weight_decay=config.weight_decay
        )
        self.schedule = torch.optim.lr_scheduler.LambdaLR(
            self.optimizer, lambda step: warm_cosine(step, config.steps)
        )

    def step(self, motion: torch.Tensor, labels: torch.Tensor) -> dict[str, float]:
        """One update; gives loss and accuracy of the batch."""
        self.network.train()
        logits = self.network(motion)
        loss = F.cross_entropy(logits, labels, label_smoothing=self.config.smoothing)
        self.optimizer.zero_grad(set_to_none=True)
        torch.autograd.backward(loss)
        nn.utils.clip_grad_norm_(self.network.parameters(), 1.0)
        self.optimizer.step()
        self.schedule.step()
        self.ema.update(self.network)
        accuracy = (logits.argmax(-1) == labels).float().mean()
        return {"loss": float(loss.detach()), "accuracy": float(accuracy)}

    def state(self) -> dict[str, Any]:
        """Everything that a resumed run needs, in plain tensors and numbers."""
        return {
            "network": self.network.state_dict(),
            "ema": self.ema.network.state_dict(),
            "ema_updates": self.ema.updates,
            "optimizer": self.optimizer.state_dict(),
            "schedule": self.schedule.state_dict(),
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Go on from :meth:`state`."""
        self.network.load_state_dict(state["network"])
        self.ema.network.load_state_dict(state["ema"])
        self.ema.updates = state["ema_updates"]
        self.optimizer.load_state_dict(state["optimizer"])
        self.schedule.load_state_dict(state["schedule"])


def train(
    config: TrainConfig,
    run: Run,
    training: WindowSet,
    validation: WindowSet,
    predictor: nn.Module,
) -> None:
    """Train a classifier; the checkpoint with the lowest balanced validation loss is the best.

    Args:
        config: What to do.
        run: Where to keep checkpoints; a run that was begun is gone on with.
        training: Windows with labels; ambiguous ones are left out.
        validation: Windows of other people.
        predictor: Frozen.
    """
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    generator = torch.Generator().manual_seed(run.info["seed"])
    torch.manual_seed(run.info["seed"])
    predictor = predictor.to(device).eval().requires_grad_(False)
    pools = Pools.of(training)
    validation = validation.take((validation.labels != AMBIGUOUS).nonzero()[:, 0])
    trainer = Trainer(config, device)
    first, best, spent = 0, float("inf"), 0.0
    state = run.resume()
    if state is not None:
        trainer.load(state["trainer"])
        generator.set_state(state["generator"])
        first, best, spent = state["step"], state["best"], run.info["wall_s"]
    began = time.monotonic() - spent
    with TrainingProgress("interformer", config.steps, first) as progress:
        for step in range(first, config.steps):
            index = pools.draw(config.batch, config.idle, generator)
            observed, _ = augment(*training.frames(index), AUGMENTATION, generator)
            labels = training.labels[index].to(device)
            since = training.since_onset[index]
            undecided = ((since < 0) & (since > -PREDICTED_FRAMES)).to(device)
            motion = complete(predictor, observed.to(device), config, undecided, generator)
            terms = trainer.step(motion, labels)
            progress.advance(terms)
            done = step + 1
            if done % config.validate_every and done != config.steps:
                continue
            network = trainer.ema.network
            futures = hold_last if config.seen_only else predictor
            logits = window_logits(network, futures, validation, device)
            loss = balanced_loss(logits, validation.labels)
            if loss < best:
                best = loss
                run.save_best({"network": network.state_dict(), "step": done})
            wall = time.monotonic() - began
            accuracy = balanced_accuracy(logits, validation.labels)
            row = {
                "step": done,
                "wall_s": wall,
                "validation_loss": loss,
                "validation_accuracy": accuracy,
                **terms,
            }
            run.log(row)
            progress.report(done, row)
            run.save(
                {
                    "trainer": trainer.state(),
                    "generator": generator.get_state(),
                    "step": done,
                    "best": best,
                },
                wall,
            )


def load_classifier(folder: Path) -> Classifier:
    """The best network of a run, ready to evaluate."""
    network = Classifier(NetworkConfig(**read_info(folder)["config"]["network"]))
    network.load_state_dict(read_best(folder)["network"])
    return network.eval()
