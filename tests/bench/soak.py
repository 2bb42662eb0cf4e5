"""Sessions that come, die and come back for a long time: nothing may be left behind.

``python -m tests.bench.soak --minutes 30 --sessions 50 --json``. Every session has a sensor (body
at 30 Hz, landmarks at 10 Hz, of a synthetic person) and a monitor. Each stays for some seconds, and
goes in order, by a cut connection, or with its monitor left behind; most come back to the same
session, some to a new one. Status 1 if the server has grown, or has kept a task or a file.
"""

import argparse
import asyncio
import itertools
import json
import random
import statistics
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path

import httpx
import uvloop
from prometheus_client.parser import text_string_to_metric_families
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed
from websockets.frames import Frame, Opcode

from agent_server.bench.load import Load, server_process, stream_of
from agent_server.client.once import socket_address
from agent_server.domain.stamp import NS_PER_S
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS

CODEC = CODECS[m.SUBPROTOCOL_JSON]
LINGER_S = 2.0
MOST_GROWTH = 0.02
EVERY_S = 2.0
STAY_S = (3.0, 12.0)


class Churn:
    """People who come and go.

    Attributes:
        visits: How often somebody came.
        cuts: How often a connection was cut.
    """

    def __init__(self, url, seed):
        self._stream = [
            (one.stamp_ns, Frame(Opcode.TEXT, one.data).serialize(mask=True))
            for one in stream_of(Load())
        ]
        self._url = url
        self._random = random.Random(seed)
        self._names = itertools.count()
        self.visits = self.cuts = 0

    async def live(self, until_s):
        """One person after the other in one place, until it is time to go."""
        name = f"soak-{next(self._names)}"
        while time.monotonic() < until_s:
            with suppress(OSError, ConnectionClosed, TimeoutError):
                await self._visit(
                    name, min(self._random.uniform(*STAY_S), until_s - time.monotonic())
                )
            if self._random.random() < 0.3:
                name = f"soak-{next(self._names)}"

    async def _visit(self, name, stay_s):
        self.visits += 1
        sensor, monitor = [await self._join(name, role) for role in ("sensor", "monitor")]
        reading = asyncio.create_task(_read(monitor))
        try:
            first = self._random.randrange(len(self._stream) // 2)
            began_s, first_ns = time.monotonic(), self._stream[first][0]
            for stamp_ns, wire in self._stream[first:]:
                due_s = (stamp_ns - first_ns) / NS_PER_S
                if due_s > stay_s:
                    break
                await asyncio.sleep(max(0.0, began_s + due_s - time.monotonic()))
                if sensor.transport.is_closing():
                    break
                sensor.transport.write(wire)
        finally:
            for socket in (sensor, monitor):
                if self._random.random() < 0.5:
                    self.cuts += 1
                    socket.transport.abort()
                else:
                    await socket.close()
            reading.cancel()

    async def _join(self, name, role):
        socket = await connect(
            socket_address(self._url, name, role),
            subprotocols=[m.SUBPROTOCOL_JSON],
            compression=None,
        )
        await socket.send(CODEC.encode(m.Hello(m.PROTOCOL, "soak", topics=["decision", "stats"])))
        await socket.recv()
        return socket


async def _read(socket):
    with suppress(ConnectionClosed):
        async for _ in socket:
            pass


async def _look(url):
    """What the server holds: memory in MB, files (sockets are some), tasks, sessions, clients."""
    async with httpx.AsyncClient(timeout=60) as http:
        text = (await http.get(f"{url}/metrics")).text
    samples = [one for family in text_string_to_metric_families(text) for one in family.samples]
    total = lambda name: sum(one.value for one in samples if one.name == name)  # noqa: E731
    return {
        "rss_mb": total("process_resident_memory_bytes") / 2**20,
        "files": total("process_open_fds"),
        "tasks": total("agent_server_tasks"),
        "sessions": total("agent_server_sessions"),
        "clients": total("agent_server_clients"),
        "decisions": total("agent_server_decisions_total"),
    }


async def soak(minutes, sessions, seed):
    """Run, and give what was found."""
    with tempfile.TemporaryDirectory() as folder:
        settings = f"session_linger_s = {LINGER_S}\n"
        async with server_process("uvicorn", 4 * sessions, Path(folder), settings) as url:
            churn = Churn(url, seed)
            await asyncio.sleep(1.0)
            before = await _look(url)
            began_s = time.monotonic()
            until_s = began_s + minutes * 60
            looks = []
            async with asyncio.TaskGroup() as group:
                for _ in range(sessions):
                    group.create_task(churn.live(until_s))
                while time.monotonic() < until_s:
                    await asyncio.sleep(EVERY_S)
                    looks.append(await _look(url))
            await asyncio.sleep(LINGER_S + 4.0)
            after = await _look(url)
    third, tenth = len(looks) // 3, max(1, len(looks) // 10)
    warm_mb = statistics.median(look["rss_mb"] for look in looks[third : third + tenth])
    end_mb = statistics.median(look["rss_mb"] for look in looks[-tenth:])
    return {
        "minutes": minutes,
        "sessions": sessions,
        "visits": churn.visits,
        "cuts": churn.cuts,
        "decisions": int(after["decisions"]),
        "warm_mb": round(warm_mb, 1),
        "end_mb": round(end_mb, 1),
        "growth": round(end_mb / warm_mb - 1, 4),
        "by_tenths_mb": [
            round(statistics.median(look["rss_mb"] for look in looks[at : at + tenth]), 1)
            for at in range(0, len(looks) - tenth + 1, tenth)
        ],
        "left_tasks": int(after["tasks"] - before["tasks"]),
        "left_files": int(after["files"] - before["files"]),
        "left_sessions": int(after["sessions"]),
        "left_clients": int(after["clients"]),
    }


def main():
    """Parse, run, print, judge."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--minutes", type=float, default=3.0)
    parser.add_argument("--sessions", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    found = uvloop.run(soak(given.minutes, given.sessions, given.seed))
    print(json.dumps(found, indent=None if given.json else 2))  # noqa: T201 - its answer
    left = [name for name in found if name.startswith("left_") and found[name] > 0]
    if found["growth"] > MOST_GROWTH or left or not found["decisions"]:
        sys.exit(f"soak: growth {found['growth']:.1%}, at most {MOST_GROWTH:.0%}; left: {left}")


if __name__ == "__main__":
    main()
