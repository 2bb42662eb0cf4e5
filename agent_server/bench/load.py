"""How many people one server follows at once: real clients in processes of their own."""

import asyncio
import json
import os
import sys
import tempfile
import time
import urllib.request
from asyncio.subprocess import PIPE, Process
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import msgspec
from prometheus_client.parser import text_string_to_metric_families

from agent_server.bench.crowd import WARM_UP_S, Plan, Sent, Told
from agent_server.bench.figures import percentiles
from agent_server.bench.stream import recorded_events
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import AgentServerError
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from agent_server.protocol.inputs import input_to_message, packed

Stack = Literal["uvicorn", "websockets"]
Coding = Literal["json", "msgpack"]
STACKS: tuple[Stack, ...] = ("uvicorn", "websockets")
SUBPROTOCOLS = {"json": m.SUBPROTOCOL_JSON, "msgpack": m.SUBPROTOCOL_MSGPACK}
BOUND_MS = 50.0
A_CROWD = 50
"""People a client process plays; more of them would wait for each other."""


@dataclass(frozen=True, slots=True)
class Load:
    """What a server is put under.

    Attributes:
        stack: ``uvicorn`` (what ships) or a plain listener of ``websockets``.
        coding: What clients speak.
        faces: Whether they send 478 landmarks at 10 Hz beside the body at 30 Hz.
        seconds: For how long, after a warm-up.
        servers: Server processes over which the sessions are spread.
    """

    stack: Stack = "uvicorn"
    coding: Coding = "json"
    faces: bool = True
    seconds: float = 15.0
    servers: int = 1


@dataclass(frozen=True, slots=True)
class LoadResult:
    """Latency under load, clients and server on the same machine.

    Attributes:
        sessions: Sessions at once, each a sensor, a renderer that acks and a monitor.
        load: What else is given.
        p50_ms: From sending the last frame of a window to getting its decision, median.
        p99_ms: Its 99th percentile.
        command_p50_ms: From sending that frame to getting the command, where one follows; None
            without any.
        command_p99_ms: Its 99th percentile.
        dropped: Everything that the server did not use or did not send.
        rss_mb: Resident memory of the server at the end, in MB; of all of them, where it is many.
        decisions: How many were measured.
        commands: How many were measured.
        late_ms: How late the clients themselves sent at worst: when this is large, the machine
            is too small, or too busy, for clients and server together.
        server_cores: Processor time of the server, or servers, over time.
        machine_load: Runnable processes of the whole machine before it began, mean of a minute.
    """

    sessions: int
    load: Load
    p50_ms: float
    p99_ms: float
    command_p50_ms: float | None
    command_p99_ms: float | None
    dropped: int
    rss_mb: float
    decisions: int
    commands: int
    late_ms: float
    server_cores: float
    machine_load: float

    @property
    def holds(self) -> bool:
        """Whether everybody was served in time and nothing was dropped."""
        worst_ms = max(self.p99_ms, self.command_p99_ms or 0.0)
        return worst_ms < BOUND_MS and not self.dropped


@dataclass(frozen=True, slots=True)
class _Figures:
    dropped: int
    rss_mb: float
    cpu_s: float
    at_s: float


async def measure_load(sessions: int, load: Load) -> LoadResult:
    """Start a server process, connect clients, and measure.

    Raises:
        AgentServerError: If the server or a client process fails.
    """
    machine_load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as folder:
        stream = Path(folder) / "stream.msgpack"
        stream.write_bytes(msgspec.msgpack.encode(stream_of(load)))
        async with AsyncExitStack() as stack:
            urls = [
                await stack.enter_async_context(server_process(load.stack, sessions, Path(folder)))
                for _ in range(load.servers)
            ]
            told, before, after = await _play(urls, sessions, load, stream)
    decisions = [ms for one in told for ms in one.decisions_ms]
    commands = [ms for one in told for ms in one.commands_ms]
    if not decisions:
        raise AgentServerError("no decision came back, so nothing was measured")
    figures = percentiles(decisions)
    of_commands = percentiles(commands) if commands else None
    return LoadResult(
        sessions=sessions,
        load=load,
        p50_ms=figures.p50_ms,
        p99_ms=figures.p99_ms,
        command_p50_ms=None if of_commands is None else of_commands.p50_ms,
        command_p99_ms=None if of_commands is None else of_commands.p99_ms,
        dropped=after.dropped - before.dropped,
        rss_mb=round(after.rss_mb, 1),
        decisions=len(decisions),
        commands=len(commands),
        late_ms=round(max(one.late_ms for one in told), 3),
        server_cores=round((after.cpu_s - before.cpu_s) / (after.at_s - before.at_s), 3),
        machine_load=round(machine_load, 2),
    )


async def find_capacity(
    measure: Callable[[int], Awaitable[LoadResult]], start: int, step: int
) -> list[LoadResult]:
    """Double the sessions until the server does not keep up, then halve the gap down to ``step``.

    Args:
        measure: Puts a server under so many sessions.
        start: How many sessions to begin with.
        step: How finely to look.

    Returns:
        All runs, by their sessions.
    """
    runs: dict[int, LoadResult] = {}
    good, bad, sessions = 0, 0, start
    while sessions and sessions not in runs:
        runs[sessions] = await measure(sessions)
        if runs[sessions].holds:
            good = sessions
        else:
            bad = sessions
        middle = (good + bad) // (2 * step) * step
        sessions = 2 * good if not bad else middle if bad - good > step else 0
    return [runs[key] for key in sorted(runs)]


def told_in_a_line(run: LoadResult) -> str:
    """For people who wait."""
    verdict = "holds" if run.holds else "does not hold"
    spread = f" on {run.load.servers} servers" if run.load.servers > 1 else ""
    return (
        f"{run.load.stack}, {run.sessions} sessions{spread}: p50 {run.p50_ms:.1f}, "
        f"p99 {run.p99_ms:.1f} ms, {run.dropped} dropped, {run.rss_mb:.0f} MB, "
        f"{run.server_cores:.2f} cores: {verdict}"
    )


def largest(runs: list[LoadResult]) -> int:
    """The most sessions with which the server kept up; 0 if it never did."""
    return max((run.sessions for run in runs if run.holds), default=0)


def stream_of(load: Load) -> list[Sent]:
    """What every sensor sends: a synthetic person, encoded."""
    codec = CODECS[SUBPROTOCOLS[load.coding]]
    sent = []
    for event in recorded_events("demo"):
        is_body = isinstance(event, SkeletonFrame)
        if is_body or load.faces:
            message = input_to_message(event)
            wire = codec.encode(packed(message) if load.coding == "msgpack" else message)
            data = wire.encode() if isinstance(wire, str) else wire
            sent.append(Sent(event.originating_ns, is_body, data))
    return sent


async def _play(
    urls: list[str], sessions: int, load: Load, stream: Path
) -> tuple[list[Told], _Figures, _Figures]:
    crowds = -(-sessions // A_CROWD)
    processes = []
    for index in range(crowds):
        people = list(range(index, sessions, crowds))
        plan = Plan(urls, str(stream), SUBPROTOCOLS[load.coding], people, load.seconds)
        process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "agent_server.bench.crowd"),
            stdin=PIPE,
            stdout=PIPE,
            limit=2**26,
        )
        processes.append(process)
        await _say(process, msgspec.json.encode(plan) + b"\n")
        await _hear(process)
    begin_s = time.monotonic() + 0.5
    for process in processes:
        await _say(process, f"{begin_s}\n".encode())
    await asyncio.sleep(begin_s + WARM_UP_S - time.monotonic())
    before = await asyncio.to_thread(_figures, urls)
    await asyncio.sleep(load.seconds)
    after = await asyncio.to_thread(_figures, urls)
    told = [msgspec.json.decode(await _hear(process), type=Told) for process in processes]
    for process in processes:
        await process.wait()
    return told, before, after


async def _say(process: Process, line: bytes) -> None:
    assert process.stdin is not None  # noqa: S101 - it was asked for
    process.stdin.write(line)
    await process.stdin.drain()


async def _hear(process: Process) -> bytes:
    assert process.stdout is not None  # noqa: S101 - it was asked for
    line = await process.stdout.readline()
    if not line:
        raise AgentServerError("a process of the measurement has ended; it says why above")
    return line


def _figures(urls: list[str]) -> _Figures:
    samples = [
        sample
        for url in urls
        for family in text_string_to_metric_families(_metrics(url))
        for sample in family.samples
    ]

    def total(name: str) -> float:
        return sum(sample.value for sample in samples if sample.name == name)

    return _Figures(
        dropped=int(total("agent_server_dropped_total")),
        rss_mb=total("process_resident_memory_bytes") / 2**20,
        cpu_s=total("process_cpu_seconds_total"),
        at_s=time.monotonic(),
    )


def _metrics(url: str) -> str:
    with urllib.request.urlopen(f"{url}/metrics", timeout=30) as answer:  # noqa: S310 - our own
        return str(answer.read().decode())


@asynccontextmanager
async def server_process(
    stack: Stack, sessions: int, folder: Path, settings_toml: str = ""
) -> AsyncIterator[str]:
    """A server in a process of its own, on a free port; gives its address.

    Args:
        stack: What carries its websockets.
        sessions: How many it must admit.
        folder: Where its settings may be written; they are read before it gives its address.
        settings_toml: Further settings of its section ``server``.

    Raises:
        AgentServerError: If it does not start.
    """
    settings = folder / "settings.toml"
    settings.write_text(
        f"[server]\nport = 0\nmax_sessions = {sessions}\nmax_connections = {4 * sessions + 8}\n"
        f"max_connections_per_address = {4 * sessions + 8}\n{settings_toml}"
    )
    command = {
        "uvicorn": ("-m", "agent_server", "serve", "--json", "--config", str(settings)),
        "websockets": ("-m", "agent_server.bench.plain", str(settings)),
    }
    process = await asyncio.create_subprocess_exec(
        sys.executable, *command[stack], stdout=PIPE, stderr=asyncio.subprocess.DEVNULL
    )
    try:
        assert process.stdout is not None  # noqa: S101 - it was asked for
        line = await process.stdout.readline()
        if not line:
            raise AgentServerError("the server did not start; `agent-server serve` says why")
        yield json.loads(line)["address"]
    finally:
        if process.returncode is None:
            process.terminate()
        await process.wait()
