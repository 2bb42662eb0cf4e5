"""What happens to the server, what was promised for it, and what is seen: one function each."""

import asyncio
import json
import signal
import sys
import tempfile
import time
from collections import Counter
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from itertools import pairwise
from pathlib import Path

import msgspec

from agent_server.client.link import Options
from agent_server.client.once import ConnectionFailed
from agent_server.client.renderer import Renderer
from agent_server.client.timed import TimedRenderer
from agent_server.clock import SystemClock
from agent_server.config import GateSettings, ServerSettings, Settings
from agent_server.errors import RecordingError
from agent_server.protocol import messages as m
from agent_server.protocol.convert import skeleton_to_message
from agent_server.recording.reader import open_recording
from agent_server.recording.recover import recover
from agent_server.scene.rules import default_rules
from agent_server.service.auth import Access, issue
from agent_server.service.hub import Hub
from agent_server.service.store import FolderStore
from tests.support.bodies import stream
from tests.support.command_fates import WRONG
from tests.support.disconnects import Trial, run_trial
from tests.support.fault_proxy import FaultProxy
from tests.support.faults import Delay, Fault, How, Where
from tests.support.live import live
from tests.support.models import fake_models
from tests.support.observers import Presence, act, watch

ROOT = Path(__file__).parents[2]
DRAIN_S = 10.0
HOLE_AFTER_S = 1.0
MANY = 10
HOURS_NS = 5 * 3600 * 1_000_000_000
SECRET = "for tests alone, and long enough for it"  # noqa: S105


@asynccontextmanager
async def scripted(folder, *options):
    """The scripted server in a process of its own, with state and recordings in ``folder``."""
    with (folder / "log").open("wb") as log:
        process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "tests.support.scripted_server", "--json"),
            *("--state", str(folder / "state"), "--record", str(folder / "recordings")),
            *options,
            stdout=asyncio.subprocess.PIPE,
            stderr=log,
            cwd=ROOT,
        )
    try:
        line = json.loads(await process.stdout.readline())
        yield process, line["address"]
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()


class Told:
    """What a session's monitor was told."""

    def __init__(self, session):
        self.session = session
        self.kinds = Counter()
        self.errors = Counter()
        self.issued = []
        self.ends = {}
        self.is_there = Presence()

    def take(self, message):
        kind = message["type"]
        self.kinds[kind] += 1
        if kind == "error":
            self.errors[message["code"]] += 1
        elif kind == "command":
            self.issued.append(message["id"])
        elif kind == "ack_state":
            self.ends[message["command_id"]] = message["status"]


class Crew:
    """Sensor, renderer and monitor of some sessions, in real time, until left."""

    def __init__(self, url, sessions):
        self._url = url
        self._port = int(url.rpartition(":")[2])
        self.told = [Told(f"chaos{index}") for index in range(sessions)]
        self.effects = Counter()
        self._is_over = asyncio.Event()
        self._may_send = asyncio.Event()
        self._may_send.set()

    async def __aenter__(self):
        self._stack = AsyncExitStack()
        self._group = await self._stack.enter_async_context(asyncio.TaskGroup())
        topics = ("command", "ack", "decision", "error")
        self._tasks = []
        for told in self.told:
            self._tasks += [
                self._group.create_task(
                    watch(self._port, told.session, told.take, told.is_there, topics)
                ),
                self._group.create_task(self._carry_out(told.session)),
            ]
            await told.is_there.joined.wait()
            self._tasks.append(
                self._group.create_task(
                    act(self._port, told.session, self._may_send, self._is_over)
                )
            )
        return self

    async def __aexit__(self, *_):
        for task in self._tasks:
            task.cancel()
        with suppress(asyncio.CancelledError):
            await self._stack.aclose()

    async def _carry_out(self, session):
        crew = self

        class Counting(TimedRenderer):
            async def _perform(self, command):
                crew.effects[command.id] += 1
                await super()._perform(command)

        with suppress(ConnectionFailed):
            async with Renderer(Options(self._url, session, "chaos")) as renderer:
                await Counting(renderer, 0.05).run()


def outcome(name, promised, kept, **seen):
    return {"name": name, "promised": promised, "kept": bool(kept), "seen": seen}


# ---------------------------------------------------------------------- the process


async def killed(count=40):
    """kill -9, again and again, with clients whose connections break too."""
    figures = await run_trial(Trial("python", count, seed=3, restart_every=4))
    wrong = {name: figures[name] for name in WRONG if figures[name]}
    return outcome(
        "kill -9 and restart",
        "every command takes effect once, none is lost, clients resume",
        figures["settled"] and not wrong,
        restarts=figures["restarts"],
        disconnects=figures["disconnects"],
        commands=figures["commands"],
        lost=len(figures["lost"]),
        doubled=len(figures["doubled"]),
        wrong=wrong,
        resume_after_restart_ms=figures["restart_resume_ms"],
    )


async def stopped(sessions=6, seconds=6.0):
    """SIGTERM while sessions send, decide and record."""
    with tempfile.TemporaryDirectory(prefix="chaos") as name:
        folder = Path(name)
        async with scripted(folder) as (process, url), Crew(url, sessions) as crew:
            await asyncio.sleep(seconds)
            asked_s = time.monotonic()
            process.send_signal(signal.SIGTERM)
            status = await asyncio.wait_for(process.wait(), 3 * DRAIN_S)
            took_s = time.monotonic() - asked_s
            await asyncio.sleep(0.3)
        whole, damaged = _recordings(folder)
        store = FolderStore(folder / "state", time.time_ns())
        saved = {told.session: store.load(told.session) for told in crew.told}
        given, open_now, lost = _accounts(crew, saved)
        return outcome(
            "SIGTERM under load",
            "ends with status 0 in under 10 s; recordings are whole; each command was delivered "
            "or is remembered for the next start",
            status == 0 and took_s < DRAIN_S and not damaged and not lost and whole >= sessions,
            status=status,
            seconds=round(took_s, 2),
            sessions=sessions,
            recordings_whole=whole,
            recordings_damaged=damaged,
            commands=given,
            remembered=open_now,
            lost=lost,
        )


def _recordings(folder):
    whole, damaged = 0, 0
    for path in (folder / "recordings").glob("*.mcap"):
        try:
            open_recording(path)
            whole += 1
        except RecordingError:
            damaged += 1
    return whole, damaged


def _accounts(crew, saved):
    """Commands that were issued, those that wait for the next start, and those that are lost."""
    given = open_now = 0
    lost = []
    for told in crew.told:
        room = saved[told.session].room
        running = None if room.command is None else room.command.id
        open_now += running is not None
        given += len(told.issued)
        for one in told.issued:
            # What has begun and was overtaken by the stop is told by the state that was saved.
            is_accounted = one in told.ends or one == running or crew.effects[one] == 1
            if not is_accounted or crew.effects[one] > 1:
                lost.append(one)
    return given, open_now, lost


async def disk_full(seconds=8.0, largest_file=60_000):
    """No file can grow beyond a size: every write beyond it fails as on a full disk."""
    with tempfile.TemporaryDirectory(prefix="chaos") as name:
        folder = Path(name)
        limit = ("--largest-file", str(largest_file))
        async with scripted(folder, *limit) as (process, url), Crew(url, 2) as crew:
            async with asyncio.timeout(60):
                while not all(told.errors["recording_failed"] for told in crew.told):  # noqa: ASYNC110
                    await asyncio.sleep(0.1)
            before = [told.kinds["decision"] for told in crew.told]
            await asyncio.sleep(seconds / 4)
            after = [told.kinds["decision"] for told in crew.told]
            is_alive = process.returncode is None
        kept = 0
        for path in (folder / "recordings").glob("*.mcap"):
            whole = path.with_suffix(".whole")
            recover(path, whole)
            kept += sum(1 for _ in open_recording(whole).entries())
        decided = [late - early for early, late in zip(before, after, strict=True)]
        return outcome(
            "disk full",
            "sessions go on, monitors are told once, the recording is kept up to its last whole "
            "chunk",
            is_alive and min(decided) > 0 and kept > 0,
            told=[told.errors["recording_failed"] for told in crew.told],
            decisions_afterwards=decided,
            entries_recovered=kept,
        )


# ---------------------------------------------------------------------- time


class SteppedClock(SystemClock):
    """The machine's clock, whose wall time is set now and then."""

    def __init__(self):
        self.step_ns = 0

    def wall_ns(self):
        return super().wall_ns() + self.step_ns


async def clock_stepped():
    """The server's wall clock is set by hours, forth and back, while a session runs."""
    clock = SteppedClock()
    settings = Settings(gate=GateSettings(mode="off"), server=ServerSettings(heartbeat_s=0.2))
    models = fake_models()
    hub = Hub(settings, default_rules(models.classifier.labels), models, clock)
    token = issue(SECRET, "chaos", ["sensor", "monitor", "renderer"], None, 600)
    hello = m.Hello(m.PROTOCOL, "chaos", token=token)
    decisions, commands, errors = [], [], []
    async with (
        live(models, settings, hub=hub, access=Access({}, SECRET)) as server,
        server.join("monitor", hello=hello) as monitor,
        server.join("sensor", hello=msgspec.structs.replace(hello, face="none")) as sensor,
    ):
        listening = asyncio.create_task(_sort(monitor, decisions, commands, errors))
        for index, one in enumerate(stream(9, hands_up=lambda t: 2 <= t < 4 or 6 <= t < 8)):
            clock.step_ns = {60: HOURS_NS, 120: -HOURS_NS}.get(index, clock.step_ns)
            await sensor.send(skeleton_to_message(one))
            await asyncio.sleep(1 / 60)
        await asyncio.sleep(0.5)
        listening.cancel()
        clients = len(hub.sessions["s"].audience.clients)
    steps = sorted(
        late.decision.end_ns - early.decision.end_ns for early, late in pairwise(decisions)
    )
    return outcome(
        "clock stepped by 5 h, forth and back",
        "decisions, commands and connections go on as if nothing had happened; tokens are not "
        "outlived nor cut short",
        clients == 2 and commands and not errors and steps[0] > 0 and steps[-1] < 1_000_000_000,
        decisions=len(decisions),
        commands=len(commands),
        errors=errors,
        clients_left=clients,
        longest_step_ms=round(steps[-1] / 1e6),
    )


async def _sort(monitor, decisions, commands, errors):
    async for message in monitor:
        match message:
            case m.DecisionMessage():
                decisions.append(message)
            case m.CommandMessage():
                commands.append(message)
            case m.ErrorMessage():
                errors.append(message.code)


# ---------------------------------------------------------------------- the network


async def black_holed(heartbeat_s=0.4):
    """All that a renderer sends and gets vanishes, without an end of the connection."""
    settings = Settings(
        gate=GateSettings(mode="off"), server=ServerSettings(heartbeat_s=heartbeat_s)
    )
    hole = [Fault(Where.BETWEEN, How.HOLE, after_s=HOLE_AFTER_S, hold_s=10.0)]
    others = []
    async with live(settings=settings) as server, AsyncExitStack() as stack:
        proxy = FaultProxy(int(server.url.rpartition(":")[2]), lambda: hole.pop() if hole else None)
        port = await stack.enter_async_context(proxy.serving())
        other = await stack.enter_async_context(server.join("monitor", "other"))
        sensor = await stack.enter_async_context(server.join("sensor", "other"))
        listening = asyncio.create_task(_sort(other, others, [], []))
        options = Options(f"http://127.0.0.1:{port}", "s", "chaos")
        renderer = await stack.enter_async_context(Renderer(options))
        frames = iter(stream(60))
        start_s = time.monotonic()
        async with asyncio.timeout(30):
            back_s = None
            while back_s is None or len(others) < MANY:
                if back_s is None and renderer.link.connections == 2:
                    back_s = time.monotonic() - start_s - HOLE_AFTER_S
                await sensor.send(skeleton_to_message(next(frames)))
                await asyncio.sleep(1 / 30)
        clients = [one.role for one in server.hub.sessions["s"].audience.clients]
        listening.cancel()
    slowest_ms = max((one.timing.total_ms for one in others), default=None)
    return outcome(
        "client black-holed",
        "both sides give the connection up after 2.5 heartbeats, the client is back and has its "
        "place again; no other session waits",
        back_s < 5 * heartbeat_s + 2.0 and clients.count("renderer") <= 2,
        back_after_s=round(back_s, 2),
        heartbeat_s=heartbeat_s,
        decisions_of_another=len(others),
        slowest_decision_ms_of_another=slowest_ms,
    )


async def bad_network(count=12):
    """10 % of what is sent is lost and sent again, all comes up to 200 ms late, and links break."""
    delay = Delay(base_s=0.02, jitter_s=0.2, loss=0.1)
    figures = await run_trial(Trial("python", count, seed=5, restart_every=10**6, delay=delay))
    wrong = {name: figures[name] for name in WRONG if figures[name]}
    return outcome(
        "10 % loss, 200 ms jitter",
        "every command takes effect once, none is lost",
        figures["settled"] and not wrong,
        disconnects=figures["disconnects"],
        commands=figures["commands"],
        lost=len(figures["lost"]),
        doubled=len(figures["doubled"]),
        wrong=wrong,
        resume_ms=figures["resume_ms"],
    )


SCENARIOS = (killed, stopped, disk_full, clock_stepped, black_holed, bad_network)
