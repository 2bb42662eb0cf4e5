"""The example that any tracker's user can copy: it sends, and comes back after a restart."""

import asyncio
import sys
from asyncio.subprocess import PIPE
from pathlib import Path

from agent_server.client import Monitor, Options
from agent_server.protocol import messages as m
from tests.support.live import live
from tests.support.patience import patience

SENDER = Path(__file__).parents[2] / "examples" / "sender.py"


async def poses(url, count):
    """So many poses that a monitor gets."""
    found = []
    async with patience(), Monitor(Options(url, "lab"), ["pose"]) as monitor:
        async for message in monitor:
            if isinstance(message, m.PoseMessage):
                found.append(message)
                if len(found) == count:
                    return found
    raise AssertionError("the monitor ended")


async def test_it_sends_a_person_who_waves_and_comes_back_after_a_restart():
    async with live() as server:
        port = int(server.url.rpartition(":")[2])
        url = server.url.replace("http", "ws")
        process = await asyncio.create_subprocess_exec(
            sys.executable, str(SENDER), url, "lab", stdout=PIPE
        )
        try:
            seen = await poses(server.url, 10)
            assert b'"welcome"' in await process.stdout.readline()
            wrists = [pose.joints[8] for pose in seen]
            assert max(x for x, *_ in wrists) - min(x for x, *_ in wrists) > 0.01
            assert server.hub.sessions["lab"].counters["rejected_messages"] == 0
        except BaseException:
            process.kill()
            raise
    try:
        async with live(port=port) as server:
            assert len(await poses(server.url, 5)) == 5
    finally:
        process.kill()
        await process.communicate()
