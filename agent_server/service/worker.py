"""Models off the event loop, shared by all sessions.

What waits when a thread is free is run together. Whether a batch may be run as one
is the bundle's to say (``batch_exact``), so that a decision never depends on who else is there.
"""

import asyncio
import logging
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from agent_server.domain.arrays import Float64
from agent_server.domain.face import Face
from agent_server.domain.gesture import Classification
from agent_server.domain.motion import Forecast, Window
from agent_server.domain.reaction import Stretch
from agent_server.service.batcher import Batcher
from agent_server.service.models import Models
from agent_server.stages.affect import read_affect
from agent_server.stages.classify import classify
from agent_server.stages.futures import draw_futures
from agent_server.stages.predict import predict
from agent_server.stages.react import broken_off

log = logging.getLogger(__name__)

WINDOWS_APART_S = 0.01
FACES_APART_S = 0.03
"""How far apart batches begin where many ask; affect is averaged over a second and can wait."""
MOST_REACTIONS = 16
"""So many reactions may wait for their next stretch; what comes beyond is not made."""


@dataclass(frozen=True, slots=True)
class Inference:
    """What the models made of a window, and how long that took.

    Attributes:
        forecast: The expected motion.
        classification: Class probabilities.
        predict_ms: Time of the predictor's batch and of other futures, in milliseconds.
        classify_ms: Time of the classifier's batch, in milliseconds.
        models: Hashes of all models that were in use, by name.
    """

    forecast: Forecast
    classification: Classification
    predict_ms: float
    classify_ms: float
    models: Mapping[str, str]


def infer(models: Models, windows: Sequence[Window]) -> list[Inference]:
    """Run both models on a batch of windows.

    Raises:
        InferenceError: If the classifier fails.
    """
    start = time.perf_counter_ns()
    forecasts = predict(models.predictor, windows)
    if (drawing := models.drawing) is not None:
        forecasts = draw_futures(
            drawing.sampler, drawing.count, drawing.least_quality, windows, forecasts
        )
    between = time.perf_counter_ns()
    classifications = classify(models.classifier, windows, forecasts)
    predict_ms = (between - start) / 1e6
    classify_ms = (time.perf_counter_ns() - between) / 1e6
    hashes = models.hashes
    return [
        Inference(forecast, classification, predict_ms, classify_ms, hashes)
        for forecast, classification in zip(forecasts, classifications, strict=True)
    ]


class InferenceWorker:
    """Threads that run the models for everybody: what decides, reads faces, makes reactions.

    Args:
        models: The models.

    Attributes:
        models: The models of the batches to come.
        windows: Where windows wait.
        faces: Where faces wait.
        reactions: Where reactions wait for their next stretch.
    """

    def __init__(self, models: Models) -> None:
        self.models = models
        self.windows = Batcher[Window, Inference](
            "inference", lambda windows: infer(self.models, windows), WINDOWS_APART_S
        )
        self.faces = Batcher[Face, Float64](
            "affect", lambda faces: read_affect(self.models.affect, faces), FACES_APART_S
        )
        self.reactions = Batcher[Iterator[Stretch], Stretch](
            "reactions", lambda makings: list(map(_next_stretch, makings)), 0.0
        )

    @property
    def busy_since_s(self) -> float | None:
        """Since when a thread is at one batch, on ``time.monotonic``: the longest; or None."""
        since = (one.busy_since_s for one in (self.windows, self.faces, self.reactions))
        return min((one for one in since if one is not None), default=None)

    async def infer(self, window: Window) -> Inference:
        """Run the models on a window when their thread is free.

        Raises:
            InferenceError: If the classifier fails.
        """
        return await self.windows.ask(window)

    def read(self, face: Face) -> "asyncio.Future[Float64]":
        """Valence, arousal and their deviations, as :func:`read_affect` gives them, later.

        The future fails with :class:`InvalidInput` where the points are no face, and with
        :class:`InferenceError` where the model fails.
        """
        return self.faces.ask(face)

    async def go_on(self, making: Iterator[Stretch]) -> Stretch:
        """The next stretch of a reaction, when its thread is free."""
        if self.reactions.waiting >= MOST_REACTIONS:
            return broken_off(f"{MOST_REACTIONS} reactions are being made already")
        return await self.reactions.ask(making)

    async def run(self) -> None:
        """Serve requests until cancelled."""
        async with asyncio.TaskGroup() as group:
            group.create_task(self.windows.run(), name="inference of windows")
            group.create_task(self.faces.run(), name="inference of faces")
            group.create_task(self.reactions.run(), name="inference of reactions")


def _next_stretch(making: Iterator[Stretch]) -> Stretch:
    try:
        return next(making)
    except Exception as error:  # whatever a model does, the other reactions go on
        log.exception("a model failed in a way that it should not")
        return broken_off(f"a model failed: {error!r}")
