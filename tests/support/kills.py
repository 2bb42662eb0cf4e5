"""A server that is killed while it records, and what is on the disk then."""

import asyncio
import json
import random
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

from websockets.asyncio.client import connect
from websockets.exceptions import WebSocketException

from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import RecordingError
from agent_server.protocol import messages as m
from agent_server.recording.reader import open_recording
from agent_server.recording.recover import recover
from tests.support.gesture_script import BODIES, gesture_at
from tests.support.server_process import server_process

FRAME_S = 1 / 30
LIFE_S = (0.2, 2.5)


@dataclass
class Kills:
    """What came of it.

    Attributes:
        kills: How often the server was killed.
        unreadable: Recordings that could not be recovered, with the reason.
        wrong: Recordings with a frame that was never sent, or with a hole.
        lost_s: What each kill cost: from sending the first frame that is not in the file, to the
            kill.
    """

    kills: int = 0
    unreadable: list = field(default_factory=list)
    wrong: list = field(default_factory=list)
    lost_s: list = field(default_factory=list)
    frames: int = 0


async def kill_often(count, seed, life_s=LIFE_S):
    """Kill a recording server at random moments, and recover what it wrote each time."""
    rng = random.Random(seed)
    kills = Kills()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "recordings").mkdir()
        async with server_process(folder / "state", folder / "recordings") as server:
            for index in range(count):
                session = f"k{index}"
                await server.start()
                sent, connected = {}, asyncio.Event()
                sending = asyncio.create_task(_send(server.port, session, sent, connected))
                await connected.wait()
                await asyncio.sleep(rng.uniform(*life_s))
                killed_s = await server.kill() / 1e9
                sending.cancel()
                await asyncio.gather(sending, return_exceptions=True)
                sent = {stamp: at_s for stamp, at_s in sent.items() if at_s < killed_s}
                kills.kills += 1
                (path,) = (folder / "recordings").glob(f"{session}-*.mcap")
                _examine(path, sent, killed_s, kills)
                path.unlink()
    return kills


async def _send(port, session, sent, connected):
    """Send a body at 30 Hz; notes when each stamp was sent, on the monotonic clock."""
    url = f"ws://127.0.0.1:{port}/v1/sessions/{session}/sensor"
    try:
        async with connect(url, subprotocols=[m.SUBPROTOCOL_JSON], close_timeout=0.0) as socket:
            hello = {"type": "hello", "protocol": m.PROTOCOL, "client": "tester", "face": "none"}
            await socket.send(json.dumps(hello))
            await socket.recv()
            start_s = due_s = time.monotonic()
            connected.set()
            while True:
                now_s = time.monotonic()
                stamp_ns = int((now_s - start_s) * 1e9)
                body = {
                    "type": "skeleton",
                    "originating_ns": stamp_ns,
                    "body_id": 1,
                    "format": "core9",
                    "joints": BODIES[gesture_at(now_s - start_s)],
                }
                await socket.send(json.dumps(body))
                sent[stamp_ns] = time.monotonic()
                due_s = max(due_s + FRAME_S, time.monotonic())
                await asyncio.sleep(due_s - time.monotonic())
    except (OSError, WebSocketException):
        pass


def _examine(path, sent, killed_s, kills):
    output = path.with_name(f"out_{path.name}")
    try:
        recover(path, output)
        events = list(open_recording(output).events())
    except RecordingError as error:
        kills.unreadable.append(str(error))
        return
    output.unlink()
    saved = [event.originating_ns for event in events if isinstance(event, SkeletonFrame)]
    kills.frames += len(saved)
    stamps = list(sent)
    if saved != stamps[: len(saved)]:
        kills.wrong.append(f"{path.name}: the frames are not the first that were sent")
    missing = stamps[len(saved) :]
    kills.lost_s.append(killed_s - sent[missing[0]] if missing else 0.0)
