"""Training of the denoiser: a true interaction, a random step of noise, and what was there."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch

from models.bigraphdiff.config import NetworkConfig, TrainConfig
from models.bigraphdiff.diffusion import Normaliser, both_of, noised, signal
from models.bigraphdiff.network import Denoiser
from models.bigraphdiff.words import tokens
from models.data.interaction_sets import two_person_set
from models.data.interactions import Pairs, vary
from models.training.fit import fit, training_device
from models.training.run import Run, read_best, read_info
from models.training.schedule import warm_cosine
from models.training.updater import Updater

LARGEST_GRADIENT = 1.0


class Learner:
    """The network with what updates it."""

    def __init__(self, config: TrainConfig, training: Pairs) -> None:
        self.config = config
        self.device = training_device()
        spec = two_person_set(config.data)
        self.pairs, self.tokens = training, tokens(spec.labels)
        self.swap = torch.tensor([label in spec.symmetric for label in spec.labels])
        self.normaliser = Normaliser.of(training)
        self.left = signal(config.network.steps)
        self.network = Denoiser(config.network).to(self.device)
        optimizer = torch.optim.AdamW(
            self.network.parameters(), config.learning_rate, weight_decay=config.weight_decay
        )
        self.updater = Updater(
            self.network,
            optimizer,
            lambda step: warm_cosine(step, config.steps, 50),
            ema=config.ema,
            clip=LARGEST_GRADIENT,
        )

    def step(self, generator: torch.Generator) -> dict[str, float]:
        """One update."""
        config = self.config
        drawn = self.pairs.draw(config.batch, generator)
        pairs = vary(drawn, generator, config.scale, self.swap).head(config.network.frames)
        clean = self.normaliser.into(both_of(pairs))
        noise = torch.randn(clean.shape, generator=generator)
        steps = config.network.steps
        step = torch.randint(steps, (len(pairs),), generator=generator)
        is_led = config.network.guidance != 1
        if is_led:
            high = steps - 1 - torch.randint(steps // 5, (len(pairs),), generator=generator)
            chosen = torch.rand(len(pairs), generator=generator) < config.noisiest
            step = torch.where(chosen, high, step)
        if not config.network.diffusion:
            step = torch.full_like(step, steps - 1)
        given = noised(clean, noise, step, self.left)
        self.network.train()
        words = self.tokens[pairs.labels]
        if is_led:
            kept = torch.rand(len(pairs), 1, generator=generator) >= config.hidden
            words = words * kept
        found = self.network(
            *(each.to(self.device) for each in (given, pairs.lengths, step, words))
        )
        terms = error_terms(found, clean.to(self.device), pairs.mask.to(self.device))
        self.updater.apply(terms["motion"] + config.velocity * terms["velocity"])
        return {name: float(value.detach()) for name, value in terms.items()}

    def validate(self) -> dict[str, float]:
        """Nobody is held out: the last averaged network is kept, after a number fixed before."""
        return {"score": -float(self.updater.ema.updates)}

    def best(self) -> dict[str, Any]:
        """The averaged weights, and how motions are scaled."""
        scale = {"mean": self.normaliser.mean, "deviation": self.normaliser.deviation}
        return {**self.updater.best(), **scale}

    def state(self) -> dict[str, Any]:
        """Everything that a resumed run needs."""
        return self.updater.state()

    def load(self, state: Mapping[str, Any]) -> None:
        """Go on from :meth:`state`."""
        self.updater.load(state)


def error_terms(
    found: torch.Tensor, clean: torch.Tensor, mask: torch.Tensor
) -> dict[str, torch.Tensor]:
    """Mean squares of what is off in motions (B, 2, T, J, 3), and in their steps, where they count.

    Args:
        found: By the network.
        clean: The truth.
        mask: Shape (B, T).
    """
    off = found - clean
    counts, later = mask[:, None].float(), mask[:, None, 1:].float()
    each = off.square().mean(dim=(-2, -1))
    steps = off.diff(dim=2).square().mean(dim=(-2, -1))
    return {
        "motion": (each * counts).sum() / (2 * counts.sum()),
        "velocity": (steps * later).sum() / (2 * later.sum()),
    }


def train_on(config: TrainConfig, run: Run, training: Pairs) -> None:
    """Train, and keep the last averaged network."""
    torch.manual_seed(run.info["seed"])
    fit("bigraphdiff", Learner(config, training), run, config.steps, config.save_every)


def train(config: TrainConfig, run: Run, data: Path) -> None:
    """Train on the whole training split of a set.

    Args:
        config: What to do.
        run: Where to keep checkpoints; a run that was begun is gone on with.
        data: Folder that holds the set folders.
    """
    spec = two_person_set(config.data)
    train_on(config, run, Pairs.of(spec.read(data, "train"), spec.labels))


def load_denoiser(folder: Path) -> tuple[Denoiser, Normaliser]:
    """The network of a run, ready to draw, and how its motions are scaled."""
    network = Denoiser(NetworkConfig(**read_info(folder)["config"]["network"]))
    best = read_best(folder)
    network.load_state_dict(best["network"])
    return network.eval(), Normaliser(best["mean"], best["deviation"])
