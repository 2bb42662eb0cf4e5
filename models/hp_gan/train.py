"""Training of HP-GAN: generator, discriminator and quality network in turn."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch
import torch.nn.functional as F

from models.data.windows import AMBIGUOUS
from models.hp_gan.config import NetworkConfig, TrainConfig
from models.hp_gan.discriminator import Discriminator, whole_features
from models.hp_gan.judge import JUDGED_REAL, Judge
from models.hp_gan.losses import diversity, nearest, physical_terms
from models.hp_gan.network import Generator
from models.hp_gan.source import Named, NamedSource, server_source
from models.ops.losses import gradient_penalty
from models.training.fit import fit, training_device
from models.training.run import Run, read_best, read_info
from models.training.schedule import warm_cosine
from models.training.updater import Updater

LARGEST_GRADIENT = 1.0
DRAWS = 4
"""Futures of each validation window."""
MM = 1000.0


class HpGanLearner:
    """Three networks and what updates them."""

    def __init__(self, config: TrainConfig, source: NamedSource) -> None:
        self.config, self.source = config, source
        self.device = training_device()
        self.generator = Generator(config.network).to(self.device)
        self.critic = Discriminator(config.network).to(self.device)
        self.judge = Judge(config.network).to(self.device)
        self.updater = Updater(
            self.generator,
            torch.optim.Adam(
                self.generator.parameters(), config.learning_rate, betas=(0.5, 0.9), fused=True
            ),
            lambda step: warm_cosine(step, config.steps),
            ema=config.ema,
            clip=LARGEST_GRADIENT,
        )
        self.critic_optimizer = torch.optim.Adam(
            self.critic.parameters(), config.critic_rate, betas=(0.5, 0.9), fused=True
        )
        self.judge_optimizer = torch.optim.Adam(
            self.judge.parameters(), config.judge_rate, fused=True
        )
        self.done = 0

    def step(self, generator: torch.Generator) -> dict[str, float]:
        """One update of the generator and of the quality network, some of the discriminator."""
        drawn = self.source.draw(self.config.batch, generator)
        windows = Named(*(part.to(self.device) for part in drawn))
        fake, terms = self._teach_generator(windows, generator)
        for _ in range(self.config.critic_steps):
            terms |= self._teach_critic(windows, fake, generator)
        terms["judge"] = self._teach_judge(windows, generator)
        self.done += 1
        return {name: float(term.detach()) for name, term in terms.items()}

    def _teach_generator(
        self, windows: Named, generator: torch.Generator
    ) -> tuple[torch.Tensor, dict[str, torch.Tensor]]:
        """Two futures of each window, (2 B, F, J, 3), and the terms they were judged by."""
        config = self.config
        seen, true, labels = (torch.cat([part, part]) for part in windows)
        z = torch.randn(len(seen), config.network.noise, generator=generator).to(self.device)
        future = self.generator(seen, z)
        motion = whole_features(seen, future)
        terms = physical_terms(seen, future, true, self.source.layout.bones)
        terms["diversity"] = diversity(
            future.chunk(2), z.chunk(2), windows.future, windows.seen[:, -1]
        )
        terms["nearest"] = nearest(future.chunk(2), windows.future)
        terms["adversarial"] = -self.critic(motion).mean()
        terms["classes"] = self._class_loss(motion, labels)
        weighted = [getattr(config, name) * term for name, term in terms.items()]
        self.updater.apply(torch.stack(weighted).sum())
        return future.detach(), terms

    def _teach_critic(
        self, windows: Named, fake: torch.Tensor, generator: torch.Generator
    ) -> dict[str, torch.Tensor]:
        """Wasserstein loss with the gradient penalty, and the classes of real motion."""
        half = fake.chunk(2)[0]
        real_motion = whole_features(windows.seen, windows.future)
        fake_motion = whole_features(windows.seen, half)
        gap = self.critic(fake_motion).mean() - self.critic(real_motion).mean()
        penalty = gradient_penalty(self.critic, [real_motion], [fake_motion], generator)
        named = self._class_loss(real_motion, windows.labels)
        self.critic_optimizer.zero_grad(set_to_none=True)
        torch.autograd.backward(gap + self.config.penalty * penalty + named)
        self.critic_optimizer.step()
        return {"critic_gap": gap, "penalty": penalty, "real_classes": named}

    def _class_loss(self, motion: torch.Tensor, labels: torch.Tensor) -> torch.Tensor:
        """Cross-entropy over the windows whose class is known; 0 where none is."""
        known = labels != AMBIGUOUS
        if not known.any():
            return torch.zeros((), device=motion.device)
        return F.cross_entropy(self.critic.classes(motion[known]), labels[known])

    def _teach_judge(self, windows: Named, generator: torch.Generator) -> torch.Tensor:
        """Tell real motion from what the averaged generator gives; the generator learns nothing."""
        with torch.no_grad():
            z = torch.randn(len(windows.seen), self.config.network.noise, generator=generator)
            fake = self.updater.ema.network(windows.seen, z.to(self.device))
        real, made = (self.judge(windows.seen, future) for future in (windows.future, fake))
        loss = 0.5 * (
            F.binary_cross_entropy_with_logits(real, torch.ones_like(real))
            + F.binary_cross_entropy_with_logits(made, torch.zeros_like(made))
        )
        self.judge_optimizer.zero_grad(set_to_none=True)
        torch.autograd.backward(loss)
        self.judge_optimizer.step()
        return loss

    @torch.no_grad()
    def validate(self) -> dict[str, float]:
        """How many futures of validation windows are judged real, and how far off and apart.

        ``score`` is the share that is not; until the quality network has learnt for a while,
        a checkpoint counts as worse than any later one.
        """
        draws = torch.Generator().manual_seed(0)
        rows = [self._measured(held, draws) for held in self.source.validation.values()]
        count = sum(row["windows"] for row in rows)
        mean = {
            name: sum(row[name] * row["windows"] for row in rows) / count
            for name in rows[0]
            if name != "windows"
        }
        young = self.done < self.config.judged_from
        return {"score": 1 - mean["plausible"] + float(young), **mean}

    def _measured(self, held: Named, draws: torch.Generator) -> dict[str, float]:
        network: Any = self.updater.ema.network
        seen, true = held.seen.to(self.device), held.future.to(self.device)
        drawn = network.futures(seen, DRAWS, draws)  # (N, DRAWS, F, J, 3)
        each = seen.repeat_interleave(DRAWS, 0)
        made = self.judge.quality(each, drawn.flatten(0, 1))
        off = (drawn - true[:, None]).norm(dim=-1).mean(dim=(2, 3))
        return {
            "windows": float(len(seen)),
            "plausible": float((made > JUDGED_REAL).float().mean()),
            "real_plausible": float((self.judge.quality(seen, true) > JUDGED_REAL).float().mean()),
            "error_mm": MM * float(off.mean()),
            "best_mm": MM * float(off.min(dim=1).values.mean()),
            "apart_mm": MM * float((drawn[:, :-1] - drawn[:, 1:]).norm(dim=-1).mean()),
        }

    def best(self) -> dict[str, Any]:
        """The averaged generator, and the other two as they are."""
        return {
            **self.updater.best(),
            "critic": self.critic.state_dict(),
            "judge": self.judge.state_dict(),
        }

    def state(self) -> dict[str, Any]:
        """Everything that a resumed run needs."""
        return {
            **self.updater.state(),
            "critic": self.critic.state_dict(),
            "critic_optimizer": self.critic_optimizer.state_dict(),
            "judge": self.judge.state_dict(),
            "judge_optimizer": self.judge_optimizer.state_dict(),
            "done": self.done,
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Go on from :meth:`state`."""
        self.updater.load(state)
        for name in ("critic", "critic_optimizer", "judge", "judge_optimizer"):
            getattr(self, name).load_state_dict(state[name])
        self.done = state["done"]


def train(config: TrainConfig, run: Run, data: Path, cache: Path) -> None:
    """Train on what the server's models are trained on.

    Args:
        config: What to do.
        run: Where to keep checkpoints; a run that was begun is gone on with.
        data: Folder that holds the set folders.
        cache: Folder of generated recordings.
    """
    train_on(config, run, server_source(data, cache, config.synthetic_sequences))


def train_on(config: TrainConfig, run: Run, source: NamedSource) -> None:
    """The same, on windows of any source."""
    torch.manual_seed(run.info["seed"])
    fit("hp_gan", HpGanLearner(config, source), run, config.steps, config.validate_every)


def load_hp_gan(folder: Path) -> tuple[Generator, Discriminator, Judge]:
    """The best networks of a run, ready to evaluate."""
    config = NetworkConfig(**read_info(folder)["config"]["network"])
    state = read_best(folder)
    networks = Generator(config), Discriminator(config), Judge(config)
    for network, name in zip(networks, ("network", "critic", "judge"), strict=True):
        network.load_state_dict(state[name])
        network.eval()
    return networks
