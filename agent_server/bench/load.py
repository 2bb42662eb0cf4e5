"""How many people one server follows at once: real clients against a server process."""

import asyncio
import bisect
import json
import sys
import time
from asyncio.subprocess import PIPE, Process
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, field

from agent_server import __version__
from agent_server.bench.figures import percentiles, resident_mb
from agent_server.bench.stream import recorded_frames
from agent_server.client.once import Client, join
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import AgentServerError
from agent_server.protocol import messages as m
from agent_server.protocol.convert import skeleton_to_message


@dataclass(frozen=True, slots=True)
class LoadResult:
    """Latency of decisions under load, clients and server on the same machine.

    Attributes:
        sessions: Sessions at once, each a sensor at 30 Hz and a monitor of its decisions.
        p50_ms: From sending the last frame of a window to getting its decision, median.
        p99_ms: Its 99th percentile.
        dropped: Windows that the server skipped.
        rss_mb: Resident memory of the server at the end, in MB; None where it is not known.
        decisions: How many were measured.
        late_ms: How late the clients themselves sent at worst, in milliseconds: when this is
            large, the machine is too small for clients and server together.
        seconds: For how long.
    """

    sessions: int
    p50_ms: float
    p99_ms: float
    dropped: int
    rss_mb: float | None
    decisions: int
    late_ms: float
    seconds: float


@dataclass(slots=True)
class _Tally:
    latencies_ms: list[float] = field(default_factory=list)
    skipped: dict[str, int] = field(default_factory=dict)
    late_s: float = 0.0


async def measure_load(sessions: int, seconds: float) -> LoadResult:
    """Start a server process, connect clients, and measure for ``seconds`` after a warm-up."""
    frames = [skeleton_to_message(frame) for frame in recorded_frames("demo")]
    tally = _Tally()
    async with _server() as (process, url):
        start_s = time.monotonic() + 2.0
        async with AsyncExitStack() as stack:
            pairs = [await _connect(stack, url, f"load-{i}") for i in range(sessions)]
            async with asyncio.TaskGroup() as group:
                for index, (monitor, sensor) in enumerate(pairs):
                    # Sensors are not in step with each other.
                    begin_s = max(start_s, time.monotonic()) + (index * 0.618 % 1.0) / 5
                    person = _Person(frames, begin_s, seconds, tally)
                    group.create_task(person.run(monitor, sensor, f"load-{index}"))
            rss_mb = resident_mb(process.pid)
    if not tally.latencies_ms:
        raise AgentServerError("no decision came back, so nothing was measured")
    figures = percentiles(tally.latencies_ms)
    return LoadResult(
        sessions=sessions,
        p50_ms=figures.p50_ms,
        p99_ms=figures.p99_ms,
        dropped=sum(tally.skipped.values()),
        rss_mb=rss_mb,
        decisions=len(tally.latencies_ms),
        late_ms=round(tally.late_s * 1000, 3),
        seconds=seconds,
    )


class _Person:
    """One simulated person: a sensor that sends, and a monitor that takes the time."""

    def __init__(
        self, frames: list[m.Skeleton], begin_s: float, seconds: float, tally: _Tally
    ) -> None:
        self._frames = [
            frame
            for frame in frames
            if frame.originating_ns - frames[0].originating_ns < seconds * NS_PER_S
        ]
        self._begin_s = begin_s
        self._tally = tally
        self._stamps: list[int] = []
        self._sent_s: list[float] = []

    async def run(self, monitor: Client, sensor: Client, session: str) -> None:
        listening = asyncio.create_task(self._listen(monitor, session))
        await self._send(sensor)
        await asyncio.sleep(0.5)
        listening.cancel()

    async def _send(self, sensor: Client) -> None:
        first_ns = self._frames[0].originating_ns
        for frame in self._frames:
            due_s = self._begin_s + (frame.originating_ns - first_ns) / NS_PER_S
            await asyncio.sleep(max(0.0, due_s - time.monotonic()))
            now_s = time.monotonic()
            self._tally.late_s = max(self._tally.late_s, now_s - due_s)
            self._stamps.append(frame.originating_ns)
            self._sent_s.append(now_s)
            await sensor.send(frame)

    async def _listen(self, monitor: Client, session: str) -> None:
        async for message in monitor:
            if isinstance(message, m.DecisionMessage):
                now_s = time.monotonic()
                last = bisect.bisect_left(self._stamps, message.decision.end_ns)
                self._tally.latencies_ms.append((now_s - self._sent_s[last]) * 1000)
            elif isinstance(message, m.StatsMessage):
                self._tally.skipped[session] = message.skipped_windows


async def _connect(stack: AsyncExitStack, url: str, session: str) -> tuple[Client, Client]:
    watch = m.Hello(m.PROTOCOL, "bench", __version__, topics=["decision", "stats"])
    monitor = await stack.enter_async_context(join(url, session, "monitor", hello=watch))
    sensor = await stack.enter_async_context(join(url, session, "sensor"))
    return monitor, sensor


@asynccontextmanager
async def _server() -> AsyncIterator[tuple[Process, str]]:
    """A server in a process of its own, on a free port."""
    command = (sys.executable, "-m", "agent_server", "serve", "--port", "0", "--json")
    process = await asyncio.create_subprocess_exec(*command, stdout=PIPE)
    try:
        assert process.stdout is not None  # noqa: S101 - it was asked for
        line = await process.stdout.readline()
        if not line:
            raise AgentServerError("the server did not start; `agent-server serve` says why")
        yield process, json.loads(line)["address"]
    finally:
        if process.returncode is None:
            process.terminate()
        await process.wait()
