"""Models off the event loop, shared by all sessions.

Windows that wait when the thread is free are run together. Whether a batch may be run as one
is the bundle's to say (``batch_exact``), so that a decision never depends on who else is there.
"""

import asyncio
import logging
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

from agent_server.domain.gesture import Classification
from agent_server.domain.motion import Forecast, Window
from agent_server.errors import InferenceError
from agent_server.service.models import Models
from agent_server.stages.classify import classify
from agent_server.stages.futures import draw_futures
from agent_server.stages.predict import predict

log = logging.getLogger(__name__)

MAX_BATCH = 16


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


def _infer_each(models: Models, windows: Sequence[Window]) -> list[Inference | InferenceError]:
    """Run a batch; where it fails, window by window, so that one costs no other its result."""
    try:
        return list(infer(models, windows))
    except Exception as error:  # whatever a model does, the thread serves on
        if len(windows) > 1:
            return [result for window in windows for result in _infer_each(models, [window])]
        if isinstance(error, InferenceError):
            return [error]
        log.exception("a model failed in a way that it should not")
        return [InferenceError(f"a model failed: {error!r}")]


class InferenceWorker:
    """One thread that runs the models for everybody.

    Args:
        models: The models.

    Attributes:
        models: The models of the batches to come.
        largest_batch: Most windows that were run together.
        busy_since_s: When the present batch began, on ``time.monotonic``; None between batches.
    """

    def __init__(self, models: Models) -> None:
        self.models = models
        self._waiting: list[tuple[Window, asyncio.Future[Inference]]] = []
        self._wake = asyncio.Event()
        self.largest_batch = 0
        self.busy_since_s: float | None = None

    @property
    def waiting(self) -> int:
        """Windows that wait for the thread."""
        return len(self._waiting)

    async def infer(self, window: Window) -> Inference:
        """Run the models on a window when the thread is free.

        Raises:
            InferenceError: If the classifier fails.
        """
        future = asyncio.get_running_loop().create_future()
        self._waiting.append((window, future))
        self._wake.set()
        result: Inference = await future
        return result

    async def run(self) -> None:
        """Serve requests until cancelled."""
        loop = asyncio.get_running_loop()
        with ThreadPoolExecutor(1, thread_name_prefix="inference") as thread:
            while True:
                await self._wake.wait()
                batch, self._waiting = self._waiting[:MAX_BATCH], self._waiting[MAX_BATCH:]
                if not self._waiting:
                    self._wake.clear()
                # A session that has gone no longer waits for its window.
                batch = [(window, future) for window, future in batch if not future.done()]
                if not batch:
                    continue
                self.largest_batch = max(self.largest_batch, len(batch))
                windows = [window for window, _ in batch]
                self.busy_since_s = time.monotonic()
                try:
                    results = await loop.run_in_executor(thread, _infer_each, self.models, windows)
                finally:
                    self.busy_since_s = None
                for (_, future), result in zip(batch, results, strict=True):
                    if future.done():
                        continue
                    if isinstance(result, InferenceError):
                        future.set_exception(result)
                    else:
                        future.set_result(result)
