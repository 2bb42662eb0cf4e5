"""Training of the generator: on true reactions, and on poses that it has made itself."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch
import torch.nn.functional as F
from torch import nn

from models.data.interactions import INTERACTION_SETS, Pairs, vary
from models.data.layouts import KINECT15
from models.interformer.generator.config import NetworkConfig, TrainConfig
from models.interformer.generator.generate import TorchCore, generate
from models.interformer.generator.network import Generator, Memory, Written, steps_of
from models.training.fit import fit, training_device
from models.training.run import Run, read_best, read_info
from models.training.schedule import warm_cosine
from models.training.updater import Updater

LARGEST_GRADIENT = 1.0


class Posterior(nn.Module):
    """What noise a true reaction would have come from; training alone needs it.

    Kingma and Welling, "Auto-Encoding Variational Bayes" (ICLR 2014).
    """

    def __init__(self, config: NetworkConfig, width: int = 64) -> None:
        super().__init__()
        self.each = nn.Sequential(nn.Linear(6 * config.joints, width), nn.ReLU())
        self.out = nn.Linear(width, 2 * config.latent)

    def forward(
        self, reaction: torch.Tensor, mask: torch.Tensor
    ) -> tuple[torch.Tensor, torch.Tensor]:
        """(B, T, J, 3), (B, T) -> mean and log-variance, each (B, latent)."""
        both = torch.cat([reaction - reaction[:, :1], 8 * steps_of(reaction)], dim=-1)
        share = mask / mask.sum(1, keepdim=True)
        pooled = (self.each(both.flatten(2)) * share[..., None]).sum(1)
        mean, logvar = self.out(pooled).chunk(2, dim=-1)
        return mean, logvar


class Learner(nn.Module):
    """Generator and posterior, and what updates them."""

    def __init__(self, config: TrainConfig, training: Pairs, validation: Pairs | None) -> None:
        super().__init__()
        self.config, self.training_pairs, self.validation = config, training, validation
        self.device = training_device()
        self.network = Generator(config.network).to(self.device)
        self.posterior = Posterior(config.network).to(self.device)
        self.model = nn.ModuleDict({"generator": self.network, "posterior": self.posterior})
        self.optimizer = torch.optim.AdamW(
            self.model.parameters(),
            config.learning_rate,
            weight_decay=config.weight_decay,
            fused=True,
        )
        self.updater = Updater(
            self.model,
            self.optimizer,
            lambda step: warm_cosine(step, config.steps, 40),
            ema=config.ema,
            clip=LARGEST_GRADIENT,
        )
        self.batch: Pairs | None = None
        self.made, self.used = torch.empty(0), 0
        spec = INTERACTION_SETS[config.data]
        self.swap = (
            torch.tensor([label in spec.symmetric for label in spec.labels])
            if config.swap
            else None
        )

    def step(self, generator: torch.Generator) -> dict[str, float]:
        """One update."""
        config = self.config
        if self.batch is None or self.used == config.uses:
            drawn = self.training_pairs.draw(config.batch, generator)
            self.batch = vary(drawn, generator, config.scale, self.swap).to(self.device)
            first = self.batch.reaction[:, :1]
            self.made, self.used = first.expand_as(self.batch.reaction), 0
        self.used += 1
        pairs, reaction = self.batch, self.batch.reaction
        self.model.train()
        mean, logvar = self.posterior(reaction, pairs.mask)
        white = torch.randn(mean.shape, generator=generator).to(self.device)
        noise = mean + white * (0.5 * logvar).exp()
        memory = self.network.encode(pairs.action, pairs.lengths)
        given = self._given(reaction, generator)
        kind = self._kind(pairs, memory, generator)
        written = self.network.decode(given, noise, kind, memory)
        self.made = torch.cat([reaction[:, :1], written.pose[:, :-1].detach()], dim=1)
        terms = reaction_terms(written, pairs)
        terms["kind"] = F.cross_entropy(memory.kind, pairs.labels, label_smoothing=0.05)
        terms["divergence"] = 0.5 * (mean.square() + logvar.exp() - 1 - logvar).sum(-1).mean()
        loss = terms["position"] + sum(
            getattr(config, name) * value for name, value in terms.items() if name != "position"
        )
        self.updater.apply(loss)
        return {name: float(value.detach()) for name, value in terms.items()}

    def _kind(self, pairs: Pairs, memory: Memory, generator: torch.Generator) -> torch.Tensor:
        """What the decoder is told of the kind: half of the time the truth, else the encoder's."""
        true = F.one_hot(pairs.labels, self.config.network.classes).float()
        found = torch.softmax(memory.kind.detach(), dim=-1)
        tells = torch.rand(len(pairs), 1, generator=generator) < 0.5
        return torch.where(tells.to(self.device), true, found)

    def _given(self, reaction: torch.Tensor, generator: torch.Generator) -> torch.Tensor:
        """What the decoder is given: true poses, those it made before, and all a little off.

        Were it given true poses alone, it would learn to repeat them, and stand still by itself.
        """
        size, frames = reaction.shape[:2]
        own = torch.rand(size, frames, generator=generator)
        own = own < 2 * torch.rand(size, 1, generator=generator)
        given = torch.where(own.to(reaction.device)[:, :, None, None], self.made, reaction)
        off = torch.randn(size, frames, 1, 3, generator=generator)
        off = off + torch.randn(reaction.shape, generator=generator)
        return given + (self.config.noise_m * off).to(reaction.device)

    @torch.no_grad()
    def validate(self) -> dict[str, float]:
        """Mean joint distance in mm of whole generated reactions to people held out.

        Where nobody is held out, the last network is the best: its length was chosen before.
        """
        if self.validation is None:
            return {"score": -float(self.updater.ema.updates)}
        error = rollout_error(self.updater.ema.network.get_submodule("generator"), self.validation)
        return {"score": error}

    def best(self) -> dict[str, Any]:
        """The averaged weights of the generator."""
        return {"network": self.updater.ema.network.get_submodule("generator").state_dict()}

    def state(self) -> dict[str, Any]:
        """Everything that a resumed run needs."""
        return self.updater.state()

    def load(self, state: Mapping[str, Any]) -> None:
        """Go on from :meth:`state`."""
        self.updater.load(state)


def reaction_terms(written: Written, pairs: Pairs) -> dict[str, torch.Tensor]:
    """The losses of a batch.

    Squares, as in the paper: with distances, whose best guess is a median, nobody moves at first.
    """
    reaction, mask = pairs.reaction, pairs.mask
    pose, true, later = written.pose[:, :-1], reaction[:, 1:], mask[:, 1:].float()
    steps = torch.cat([reaction[:, :1], pose], dim=1).diff(dim=1) - reaction.diff(dim=1)

    def mean(each: torch.Tensor) -> torch.Tensor:
        return (each.mean(-1) * later).sum() / later.sum()

    ends = F.one_hot(pairs.lengths - 1, mask.shape[1]).float()
    stops = F.binary_cross_entropy_with_logits(written.stop, ends, reduction="none")
    return {
        "position": mean((pose - true).square().sum(-1)),
        "velocity": mean(steps.square().sum(-1)),
        "first": steps[:, 0].square().sum(-1).mean(),
        "bones": mean((bone_lengths(pose) - bone_lengths(true)).square()),
        "stop": (stops * mask).sum() / len(mask),
    }


def bone_lengths(pose: torch.Tensor) -> torch.Tensor:
    """(..., 15, 3) -> (..., 14), metres."""
    bones = torch.tensor(KINECT15.bones, device=pose.device)
    along = pose[..., bones[:, 0], :] - pose[..., bones[:, 1], :]
    return (along.square().sum(-1) + 1e-8).sqrt()


@torch.no_grad()
def rollout_error(network: nn.Module, pairs: Pairs) -> float:
    """Mean joint distance in mm of expected reactions, over the true frames."""
    reaction = react(network, pairs)[0]
    frames = min(reaction.shape[1], pairs.reaction.shape[1])
    off = (reaction[:, :frames] - pairs.reaction[:, :frames]).norm(dim=-1).mean(-1)
    mask = pairs.mask[:, :frames]
    return 1000 * float((off * mask).sum() / mask.sum())


def react(
    network: nn.Module, pairs: Pairs, noise: torch.Tensor | None = None
) -> tuple[torch.Tensor, torch.Tensor]:
    """Reactions to the actions of ``pairs`` from their first poses, and their lengths."""
    assert isinstance(network, Generator)  # noqa: S101 - narrows the type
    config = network.config
    if noise is None:
        noise = torch.zeros(len(pairs), config.latent)
    return generate(
        TorchCore(network.cpu()),
        pairs.action,
        pairs.lengths,
        pairs.reaction[:, :1],
        noise,
        longest_of(pairs, config.frames),
    )


def longest_of(pairs: Pairs, frames: int) -> int:
    """Frames after which a reaction that does not end is cut: a quarter more than the action's."""
    return min(frames, int(1.25 * int(pairs.lengths.max())) + 1)


def train_on(
    config: TrainConfig, run: Run, training: Pairs, validation: Pairs | None = None
) -> None:
    """Train, and keep the network that validation likes best, or the last one without any."""
    torch.manual_seed(run.info["seed"])
    learner = Learner(config, training, validation)
    fit("interformer generator", learner, run, config.steps, config.validate_every)


def train(config: TrainConfig, run: Run, data: Path) -> None:
    """Train on the whole training split of a set.

    Args:
        config: What to do.
        run: Where to keep checkpoints; a run that was begun is gone on with.
        data: Folder that holds the set folders.
    """
    spec = INTERACTION_SETS[config.data]
    train_on(config, run, Pairs.of(spec.read(data, "train"), spec.labels))


def load_generator(folder: Path) -> Generator:
    """The network of a run, ready to generate."""
    network = Generator(NetworkConfig(**read_info(folder)["config"]["network"]))
    network.load_state_dict(read_best(folder)["network"])
    return network.eval()
