"""Training of the classifier on what was seen and what a frozen predictor expects."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch
import torch.nn.functional as F
from torch import nn

from agent_server.domain.gesture import IDLE
from agent_server.domain.motion import PREDICTED_FRAMES, SEEN_FRAMES
from agent_server.errors import InvalidInput
from models.data.windows import AMBIGUOUS, WindowSet, augment
from models.interformer.config import NetworkConfig, TrainConfig
from models.interformer.network import Classifier
from models.training.fit import fit, training_device
from models.training.run import Run, read_best, read_info
from models.training.schedule import warm_cosine
from models.training.updater import Updater

LARGEST_GRADIENT = 1.0


Predict = Callable[[torch.Tensor], torch.Tensor]
"""Seen (B, 25, 9, 3) -> future (B, 50, 9, 3)."""


def hold_last(seen: torch.Tensor) -> torch.Tensor:
    """The future that repeats the last seen frame: (B, 25, 9, 3) -> (B, 50, 9, 3)."""
    return seen[:, -1:].expand(-1, PREDICTED_FRAMES, -1, -1)


@dataclass(frozen=True, slots=True)
class Pools:
    """Windows by label, so that a batch can be balanced.

    Attributes:
        by_class: Index of the windows of each class.
        idle: Which class is idle, or None.
    """

    by_class: tuple[torch.Tensor, ...]
    idle: int | None

    @classmethod
    def of(cls, windows: WindowSet, labels: torch.Tensor) -> "Pools":
        """Sort windows by label; ambiguous ones are left out.

        Args:
            windows: The windows.
            labels: Shape (N,), what the seen second says of them, or all 3 s.

        Raises:
            InvalidInput: If a class has no window.
        """
        classes = windows.classes
        by_class = tuple((labels == c).nonzero()[:, 0] for c in range(len(classes)))
        for name, pool in zip(classes, by_class, strict=True):
            if not len(pool):
                raise InvalidInput(f"no training window shows {name}: give more sequences")
        return cls(by_class, classes.index(IDLE) if IDLE in classes else None)

    def draw(self, batch: int, idle: float, generator: torch.Generator) -> torch.Tensor:
        """Indices of a batch with a share of ``idle``, if it is a class, and all others alike."""
        gestures = [c for c in range(len(self.by_class)) if c != self.idle]
        classes = torch.tensor(gestures)[
            torch.randint(len(gestures), (batch,), generator=generator)
        ]
        is_idle = torch.rand(batch, generator=generator) < idle
        if self.idle is not None:
            classes = torch.where(is_idle, self.idle, classes)
        spot = torch.rand(batch, generator=generator)
        picked = [
            self.by_class[c][int(s * len(self.by_class[c]))]
            for c, s in zip(classes.tolist(), spot.tolist(), strict=True)
        ]
        return torch.stack(picked) if picked else torch.empty(0, dtype=torch.long)


@torch.no_grad()
def completed(predictor: Predict, observed: torch.Tensor, config: TrainConfig) -> torch.Tensor:
    """Windows as ``config`` has them completed, cut to the frames that the network takes.

    Args:
        predictor: Frozen; seen (B, 25, 9, 3) -> future (B, 50, 9, 3).
        observed: Shape (B, 75, 9, 3).
        config: Its kind of future and its frames.
    """
    seen = observed[:, :SEEN_FRAMES]
    match config.futures:
        case "true":
            motion = observed
        case "held":
            motion = torch.cat([seen, hold_last(seen)], dim=1)
        case "predicted":
            motion = torch.cat([seen, predictor(seen)], dim=1)
    return motion[:, : config.network.frames]


@torch.no_grad()
def window_logits(
    classifier: nn.Module,
    predictor: Predict,
    windows: WindowSet,
    config: TrainConfig,
    device: torch.device,
) -> torch.Tensor:
    """Logits (N, C) of windows completed as ``config`` says."""
    logits = []
    for index in torch.split(torch.arange(len(windows)), 512):
        observed = windows.frames(index)[0].to(device)
        logits.append(classifier(completed(predictor, observed, config)).cpu())
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
    """One network and what updates it."""

    def __init__(
        self, config: TrainConfig, device: torch.device, network: Classifier | None = None
    ) -> None:
        self.config = config
        self.network = (network or Classifier(config.network)).to(device)
        trained = [weight for weight in self.network.parameters() if weight.requires_grad]
        optimizer = torch.optim.AdamW(
            trained, config.learning_rate, weight_decay=config.weight_decay
        )
        self.updater = Updater(
            self.network,
            optimizer,
            lambda step: warm_cosine(step, config.steps),
            ema=config.ema,
            clip=LARGEST_GRADIENT,
        )

    def step(
        self, motion: torch.Tensor, labels: torch.Tensor, generator: torch.Generator
    ) -> dict[str, float]:
        """One update; gives loss and accuracy of the batch."""
        config = self.config
        shares = torch.ones(len(motion), device=motion.device)
        other = torch.arange(len(motion), device=motion.device)
        if config.mixup:
            shares = mixing_shares(len(motion), config.mixup, generator).to(motion.device)
            other = torch.randperm(len(motion), generator=generator).to(motion.device)
            blend = shares[:, None, None, None]
            motion = blend * motion + (1 - blend) * motion[other]
        self.network.train()
        logits = self.network(motion)
        mine, its = (
            F.cross_entropy(logits, each, reduction="none", label_smoothing=config.smoothing)
            for each in (labels, labels[other])
        )
        loss = (shares * mine + (1 - shares) * its).mean()
        self.updater.apply(loss)
        accuracy = (logits.argmax(-1) == labels).float().mean()
        return {"loss": float(loss.detach()), "accuracy": float(accuracy)}


def mixing_shares(count: int, alpha: float, generator: torch.Generator) -> torch.Tensor:
    """Shares of the window whose label counts more, Beta(alpha, alpha) folded to [0.5, 1]."""
    seed = int(torch.randint(2**31, (1,), generator=generator))
    drawn = np.random.default_rng(seed).beta(alpha, alpha, count)
    return torch.from_numpy(np.maximum(drawn, 1 - drawn)).float()


class ClassifierLearner:
    """Draws batches of completed windows, and judges by the balanced validation loss."""

    def __init__(
        self,
        config: TrainConfig,
        training: WindowSet,
        validation: WindowSet,
        predictor: nn.Module,
        network: Classifier | None = None,
    ) -> None:
        self.config, self.training = config, training
        self.device = training_device()
        self.predictor = predictor.to(self.device).eval().requires_grad_(False)
        self.by_seen = Pools.of(training, training.labels)
        self.by_whole = Pools.of(training, training.whole)
        self.validation = validation.take((validation.labels != AMBIGUOUS).nonzero()[:, 0])
        self.trainer = Trainer(config, self.device, network)

    def step(self, generator: torch.Generator) -> dict[str, float]:
        """One update; windows that end in true frames have the label of all 3 s."""
        config, training = self.config, self.training
        true = config.true_windows
        whole = self.by_whole.draw(true, config.idle, generator)
        seen = self.by_seen.draw(config.batch - true, config.idle, generator)
        labels = torch.cat([training.whole[whole], training.labels[seen]])
        frames = training.frames(torch.cat([whole, seen]))
        observed = augment(*frames, config.augmentation, generator)[0].to(self.device)
        expected = self._expected(observed[true:, :SEEN_FRAMES], generator)
        motion = torch.cat([observed[:true], expected])[:, : config.network.frames]
        return self.trainer.step(motion, labels.to(self.device), generator)

    @torch.no_grad()
    def _expected(self, seen: torch.Tensor, generator: torch.Generator) -> torch.Tensor:
        """Seen frames (B, 25, 9, 3) and what is expected to follow: (B, 75, 9, 3)."""
        future = hold_last(seen)
        if self.config.futures == "predicted":
            draw = torch.rand(len(seen), generator=generator).to(self.device)
            is_held = (draw < self.config.last_frame)[:, None, None, None]
            future = torch.where(is_held, future, self.predictor(seen))
        return torch.cat([seen, future], dim=1)

    def validate(self) -> dict[str, float]:
        """Balanced loss, which is the score, and balanced accuracy."""
        network = self.trainer.updater.ema.network
        logits = window_logits(network, self.predictor, self.validation, self.config, self.device)
        loss = balanced_loss(logits, self.validation.labels)
        accuracy = balanced_accuracy(logits, self.validation.labels)
        return {"score": loss, "validation_loss": loss, "validation_accuracy": accuracy}

    def best(self) -> dict[str, Any]:
        """The averaged weights."""
        return self.trainer.updater.best()

    def state(self) -> dict[str, Any]:
        """Everything that a resumed run needs."""
        return self.trainer.updater.state()

    def load(self, state: Mapping[str, Any]) -> None:
        """Go on from :meth:`state`."""
        self.trainer.updater.load(state)


def train(
    config: TrainConfig,
    run: Run,
    training: WindowSet,
    validation: WindowSet,
    predictor: nn.Module,
    network: Classifier | None = None,
) -> None:
    """Train a classifier; the checkpoint with the lowest balanced validation loss is the best.

    Args:
        config: What to do.
        run: Where to keep checkpoints; a run that was begun is gone on with.
        training: Windows with labels; ambiguous ones are left out.
        validation: Windows of other people.
        predictor: Frozen.
        network: What to start from; weights that need no gradient stay as they are. None starts
            afresh.
    """
    torch.manual_seed(run.info["seed"])
    learner = ClassifierLearner(config, training, validation, predictor, network)
    fit("interformer", learner, run, config.steps, config.validate_every)


def load_classifier(folder: Path) -> Classifier:
    """The best network of a run, ready to evaluate."""
    network = Classifier(NetworkConfig(**read_info(folder)["config"]["network"]))
    network.load_state_dict(read_best(folder)["network"])
    return network.eval()
