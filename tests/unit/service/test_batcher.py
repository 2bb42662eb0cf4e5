"""Batches: who is alone does not wait, and who comes in a crowd is done together."""

import asyncio
import time
from contextlib import asynccontextmanager

import pytest

from agent_server.service.batcher import MAX_BATCH, Batcher
from tests.support.patience import patience


@asynccontextmanager
async def running(batcher):
    task = asyncio.create_task(batcher.run())
    yield batcher
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)


class Doubling:
    """Doubles numbers, and remembers when and how many at once."""

    def __init__(self):
        self.sizes, self.times = [], []

    def __call__(self, numbers):
        self.sizes.append(len(numbers))
        self.times.append(time.monotonic())
        return [2 * number for number in numbers]


async def test_who_comes_while_the_last_batch_is_recent_waits_for_others():
    work = Doubling()
    async with running(Batcher("test", work, apart_s=0.3)) as batcher:
        assert await batcher.ask(1) == 2
        later = [batcher.ask(number) for number in range(2)]
        await asyncio.sleep(0.05)
        later += [batcher.ask(number) for number in range(2, 5)]
        assert await asyncio.gather(*later) == [0, 2, 4, 6, 8]
        await asyncio.sleep(0.35)
        asked_s = time.monotonic()
        assert await batcher.ask(7) == 14
    assert work.sizes == [1, 5, 1]
    assert work.times[1] - work.times[0] >= 0.29
    assert work.times[2] - asked_s < work.times[1] - work.times[0]


async def test_a_full_batch_waits_for_nobody():
    work = Doubling()
    async with running(Batcher("test", work, apart_s=60.0)) as batcher:
        await batcher.ask(0)
        async with patience():
            await asyncio.gather(*[batcher.ask(number) for number in range(MAX_BATCH)])
    assert work.sizes == [1, MAX_BATCH]


async def test_a_batch_that_fails_is_done_one_by_one():
    def picky(numbers):
        if 3 in numbers:
            raise ValueError("no threes")
        return [2 * number for number in numbers]

    async with running(Batcher("test", picky, apart_s=0.0)) as batcher:
        found = await asyncio.gather(
            *[batcher.ask(number) for number in range(5)], return_exceptions=True
        )
    assert [str(one) for one in found] == [
        "0",
        "2",
        "4",
        "a model failed: ValueError('no threes')",
        "8",
    ]


@pytest.mark.parametrize("apart_s", [0.0, 0.01])
async def test_everything_that_is_asked_for_is_answered(apart_s):
    work = Doubling()
    async with running(Batcher("test", work, apart_s)) as batcher:
        found = await asyncio.gather(*[batcher.ask(number) for number in range(100)])
    assert found == [2 * number for number in range(100)]
    assert max(work.sizes) == batcher.largest_batch == MAX_BATCH
