"""A monitor and a sensor that come back by themselves, for a server that is killed now and then."""

import asyncio
import json
import time

from websockets.asyncio.client import connect
from websockets.exceptions import WebSocketException

from agent_server.domain.gesture import IDLE
from agent_server.protocol import messages as m
from tests.support.gesture_script import BODIES, gesture_at

RETRY_S = 0.02
FRAME_S = 1 / 30


def _open(port, session, role):
    return connect(
        f"ws://127.0.0.1:{port}/v1/sessions/{session}/{role}",
        subprotocols=[m.SUBPROTOCOL_JSON],
        compression=None,
        max_size=None,
        close_timeout=0.2,
    )


def _hello(**more):
    return json.dumps({"type": "hello", "protocol": m.PROTOCOL, "client": "tester", **more})


class Presence:
    """Whether somebody is in a session; both sides of it can be waited for."""

    def __init__(self):
        self.joined = asyncio.Event()
        self.parted = asyncio.Event()
        self.parted.set()

    def join(self):
        self.parted.clear()
        self.joined.set()

    def part(self):
        self.joined.clear()
        self.parted.set()


async def watch(port, session, take, presence, topics=("command", "ack")):
    """Give every telemetry message to ``take``."""
    while True:
        try:
            async with _open(port, session, "monitor") as socket:
                await socket.send(_hello(topics=list(topics)))
                async for text in socket:
                    message = json.loads(text)
                    if message["type"] == "welcome":
                        presence.join()
                    else:
                        take(message)
        except (OSError, WebSocketException):
            pass
        finally:
            presence.part()
        await asyncio.sleep(RETRY_S)


async def act(port, session, may_send, is_over, haste=1.0):
    """Send a body that makes the script's gestures, in real time, whenever ``may_send`` is set.

    Args:
        port: The server's.
        session: Id of the session.
        may_send: Event that is set while the sensor is to be connected.
        is_over: Event after which there are no more gestures, and the body rests.
        haste: 2 makes twice as many gestures in a time; the frames are always those of 30 Hz.
    """
    start_s = time.monotonic()
    while True:
        await may_send.wait()
        try:
            async with _open(port, session, "sensor") as socket:
                await socket.send(_hello(face="none", take_over=True))
                draining = asyncio.create_task(_drain(socket))
                try:
                    await _send_bodies(socket, start_s, may_send, is_over, haste)
                finally:
                    draining.cancel()
                    await asyncio.gather(draining, return_exceptions=True)
        except (OSError, WebSocketException):
            await asyncio.sleep(RETRY_S)


async def _send_bodies(socket, start_s, may_send, is_over, haste):
    due_s = time.monotonic()
    while may_send.is_set():
        now_s = time.monotonic() - start_s
        gesture = IDLE if is_over.is_set() else gesture_at(now_s * haste)
        body = {
            "type": "skeleton",
            "originating_ns": int(now_s * 1e9),
            "body_id": 1,
            "format": "core9",
            "joints": BODIES[gesture],
        }
        await socket.send(json.dumps(body))
        due_s = max(due_s + FRAME_S, time.monotonic())
        await asyncio.sleep(due_s - time.monotonic())


async def _drain(socket):
    """Take what the server says, its pings too."""
    async for _ in socket:
        pass
