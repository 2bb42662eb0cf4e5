"""Interactions of two people measured: are both taken for what their label says?

The measures of the BiGraphDiff paper on the thesis's splits of SBU and K3HI. For every test
interaction one is drawn with its label and its length; recurrent classifiers that were trained on
real training interactions see the motion of both people.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch

from agent_server.domain.arrays import Float64
from models.data.interactions import InteractionSet, Pairs
from models.evaluation.interaction import DRAWS, JUDGES, judge_of, mean_of
from models.evaluation.motion_sets import diversity_score, frechet_distance, spread
from models.evaluation.recurrent import RecurrentClassifier, judged

Interact = Callable[[torch.Tensor, torch.Tensor, int], Pairs]
"""Labels (B,), lengths (B,) and a seed -> interactions."""


@dataclass(frozen=True, slots=True)
class PairCourt:
    """A test set with those who judge interactions.

    Attributes:
        spec: The data set.
        training: What the judges, and the generators, were trained on.
        test: What nothing was trained on.
        judges: Classifiers of both people's motion.
    """

    spec: InteractionSet
    training: Pairs
    test: Pairs
    judges: tuple[RecurrentClassifier, ...]

    @classmethod
    def of(cls, spec: InteractionSet, data: Path, folder: Path) -> "PairCourt":
        """The splits of a set, with judges that are trained, or taken from ``folder``."""
        interactions = spec.read(data, "train")
        training = Pairs.of(interactions, spec.labels)
        names = "\n".join(sorted(one.name for one in interactions))
        judges = tuple(
            judge_of(spec, training, names, seed, folder, people=2) for seed in range(JUDGES)
        )
        return cls(spec, training, Pairs.of(spec.read(data, "test"), spec.labels), judges)

    def measure(self, interact: Interact) -> dict[str, Any]:
        """All figures of a generator, each the mean over judges and draws."""
        drawn = [interact(self.test.labels, self.test.lengths, seed) for seed in range(DRAWS)]
        found = [self._judged(judge, made) for made in drawn for judge in self.judges]
        nearest = [nearest_mm(made, self.training) for made in drawn]
        return {
            **self._summary(found),
            "frechet_distance": mean_of([row["frechet"] for row in found], 2),
            "diversity_score": mean_of([row["diversity"] for row in found], 1),
            "multimodality_score": mean_of([row["multimodality_score"] for row in found], 1),
            "nearest_training_mm": mean_of(nearest, 1),
        }

    def setting(self) -> dict[str, Any]:
        """What figures of generators are to be compared with."""
        counts = torch.bincount(self.test.labels)
        return {
            "test_interactions": len(self.test),
            "judges": JUDGES,
            "draws": DRAWS,
            "most_frequent_label": mean_of([float(counts.max()) / len(self.test)]),
            "real": {
                **self._summary([self._judged(judge, self.test) for judge in self.judges]),
                "nearest_training_mm": mean_of([nearest_mm(self.test, self.training)], 1),
            },
            "copied": self.measure(self.copied),
        }

    def copied(self, labels: torch.Tensor, lengths: torch.Tensor, seed: int) -> Pairs:
        """The baseline that makes nothing: a real training interaction of the same label."""
        generator = torch.Generator().manual_seed(seed)
        rows = []
        for label in labels.tolist():
            (same,) = torch.where(self.training.labels == label)
            rows.append(int(same[torch.randint(len(same), (), generator=generator)]))
        return self.training.take(torch.tensor(rows))

    def _summary(self, found: Sequence[dict[str, Any]]) -> dict[str, Any]:
        return {
            "accuracy": mean_of([row["accuracy"] for row in found]),
            "by_class": {
                label: mean_of([row["by_class"][at] for row in found])
                for at, label in enumerate(self.spec.labels)
                if bool((self.test.labels == at).any())
            },
            "multimodality": mean_of([row["multimodality"] for row in found], 2),
        }

    def _judged(self, judge: RecurrentClassifier, made: Pairs) -> dict[str, Any]:
        given, true = judged(judge, made), judged(judge, self.test)
        right = (given["guess"] == made.labels).float()
        features, real = (each["features"].double().numpy() for each in (given, true))
        several = multimodality(features, made.labels)
        expected = multimodality(real, self.test.labels)
        return {
            "accuracy": float(right.mean()),
            "by_class": [
                float(right[made.labels == at].mean()) for at in range(len(self.spec.labels))
            ],
            "frechet": frechet_distance(features, real),
            "diversity": diversity_score(features, real),
            "multimodality": several,
            "multimodality_score": 100 * abs(several - expected) / expected,
        }


def multimodality(features: Float64, labels: torch.Tensor) -> float:
    """Mean distance of two different motions of the same label; every label counts alike.

    The published script does not measure this: an index makes it compare every motion with the
    first one of the set.

    Args:
        features: Shape (N, F).
        labels: Shape (N,); a label with a single motion says nothing.
    """
    groups = [features[(labels == label).numpy()] for label in labels.unique()]
    return float(np.mean([spread(group) for group in groups if len(group) > 1]))


def nearest_mm(made: Pairs, training: Pairs) -> float:
    """Mean joint distance to the nearest training interaction, mm: near 0 where they are copies.

    Both people count, over the frames that two interactions have in common.
    """
    frames = min(made.action.shape[1], training.action.shape[1])
    shared = made.mask[:, None, :frames] & training.mask[None, :, :frames]
    apart = torch.stack(
        [
            sum(
                (one - other[:, :frames]).norm(dim=-1).mean(-1)
                for one, other in (
                    (made.action[row, :frames], training.action),
                    (made.reaction[row, :frames], training.reaction),
                )
            )
            / 2
            for row in range(len(made))
        ]
    )
    each = (apart * shared).sum(-1) / shared.sum(-1)
    return 1000 * float(each.min(1).values.mean())
