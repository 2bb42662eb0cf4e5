"""Work for models off the event loop: what waits when their thread is free is done together."""

import asyncio
import logging
import math
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Generic, TypeVar

from agent_server.errors import AgentServerError, InferenceError

log = logging.getLogger(__name__)

MAX_BATCH = 16

Given = TypeVar("Given")
Result = TypeVar("Result")


class Batcher(Generic[Given, Result]):
    """One thread that does one kind of work for everybody.

    Args:
        name: Of the thread.
        work: Gives a result for each thing of a batch.
        apart_s: Batches begin at least so far apart, in seconds. Who is alone waits for nobody;
            where many ask, more of them are done together, which costs less.

    Attributes:
        largest_batch: The most that was done together.
        busy_since_s: When the present batch began, on ``time.monotonic``; None between batches.
    """

    def __init__(
        self,
        name: str,
        work: Callable[[Sequence[Given]], Sequence[Result]],
        apart_s: float,
    ) -> None:
        self._name = name
        self._work = work
        self._apart_s = apart_s
        self._waiting: list[tuple[Given, asyncio.Future[Result]]] = []
        self._wake = asyncio.Event()
        self.largest_batch = 0
        self.busy_since_s: float | None = None

    @property
    def waiting(self) -> int:
        """How much waits for the thread."""
        return len(self._waiting)

    def ask(self, one: Given) -> asyncio.Future[Result]:
        """What will be the result; it fails with what the work fails with."""
        future: asyncio.Future[Result] = asyncio.get_running_loop().create_future()
        self._waiting.append((one, future))
        self._wake.set()
        return future

    async def run(self) -> None:
        """Serve requests until cancelled."""
        loop = asyncio.get_running_loop()
        begun_s = -math.inf
        with ThreadPoolExecutor(1, thread_name_prefix=self._name) as thread:
            while True:
                await self._wake.wait()
                rest_s = begun_s + self._apart_s - time.monotonic()
                if rest_s > 0.0 and len(self._waiting) < MAX_BATCH:
                    await asyncio.sleep(rest_s)
                begun_s = time.monotonic()
                batch, self._waiting = self._waiting[:MAX_BATCH], self._waiting[MAX_BATCH:]
                if not self._waiting:
                    self._wake.clear()
                # Who has gone no longer waits.
                batch = [(one, future) for one, future in batch if not future.done()]
                if not batch:
                    continue
                self.largest_batch = max(self.largest_batch, len(batch))
                self.busy_since_s = time.monotonic()
                try:
                    results = await loop.run_in_executor(
                        thread, self._do, [one for one, _ in batch]
                    )
                finally:
                    self.busy_since_s = None
                for (_, future), result in zip(batch, results, strict=True):
                    if future.done():
                        continue
                    if isinstance(result, AgentServerError):
                        future.set_exception(result)
                    else:
                        future.set_result(result)

    def _do(self, batch: Sequence[Given]) -> list[Result | AgentServerError]:
        """Do a batch; where it fails, one by one, so that one costs no other its result."""
        try:
            return list(self._work(batch))
        except Exception as error:  # whatever a model does, the thread serves on
            if len(batch) > 1:
                return [result for one in batch for result in self._do([one])]
            if isinstance(error, AgentServerError):
                return [error]
            log.exception("a model failed in a way that it should not")
            return [InferenceError(f"a model failed: {error!r}")]
