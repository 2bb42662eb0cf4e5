"""The judge of generated reactions: a recurrent classifier that knows real ones.

After DeepGRU (Maghoumi and LaViola, "DeepGRU: Deep Gesture Recognition Utility", ISVC 2019), which
the InterFormer paper uses, and smaller. It sees the reaction, and nothing of the action.
"""

from dataclasses import dataclass
from typing import Any

import torch
import torch.nn.functional as F
from torch import nn

from models.data.interactions import JOINTS, Pairs, vary
from models.training.schedule import warm_cosine

VELOCITY_SCALE = 8.0


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
    """

    width: int = 96
    features: int = 64
    dropout: float = 0.4
    steps: int = 300
    batch: int = 32
    learning_rate: float = 2e-3
    weight_decay: float = 0.01


class RecurrentClassifier(nn.Module):
    """One person's motion -> logits, by way of features.

    Args:
        config: Its shape.
        classes: How many.
    """

    def __init__(self, config: JudgeConfig, classes: int) -> None:
        super().__init__()
        width, narrow = config.width, config.width // 2
        self.first = nn.GRU(6 * JOINTS, width, batch_first=True)
        self.second = nn.GRU(width, narrow, batch_first=True)
        self.attend = nn.Linear(narrow, narrow, bias=False)
        self.drop_in = nn.Dropout(0.1)
        self.dropout = nn.Dropout(config.dropout)
        self.describe = nn.Linear(2 * narrow, config.features)
        self.head = nn.Linear(config.features, classes)

    def describe_motion(self, motion: torch.Tensor, lengths: torch.Tensor) -> torch.Tensor:
        """Motion (B, T, 15, 3), metres, in the frame of the pair; lengths (B,) -> (B, features)."""
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

    def forward(self, motion: torch.Tensor, lengths: torch.Tensor) -> torch.Tensor:
        """Motion (B, T, 15, 3), lengths (B,) -> logits (B, classes)."""
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
) -> RecurrentClassifier:
    """Train a judge on real reactions.

    Args:
        pairs: The training split, and nothing else.
        classes: How many.
        seed: Of everything random.
        swap: Shape (classes,), which classes may have the people change places.
        config: How.
    """
    config = config or JudgeConfig()
    with torch.random.fork_rng():
        torch.manual_seed(seed)
        generator = torch.Generator().manual_seed(seed)
        judge = RecurrentClassifier(config, classes).train()
        optimizer = torch.optim.AdamW(
            judge.parameters(), config.learning_rate, weight_decay=config.weight_decay
        )
        for step in range(config.steps):
            for group in optimizer.param_groups:
                group["lr"] = config.learning_rate * warm_cosine(step, config.steps, 20)
            batch = vary(pairs.draw(config.batch, generator), generator, swap=swap)
            logits = judge(batch.reaction, batch.lengths)
            loss = F.cross_entropy(logits, batch.labels, label_smoothing=0.05)
            optimizer.zero_grad(set_to_none=True)
            torch.autograd.backward(loss)
            nn.utils.clip_grad_norm_(judge.parameters(), 1.0)
            optimizer.step()
    return judge.eval()


@torch.no_grad()
def judged(judge: RecurrentClassifier, pairs: Pairs) -> dict[str, Any]:
    """Features (N, F) and guessed classes (N,) of the reactions."""
    features = judge.describe_motion(pairs.reaction, pairs.lengths)
    return {"features": features, "guess": judge.head(torch.relu(features)).argmax(-1)}
