"""The loop that every training has in common."""

import time
from collections.abc import Mapping
from typing import Any, Protocol

import torch

from models.training.progress import TrainingProgress
from models.training.run import Run


class Learner(Protocol):
    """What a model's own training gives to the loop."""

    def step(self, generator: torch.Generator) -> dict[str, float]:
        """Draw a batch, update once, give the loss terms."""

    def validate(self) -> dict[str, float]:
        """Measure on validation data; ``score`` says how good, and lower is better."""

    def best(self) -> dict[str, Any]:
        """What to keep of a network that validation likes best."""

    def state(self) -> dict[str, Any]:
        """Everything that a resumed run needs, in plain tensors and numbers."""

    def load(self, state: Mapping[str, Any]) -> None:
        """Go on from :meth:`state`."""


def training_device() -> torch.device:
    """The GPU where there is one."""
    return torch.device("cuda" if torch.cuda.is_available() else "cpu")


def fit(title: str, learner: Learner, run: Run, steps: int, validate_every: int) -> None:
    """Train, validate, and keep the checkpoint with the lowest score.

    Args:
        title: What the progress bar says.
        learner: The model's own part.
        run: Where to keep checkpoints; a run that was begun is gone on with.
        steps: Updates in all.
        validate_every: Updates between two validations.
    """
    generator = torch.Generator().manual_seed(run.info["seed"])
    first, best, spent = 0, float("inf"), 0.0
    state = run.resume()
    if state is not None:
        learner.load(state["learner"])
        generator.set_state(state["generator"])
        first, best, spent = state["step"], state["best"], run.info["wall_s"]
    began = time.monotonic() - spent
    with TrainingProgress(title, steps, first) as progress:
        for done in range(first + 1, steps + 1):
            terms = learner.step(generator)
            progress.advance(terms)
            if done % validate_every and done != steps:
                continue
            measured = learner.validate()
            if measured["score"] < best:
                best = measured["score"]
                run.save_best({**learner.best(), "step": done})
            wall = time.monotonic() - began
            row = {"step": done, "wall_s": wall, **measured, **terms}
            run.log(row)
            progress.report(done, row)
            run.save(
                {
                    "learner": learner.state(),
                    "generator": generator.get_state(),
                    "step": done,
                    "best": best,
                },
                wall,
            )
