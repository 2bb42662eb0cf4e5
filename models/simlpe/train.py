"""Training of siMLPe."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch
from torch import nn

from models.data.clips import Clips, reverse_some
from models.data.sets import motion_set
from models.ops.losses import joint_distance
from models.simlpe.config import NetworkConfig, TrainConfig
from models.simlpe.network import SiMlpe
from models.training.ema import Ema
from models.training.fit import fit, training_device
from models.training.run import Run, read_best, read_info
from models.training.schedule import warm_cosine

VALIDATION_STRIDE = 40
VALIDATION_BATCH = 512


@torch.no_grad()
def mean_error(network: nn.Module, windows: torch.Tensor, seen: int) -> float:
    """Mean joint distance over all future frames of windows (N, T, J, 3), in mm."""
    device = next(network.parameters()).device
    total = 0.0
    for part in windows.split(VALIDATION_BATCH):
        future = network(part[:, :seen].to(device)).cpu()
        total += float((future - part[:, seen:]).norm(dim=-1).mean(dim=(1, 2)).sum())
    return 1000 * total / len(windows)


class SiMlpeLearner:
    """One network and what updates it."""

    def __init__(self, config: TrainConfig, training: Clips, validation: torch.Tensor) -> None:
        self.config, self.training, self.validation = config, training, validation
        self.device = training_device()
        self.network = SiMlpe(config.network, config.half).to(self.device)
        self.ema = Ema(self.network, config.ema)
        family = torch.optim.AdamW if config.drop_at is None else torch.optim.Adam
        self.optimizer = family(
            self.network.parameters(), config.learning_rate, weight_decay=config.weight_decay
        )
        self.schedule = torch.optim.lr_scheduler.LambdaLR(self.optimizer, self._rate)

    def _rate(self, step: int) -> float:
        config = self.config
        if config.drop_at is None:
            return warm_cosine(step, config.steps)
        return 1.0 if step <= config.drop_at else config.last_rate / config.learning_rate

    def step(self, generator: torch.Generator) -> dict[str, float]:
        """One update on windows of which half run backwards (the published augmentation)."""
        shape = self.config.network
        motion = reverse_some(self.training.draw(self.config.batch, generator), generator)
        motion = motion.to(self.device)
        true = motion[:, shape.seen : shape.seen + shape.step]
        self.network.train()
        predicted = self.network.one_pass(motion[:, : shape.seen].flatten(2))
        predicted = predicted.unflatten(2, true.shape[2:])
        position = joint_distance(predicted, true)
        velocity = joint_distance(predicted.diff(dim=1), true.diff(dim=1))
        self.optimizer.zero_grad(set_to_none=True)
        torch.autograd.backward(position + velocity)
        nn.utils.clip_grad_norm_(self.network.parameters(), self.config.clip)
        self.optimizer.step()
        self.schedule.step()
        self.ema.update(self.network)
        return {"position": float(position.detach()), "velocity": float(velocity.detach())}

    def validate(self) -> dict[str, float]:
        """Mean joint distance over the future."""
        return {"score": mean_error(self.ema.network, self.validation, self.config.network.seen)}

    def best(self) -> dict[str, Any]:
        """The averaged weights."""
        return {"network": self.ema.network.state_dict()}

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


def train(config: TrainConfig, run: Run, data: Path) -> None:
    """Train siMLPe.

    Args:
        config: What to do.
        run: Where to keep checkpoints; a run that was begun is gone on with.
        data: Folder that holds the set folders.
    """
    torch.manual_seed(run.info["seed"])
    seen = config.network.seen
    motions = motion_set(config.data)
    learner = SiMlpeLearner(
        config,
        motions.clips(data, "train", seen),
        motions.clips(data, "validation", seen, VALIDATION_STRIDE).all(),
    )
    fit("simlpe", learner, run, config.steps, config.validate_every)


def load_simlpe(folder: Path) -> SiMlpe:
    """The best network of a run, ready to evaluate."""
    network = SiMlpe(NetworkConfig(**read_info(folder)["config"]["network"]))
    network.load_state_dict(read_best(folder)["network"])
    return network.eval()
