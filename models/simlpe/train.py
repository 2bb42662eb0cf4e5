"""Training of siMLPe."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch

from models.ops.losses import joint_distance
from models.simlpe.config import NetworkConfig, TrainConfig
from models.simlpe.network import SiMlpe
from models.training.errors import validation_errors
from models.training.fit import fit, training_device
from models.training.run import Run, read_best, read_info
from models.training.schedule import warm_cosine
from models.training.source import Source, make_source
from models.training.updater import Updater


class SiMlpeLearner:
    """One network and what updates it."""

    def __init__(self, config: TrainConfig, source: Source) -> None:
        self.config, self.source = config, source
        self.device = training_device()
        self.network = SiMlpe(config.network, config.half).to(self.device)
        family = torch.optim.AdamW if config.drop_at is None else torch.optim.Adam
        self.optimizer = family(
            self.network.parameters(), config.learning_rate, weight_decay=config.weight_decay
        )
        self.updater = Updater(
            self.network, self.optimizer, self._rate, ema=config.ema, clip=config.clip
        )

    def _rate(self, step: int) -> float:
        config = self.config
        if config.drop_at is None:
            return warm_cosine(step, config.steps)
        return 1.0 if step <= config.drop_at else config.last_rate / config.learning_rate

    def step(self, generator: torch.Generator) -> dict[str, float]:
        """One update on the first pass."""
        windows = self.source.draw(self.config.batch, generator)
        true = windows.future[:, : self.config.network.step].to(self.device)
        self.network.train()
        predicted = self.network.one_pass(windows.seen.to(self.device).flatten(2))
        predicted = predicted.unflatten(2, true.shape[2:])
        position = joint_distance(predicted, true)
        velocity = joint_distance(predicted.diff(dim=1), true.diff(dim=1))
        self.updater.apply(position + velocity)
        return {"position": float(position.detach()), "velocity": float(velocity.detach())}

    def validate(self) -> dict[str, float]:
        """Errors in mm by name, and the score."""
        return validation_errors(self.updater.ema.network, self.source.validation, self.device)

    def best(self) -> dict[str, Any]:
        """The averaged weights."""
        return self.updater.best()

    def state(self) -> dict[str, Any]:
        """Everything that a resumed run needs."""
        return self.updater.state()

    def load(self, state: Mapping[str, Any]) -> None:
        """Go on from :meth:`state`."""
        self.updater.load(state)


def train(config: TrainConfig, run: Run, data: Path, cache: Path) -> None:
    """Train siMLPe. Half of the windows run backwards, the published augmentation.

    Args:
        config: What to do.
        run: Where to keep checkpoints; a run that was begun is gone on with.
        data: Folder that holds the set folders.
        cache: Folder of generated recordings.
    """
    seen, sequences = config.network.seen, config.synthetic_sequences
    source = make_source(config.data, seen, data, cache, sequences=sequences, vary=False)
    train_on(config, run, source)


def train_on(config: TrainConfig, run: Run, source: Source) -> None:
    """The same, on windows of any source."""
    torch.manual_seed(run.info["seed"])
    fit("simlpe", SiMlpeLearner(config, source), run, config.steps, config.validate_every)


def load_simlpe(folder: Path) -> SiMlpe:
    """The best network of a run, ready to evaluate."""
    network = SiMlpe(NetworkConfig(**read_info(folder)["config"]["network"]))
    network.load_state_dict(read_best(folder)["network"])
    return network.eval()
