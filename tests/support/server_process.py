"""The scripted server's process: started, killed with SIGKILL, and started again."""

import asyncio
import contextlib
import json
import os
import signal
import socket
import sys
import time
from pathlib import Path

from agent_server.service.store import FolderStore

ROOT = Path(__file__).parents[2]
START_S = 30.0


class ServerProcess:
    """A server on one port with one folder of state.

    Attributes:
        port: Where it listens.
        state: Folder in which it remembers sessions.
    """

    def __init__(self, nursery, port, state):
        self._nursery = nursery
        self._pid = None
        self.port = port
        self.state = state

    async def start(self):
        """Start it; gives the time at which it takes connections, on the monotonic clock."""
        self._nursery.stdin.write(b"start\n")
        async with asyncio.timeout(START_S):
            line = await self._nursery.stdout.readline()
        self._pid = json.loads(line)["pid"]
        return time.monotonic_ns()

    async def kill(self):
        """End it without a word; gives the time at which that was done."""
        killed_ns = time.monotonic_ns()
        os.kill(self._pid, signal.SIGKILL)
        with contextlib.suppress(ProcessLookupError):
            while True:
                os.kill(self._pid, 0)
                await asyncio.sleep(0.001)
        return killed_ns

    def saved(self, session):
        """What it has written down of a session, or None."""
        return FolderStore(self.state, time.time_ns()).load(session)


@contextlib.asynccontextmanager
async def server_process(state, record=None):
    """A server that is not started yet; whatever runs in the end is killed.

    Args:
        state: Folder in which it remembers sessions.
        record: Folder in which it records them; None records nothing.
    """
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    nursery = await asyncio.create_subprocess_exec(
        *(sys.executable, "-m", "tests.support.scripted_server"),
        *("--port", str(port), "--state", str(state), "--json", "--respawn"),
        *(() if record is None else ("--record", str(record))),
        stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE,
        cwd=ROOT,
    )
    try:
        yield ServerProcess(nursery, port, state)
    finally:
        nursery.stdin.close()
        await nursery.wait()
