"""How late the event loop is: what holds it up holds up everybody."""

import asyncio
from collections.abc import Callable

EVERY_S = 0.1


async def measure_lag(tell: Callable[[float], None]) -> None:
    """Ask to be woken ten times a second, and tell how much later it was, until cancelled.

    Args:
        tell: Is given the lateness in seconds.
    """
    loop = asyncio.get_running_loop()
    while True:
        due_s = loop.time() + EVERY_S
        await asyncio.sleep(EVERY_S)
        tell(max(0.0, loop.time() - due_s))
