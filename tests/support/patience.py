"""How long tests wait for what must come.

A slow machine makes a test slow; it does not fail it. Where time is what a test is about, the test
says so itself.
"""

import asyncio

PATIENCE_S = 120.0
POLL_S = 0.005


def patience() -> asyncio.Timeout:
    """Ends what never comes."""
    return asyncio.timeout(PATIENCE_S)


async def until(condition) -> None:
    """Wait for something that nobody announces."""
    async with patience():
        while not condition():  # noqa: ASYNC110 - it has no event
            await asyncio.sleep(POLL_S)
