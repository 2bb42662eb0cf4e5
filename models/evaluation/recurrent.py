"""The judge of generated reactions: a recurrent classifier that knows real ones.

After DeepGRU (Maghoumi and LaViola, "DeepGRU: Deep Gesture Recognition Utility", ISVC 2019), which
the InterFormer paper uses, and smaller. It sees the reaction and
nothing of the action, or the motion of both people.
"""

from dataclasses import dataclass
from typing import Any

import torch
import torch.nn.functional as F
from torch import nn

from models.data.interactions import JOINTS, Pairs, vary
from models.evaluation.varied import vary_bodies, vary_pace
from models.training.brief import train_briefly

VELOCITY_SCALE = 8.0
WARM = 20
"""Updates in which the rate rises."""


@dataclass(frozen=True, slots=True)
class JudgeConfig:
    """How a judge is made.

    Attributes:
        width: Units of the first recurrent layers; the last has half of them.
        features: Numbers that distances of sets of motions are measured on.
        dropout: Share of units left out in training.
        steps: Updates.
        batch: Reactions an update.
        learning_rate: Peak rate.
        weight_decay: Of all weights.
        balance: How much rare classes are drawn more often: 0 as they come, 1 all alike.
        pace: Largest change of a reaction's length, as a share.
        limbs: Deviation of the length of a bone, as a share.
        turn: Largest turn about the vertical, radians.
    """

    width: int = 96
    features: int = 64
    dropout: float = 0.4
    steps: int = 500
    batch: int = 64
    learning_rate: float = 3e-3
    weight_decay: float = 0.01
    balance: float = 0.5
    pace: float = 0.2
    limbs: float = 0.08
    turn: float = 0.3


class RecurrentClassifier(nn.Module):
    """Motion of one person, or of two -> logits, by way of features.

    Args:
        config: Its shape.
        classes: How many.
        people: 1 to see reactions, 2 to see both people.
    """

    def __init__(self, config: JudgeConfig, classes: int, people: int = 1) -> None:
        super().__init__()
        self.people = people
        width, narrow = config.width, config.width // 2
        self.first = nn.GRU(6 * JOINTS * people, width, batch_first=True)
        self.second = nn.GRU(width, narrow, batch_first=True)
        self.attend = nn.Linear(narrow, narrow, bias=False)
        self.drop_in = nn.Dropout(0.1)
        self.dropout = nn.Dropout(config.dropout)
        self.describe = nn.Linear(2 * narrow, config.features)
        self.head = nn.Linear(config.features, classes)

    def describe_motion(self, motion: torch.Tensor, lengths: torch.Tensor) -> torch.Tensor:
        """Motion (B, T, 15 * people, 3), metres, in the pair's frame; lengths (B,) -> (B, F)."""
        steps = torch.cat([motion[:, :1] * 0.0, motion.diff(dim=1)], dim=1) * VELOCITY_SCALE
        x = self.drop_in(torch.cat([motion, steps], dim=-1).flatten(2))
        states, _ = self.second(self.first(x)[0])
        last = states[torch.arange(len(x)), lengths - 1]
        outside = torch.arange(states.shape[1]) >= lengths[:, None]
        scores = (self.attend(states) @ last[..., None])[..., 0]
        weights = torch.softmax(scores.masked_fill(outside, -1e9), dim=1)
        context = (weights[:, None] @ states)[:, 0]
        both = self.dropout(torch.cat([context, last], dim=-1))
        described: torch.Tensor = self.describe(both)
        return described

    def sees(self, pairs: Pairs) -> torch.Tensor:
        """What it looks at, (B, T, 15 * people, 3)."""
        if self.people == 1:
            return pairs.reaction
        return torch.cat([pairs.action, pairs.reaction], dim=2)

    def forward(self, motion: torch.Tensor, lengths: torch.Tensor) -> torch.Tensor:
        """Motion (B, T, 15 * people, 3), lengths (B,) -> logits (B, classes)."""
        logits: torch.Tensor = self.head(
            self.dropout(torch.relu(self.describe_motion(motion, lengths)))
        )
        return logits


def train_judge(
    pairs: Pairs,
    classes: int,
    seed: int,
    swap: torch.Tensor | None,
    config: JudgeConfig | None = None,
    people: int = 1,
) -> RecurrentClassifier:
    """Train a judge on real interactions.

    Args:
        pairs: The training split, and nothing else.
        classes: How many.
        seed: Of everything random.
        swap: Shape (classes,), which classes may have the people change places.
        config: How.
        people: 1 for one who sees reactions, 2 for one who sees both people.
    """
    settings = config or JudgeConfig()

    def loss(judge: RecurrentClassifier, generator: torch.Generator) -> torch.Tensor:
        if people == 1:
            batch = _varied(pairs, generator, swap, settings)
        else:  # both in view tell enough apart, and stay as they stand to each other
            batch = vary(pairs.draw(settings.batch, generator), generator, swap=swap)
        logits = judge(judge.sees(batch), batch.lengths)
        return F.cross_entropy(logits, batch.labels, label_smoothing=0.05)

    return train_briefly(
        lambda: RecurrentClassifier(settings, classes, people),
        loss,
        seed,
        steps=settings.steps,
        learning_rate=settings.learning_rate,
        weight_decay=settings.weight_decay,
        warm=WARM,
    )


def _varied(
    pairs: Pairs, generator: torch.Generator, swap: torch.Tensor | None, config: JudgeConfig
) -> Pairs:
    """A random batch of reactions by other bodies, at other paces, with rare labels more often."""
    share = torch.bincount(pairs.labels).float()[pairs.labels] ** -config.balance
    chosen = torch.multinomial(share, config.batch, replacement=True, generator=generator)
    batch = vary(pairs.take(chosen), generator, swap=swap)
    motion = vary_bodies(batch.reaction, generator, config.limbs, config.turn)
    return batch.with_reactions(*vary_pace(motion, batch.lengths, generator, config.pace))


@torch.no_grad()
def judged(judge: RecurrentClassifier, pairs: Pairs) -> dict[str, Any]:
    """Features (N, F) and guessed classes (N,) of what the judge sees."""
    features = judge.describe_motion(judge.sees(pairs), pairs.lengths)
    return {"features": features, "guess": judge.head(torch.relu(features)).argmax(-1)}
