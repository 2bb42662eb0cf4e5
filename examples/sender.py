"""Send any tracker's skeletons to agent-server: copy this file and replace `track`.

Needs only the package websockets. Run it, and watch http://127.0.0.1:8765/?session=lab:

    python examples/sender.py ws://127.0.0.1:8765 lab
"""

import asyncio
import contextlib
import json
import math
import sys
import time

from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed


async def track():
    """Your tracker: a body's id, and x, y, z, confidence of each joint in metres.

    This one is a made-up person, 2 m away, who waves the right hand: x is to their right, y up, z
    away from the sensor. docs/protocol.md has the formats of Kinects, MediaPipe and others.
    """
    while True:
        swing = 0.15 * math.sin(6.0 * time.monotonic())
        joints = [
            (0.0, 0.60, 2.0, 1),  # head
            (0.0, 0.35, 2.0, 1),  # neck
            (0.0, 0.00, 2.0, 1),  # navel
            (-0.18, 0.30, 2.0, 1),  # left shoulder
            (-0.22, 0.05, 2.0, 1),  # left elbow
            (-0.22, -0.18, 1.9, 1),  # left wrist
            (0.18, 0.30, 2.0, 1),  # right shoulder
            (0.38, 0.35, 1.9, 1),  # right elbow
            (0.40 + swing, 0.60, 1.8, 1),  # right wrist
        ]
        yield 0, joints
        await asyncio.sleep(1 / 30)


async def send(url, session):
    """Send what is tracked; after a lost connection, connect again."""
    start_ns = time.monotonic_ns()
    hello = {"type": "hello", "protocol": "1.0", "client": "my-tracker", "face": "none"}
    address = f"{url}/v1/sessions/{session}/sensor"
    async for server in connect(address, subprotocols=["agent-server.v1.json"]):
        with contextlib.suppress(ConnectionClosed):
            await server.send(json.dumps(hello))
            print(await server.recv())  # welcome, or an error that says what to mend
            async for body_id, joints in track():
                frame = {"type": "skeleton", "format": "core9", "body_id": body_id}
                frame["originating_ns"] = time.monotonic_ns() - start_ns  # when it was captured
                await server.send(json.dumps({**frame, "joints": joints}))


if __name__ == "__main__":
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(send(*(sys.argv[1:] or ("ws://127.0.0.1:8765", "lab"))))
