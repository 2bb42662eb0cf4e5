"""What all figures draw from: the outcomes of several models under one protocol."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import RATE_HZ
from models.evaluation.figures.style import colours
from models.evaluation.prediction import Outcome
from models.evaluation.protocols import Protocol

BASELINE = "zero_velocity"
FRAME_MS = 1000 // RATE_HZ


@dataclass(frozen=True, slots=True)
class Comparison:
    """Models side by side.

    Attributes:
        protocol: How they were measured.
        results: Model -> action -> outcome. Titles speak of the first model.
        summaries: Model -> what ``prediction.summary`` says of it.
    """

    protocol: Protocol
    results: dict[str, dict[str, Outcome]]
    summaries: dict[str, dict[str, Any]]

    @property
    def models(self) -> list[str]:
        """All models, the subject first."""
        return list(self.results)

    @property
    def subject(self) -> str:
        """The model that titles speak of."""
        return self.models[0]

    @property
    def actions(self) -> list[str]:
        """All actions."""
        return list(self.results[self.subject])

    @property
    def colours(self) -> dict[str, str]:
        """A colour for each model."""
        return colours(self.models)

    @property
    def future_ms(self) -> list[int]:
        """Time of each predicted frame after the last seen one."""
        return [FRAME_MS * (frame + 1) for frame in range(self.protocol.future)]

    @property
    def furthest_ms(self) -> int:
        """The last horizon."""
        return self.protocol.horizons_ms[-1]

    def average(self, model: str, key: str) -> Any:
        """A figure of a model, averaged over the actions."""
        return self.summaries[model]["average"][key]

    def window_errors(self, action: str) -> Float32:
        """Mean joint distance of each window of the subject over the whole future (N,), mm."""
        outcome = self.results[self.subject][action]
        off = np.linalg.norm(outcome.predicted - outcome.true, axis=-1)
        errors: Float32 = off.mean(axis=(1, 2))
        return errors


def typical(errors: Float32) -> int:
    """Index of the median error, the lower one of two."""
    return int(np.argsort(errors, kind="stable")[(len(errors) - 1) // 2])
