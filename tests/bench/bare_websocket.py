"""What a websocket message takes with nothing around it: the floor under a client's latency.

    python -m tests.bench.bare_websocket serve
    python -m tests.bench.bare_websocket listen PORT 300

The first prints its port and sends a message as large as a command twenty times a second; the
second takes some and prints, as a list in JSON, the nanoseconds that each was on its way.
"""

import asyncio
import json
import sys
import time
from contextlib import asynccontextmanager

import numpy as np
from websockets.asyncio.client import connect
from websockets.asyncio.server import serve
from websockets.exceptions import ConnectionClosed

INTERVAL_S = 0.05
PADDING = "x" * 400
"""About as much as a command says."""


def _stamped():
    """A message that says when it was sent, by the clock of programs and by that of pages."""
    return {"sent_ns": time.monotonic_ns(), "wall_ms": time.time() * 1e3, "padding": PADDING}


async def _send(socket):
    try:
        while True:
            await asyncio.sleep(INTERVAL_S)
            await socket.send(json.dumps(_stamped()))
    except ConnectionClosed:
        pass


async def _serve():
    async with serve(_send, "127.0.0.1", 0, compression=None) as server:
        print(server.sockets[0].getsockname()[1], flush=True)  # noqa: T201
        await asyncio.Future()


async def _listen(port, count):
    taken_ns = []
    async for socket in connect(f"ws://127.0.0.1:{port}", compression=None):
        async with socket:
            while len(taken_ns) < count:
                message = json.loads(await socket.recv())
                taken_ns.append(time.monotonic_ns() - message["sent_ns"])
        break
    return taken_ns


@asynccontextmanager
async def _program(*arguments):
    command = (sys.executable, "-m", "tests.bench.bare_websocket", *map(str, arguments))
    process = await asyncio.create_subprocess_exec(*command, stdout=asyncio.subprocess.PIPE)
    try:
        yield process
    finally:
        if process.returncode is None:
            process.terminate()
        await process.wait()


async def latencies_ms(count):
    """How long ``count`` messages take from one program to another, milliseconds."""
    async with _program("serve") as server:
        port = int(await server.stdout.readline())
        async with _program("listen", port, count) as listener:
            said, _ = await listener.communicate()
    return np.array(json.loads(said), dtype=float) / 1e6


_PAGE = """
([port, count]) => new Promise((resolve) => {
  const taken = [];
  const socket = new WebSocket(`ws://127.0.0.1:${port}`);
  socket.onmessage = (event) => {
    const now = performance.timeOrigin + performance.now();
    taken.push(now - JSON.parse(event.data).wall_ms);
    if (taken.length === count) {
      socket.close();
      resolve(taken);
    }
  };
})
"""


async def latencies_in_page_ms(page, count):
    """How long ``count`` messages take from a program to a page, milliseconds."""
    async with _program("serve") as server:
        port = int(await server.stdout.readline())
        return np.array(await page.evaluate(_PAGE, [port, count]))


if __name__ == "__main__":
    role, *numbers = sys.argv[1:]
    if role == "serve":
        asyncio.run(_serve())
    else:
        print(json.dumps(asyncio.run(_listen(*map(int, numbers)))))  # noqa: T201
