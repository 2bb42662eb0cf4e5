"""The inference thread: batches, failures, sessions that have gone."""

import asyncio
import threading
from contextlib import asynccontextmanager

import numpy as np
import pytest

from agent_server.domain.motion import Quality, Window
from agent_server.errors import InferenceError
from agent_server.inference.fake import LastFramePredictor, RuleClassifier
from agent_server.service.batcher import MAX_BATCH
from agent_server.service.models import Models
from agent_server.service.worker import InferenceWorker, infer
from tests.support.models import fake_models


def window(index, height=0.0):
    positions = np.full((25, 9, 3), height, np.float32)
    return Window(index, 0, 0, 1, positions, np.ones((25, 9), np.float32), Quality(1, 0, 0))


@asynccontextmanager
async def running(models):
    worker = InferenceWorker(models)
    task = asyncio.create_task(worker.run())
    yield worker
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


class Blocking(LastFramePredictor):
    """Waits until it may go on."""

    def __init__(self):
        super().__init__()
        self.may_go = threading.Event()
        self.sizes = []

    def predict(self, seen):
        self.may_go.wait(5)
        self.sizes.append(len(seen))
        return super().predict(seen)


class Broken(RuleClassifier):
    """Fails as long as it is told to."""

    def __init__(self):
        super().__init__(lambda _: "idle")
        self.broken = True

    def classify(self, motion):
        if self.broken:
            raise InferenceError("the classifier is broken")
        return super().classify(motion)


async def test_windows_that_wait_are_run_together_and_kept_apart():
    predictor = Blocking()
    models = Models(predictor, fake_models().classifier)
    async with running(models) as worker:
        first = asyncio.create_task(worker.infer(window(0, 0.5)))
        await asyncio.sleep(0.05)  # it is in the thread now
        rest = [asyncio.create_task(worker.infer(window(i, i))) for i in range(1, MAX_BATCH + 3)]
        await asyncio.sleep(0)
        predictor.may_go.set()
        results = await asyncio.gather(first, *rest)
    assert predictor.sizes == [1, MAX_BATCH, 2]
    assert worker.windows.largest_batch == MAX_BATCH
    heights = [float(result.forecast.positions[0, 0, 1]) for result in results]
    assert heights == [0.5, *range(1, MAX_BATCH + 3)]


async def test_a_classifier_that_fails_is_reported_and_the_worker_goes_on():
    classifier = Broken()
    async with running(Models(LastFramePredictor(), classifier)) as worker:
        with pytest.raises(InferenceError, match="broken"):
            await worker.infer(window(0))
        classifier.broken = False
        assert (await worker.infer(window(1))).classification.best == "idle"


async def test_a_model_that_breaks_in_an_unknown_way_does_not_end_the_worker(caplog):
    class Exploding(Broken):
        def classify(self, motion):
            if self.broken:
                raise MemoryError("no room")
            return super().classify(motion)

    classifier = Exploding()
    async with running(Models(LastFramePredictor(), classifier)) as worker:
        with pytest.raises(InferenceError, match="no room"):
            await worker.infer(window(0))
        classifier.broken = False
        assert (await worker.infer(window(1))).classification.best == "idle"
    assert "a model failed" in caplog.text


async def test_a_window_that_the_classifier_fails_on_costs_no_other_its_decision():
    class Picky(RuleClassifier):
        def classify(self, motion):
            if (motion[:, 0, 0, 0] > 2).any():
                raise InferenceError("no such motion")
            return super().classify(motion)

    predictor = Blocking()
    odd = window(1)
    odd.positions[0, 0, 0] = 3.0
    async with running(Models(predictor, Picky(lambda _: "idle"))) as worker:
        first = asyncio.create_task(worker.infer(window(0)))
        await asyncio.sleep(0.05)
        rest = [asyncio.create_task(worker.infer(w)) for w in (window(1), odd, window(2))]
        await asyncio.sleep(0)
        predictor.may_go.set()
        results = await asyncio.gather(first, *rest, return_exceptions=True)
    assert [isinstance(result, InferenceError) for result in results] == [False, False, True, False]


async def test_a_session_that_has_gone_costs_nothing():
    predictor = Blocking()
    async with running(Models(predictor, fake_models().classifier)) as worker:
        first = asyncio.create_task(worker.infer(window(0)))
        await asyncio.sleep(0.05)
        gone = asyncio.create_task(worker.infer(window(1)))
        await asyncio.sleep(0)
        gone.cancel()
        predictor.may_go.set()
        await first
        await worker.infer(window(2))
    assert predictor.sizes == [1, 1]


async def test_whichever_thread_is_longest_at_one_batch_is_told():
    reacting = threading.Event()
    predictor = Blocking()

    def making():
        reacting.wait(5)
        yield "stretch"

    async with running(Models(predictor, RuleClassifier(lambda _: "idle"))) as worker:
        assert worker.busy_since_s is None
        going_on = asyncio.create_task(worker.go_on(making()))
        await asyncio.sleep(0.05)
        first_s = worker.busy_since_s
        assert first_s == worker.reactions.busy_since_s is not None
        inferring = asyncio.create_task(worker.infer(window(0)))
        await asyncio.sleep(0.05)
        assert worker.busy_since_s == first_s < worker.windows.busy_since_s
        reacting.set()
        assert await going_on == "stretch"
        assert worker.busy_since_s == worker.windows.busy_since_s
        predictor.may_go.set()
        await inferring
        assert worker.busy_since_s is None


def test_one_bad_window_of_a_batch_costs_the_others_nothing():
    class Picky(LastFramePredictor):
        def predict(self, seen):
            # The middle of the last frame is its own origin; its head shows who it is.
            if (seen[:, 0, 0, 0] > 2).any():
                raise InferenceError("no such pose")
            return super().predict(seen)

    odd = window(1)
    odd.positions.flags.writeable = True
    odd.positions[0, 0, 0] = 3.0
    results = infer(Models(Picky(), fake_models().classifier), [window(0), odd, window(2)])
    assert [result.forecast.failure for result in results] == [None, "no such pose", None]
    assert results[1].forecast.source == "last_frame"
    np.testing.assert_array_equal(results[1].forecast.positions[49], odd.positions[24])
