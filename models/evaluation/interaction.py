"""Reactions measured: does a judge of real ones take them for what they should be?

The protocol of the InterFormer paper: the action and the first pose of the reaction are given, the
rest is generated for as long as the action lasts, and a recurrent classifier that was trained on
real reactions of the training split sees the reaction alone. By how much a reaction's own end is
off is a figure of its own. The test sets are small, 30 and 28 interactions.
"""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch

from models.data.interactions import Interaction, InteractionSet, Pairs, held
from models.evaluation.motion_sets import diversity_score, frechet_distance
from models.evaluation.recurrent import JudgeConfig, RecurrentClassifier, judged, train_judge

React = Callable[[Pairs, int], tuple[torch.Tensor, torch.Tensor]]
"""Pairs whose reactions are known by their first pose, a seed -> reactions and lengths."""
JUDGES = 3
"""Classifiers, alike but for their seed; every figure is their mean."""
DRAWS = 3
"""Times that all reactions are drawn anew."""
PUBLISHED: dict[str, dict[str, Any]] = {
    "sbu": {
        "accuracy": 0.800,
        "real_accuracy": 0.900,
        "diversity_score": 0.9,
        "rows_accuracy": {"S1": 0.533, "S4": 0.800},
    },
    "k3hi": {
        "accuracy": 0.464,
        "real_accuracy": 0.679,
        "diversity_score": 13.7,
        "rows_accuracy": {"S1": 0.143, "S2": 0.286, "S3": 0.429, "S4": 0.464},
    },
}
"""What the paper reports; its judge is another network, trained on the same split."""


@dataclass(frozen=True, slots=True)
class Court:
    """A test set with those who judge reactions to its actions.

    Attributes:
        spec: The data set.
        test: Interactions that nothing was trained on.
        judges: Classifiers of real reactions.
    """

    spec: InteractionSet
    test: Pairs
    judges: tuple[RecurrentClassifier, ...]

    @classmethod
    def of(
        cls,
        spec: InteractionSet,
        training: Sequence[Interaction],
        test: Sequence[Interaction],
        folder: Path,
    ) -> "Court":
        """Train the judges, or take them from ``folder`` where they have been trained before."""
        pairs = Pairs.of(training, spec.labels)
        names = "\n".join(sorted(one.name for one in training))
        judges = tuple(judge_of(spec, pairs, names, seed, folder) for seed in range(JUDGES))
        return cls(spec, Pairs.of(test, spec.labels), judges)

    @classmethod
    def thesis(cls, spec: InteractionSet, data: Path, folder: Path) -> "Court":
        """The thesis's split of a set."""
        return cls.of(spec, spec.read(data, "train"), spec.read(data, "test"), folder)

    def measure(self, react: React) -> dict[str, Any]:
        """All figures of a generator, each the mean over judges and draws."""
        found, apart, errors = [], [], []
        for seed in range(DRAWS):
            reaction, lengths = react(self.test, seed)
            made = self.test.with_reactions(as_long(reaction, self.test), self.test.lengths)
            found += [self._judged(judge, made) for judge in self.judges]
            apart.append((lengths - self.test.lengths).abs().float().mean())
            errors.append(position_error_mm(made, self.test))
        return {
            **self._summary(found),
            "frechet_distance": mean_of([row["frechet"] for row in found], 2),
            "diversity_score": mean_of([row["diversity"] for row in found], 1),
            "error_mm": mean_of(errors, 1),
            "length_error_frames": mean_of(apart, 2),
        }

    def real(self) -> dict[str, Any]:
        """What the judges make of the true reactions."""
        return self._summary([self._judged(judge, self.test) for judge in self.judges])

    def _summary(self, found: Sequence[dict[str, Any]]) -> dict[str, Any]:
        return {
            "accuracy": mean_of([row["accuracy"] for row in found]),
            "by_class": {
                label: mean_of([row["by_class"][at] for row in found])
                for at, label in enumerate(self.spec.labels)
                if bool((self.test.labels == at).any())
            },
        }

    def _judged(self, judge: RecurrentClassifier, made: Pairs) -> dict[str, Any]:
        given, true = judged(judge, made), judged(judge, self.test)
        right = (given["guess"] == made.labels).float()
        features, real = (each["features"].double().numpy() for each in (given, true))
        return {
            "accuracy": float(right.mean()),
            "by_class": [
                float(right[made.labels == at].mean()) for at in range(len(self.spec.labels))
            ],
            "frechet": frechet_distance(features, real),
            "diversity": diversity_score(features, real),
        }


def stand_still(pairs: Pairs, seed: int) -> tuple[torch.Tensor, torch.Tensor]:
    """The baseline: the first pose, for as long as the action lasts."""
    return pairs.reaction[:, :1].expand_as(pairs.reaction), pairs.lengths


def position_error_mm(made: Pairs, true: Pairs) -> float:
    """Mean distance of generated and true joints over the true frames, mm."""
    off = (made.reaction - true.reaction).norm(dim=-1).mean(-1)
    return 1000 * float((off * true.mask).sum() / true.mask.sum())


def as_long(reaction: torch.Tensor, true: Pairs) -> torch.Tensor:
    """Reactions (B, T, 15, 3) with as many frames as the true ones, by repeating the last pose."""
    return held(reaction, true.reaction.shape[1])


def judge_of(
    spec: InteractionSet, pairs: Pairs, names: str, seed: int, folder: Path, people: int = 1
) -> RecurrentClassifier:
    """Train a judge, or take it from ``folder`` where it has been trained before.

    Args:
        spec: The data set.
        pairs: Real interactions to train on.
        names: Theirs, by which a judge is found again.
        seed: Of everything random.
        folder: Where judges are kept.
        people: 1 for one who sees reactions, 2 for one who sees both people.
    """
    config = JudgeConfig()
    key = hashlib.sha256(f"{config}\n{names}".encode()).hexdigest()[:12]
    kind = "judge" if people == 1 else "pair_judge"
    path = folder / f"{kind}_{spec.name}_{key}_{seed}.pt"
    classes = len(spec.labels)
    if path.exists():
        judge = RecurrentClassifier(config, classes, people)
        judge.load_state_dict(torch.load(path, weights_only=True))
        return judge.eval()
    swap = torch.tensor([label in spec.symmetric for label in spec.labels])
    judge = train_judge(pairs, classes, seed, swap, config, people)
    folder.mkdir(parents=True, exist_ok=True)
    torch.save(judge.state_dict(), path)
    return judge


def mean_of(values: Sequence[Any], digits: int = 3) -> float:
    """The mean, rounded."""
    return round(float(np.mean(values)), digits)
