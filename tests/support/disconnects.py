"""Forced disconnects of one language's client, and whether its commands took effect once.

Several sessions at once, in both codings, each with a sensor, a monitor, and a client behind a
proxy that cuts its connections. Every so often the server is killed and started again.
"""

import asyncio
import random
import tempfile
import time
from collections import Counter
from contextlib import AsyncExitStack
from dataclasses import dataclass, replace
from pathlib import Path

from tests.support.command_fates import Observed, summary
from tests.support.connection_figures import Restart, resumes, unforced, welcomes
from tests.support.console_clients import GOODBYE_S, console
from tests.support.fault_proxy import FaultProxy
from tests.support.faults import Delay, Where, faults
from tests.support.observers import Presence, act, watch
from tests.support.server_process import server_process

START_S = 30.0
SETTLE_S = 30.0
QUIET_S = 1.5
BACK_S = 20.0
"""A client that is not back by then never will be."""
POLL_S = 0.01
_AFTER_A_RESTART = (Where.COMMAND, Where.ACK, Where.BETWEEN)
_HANDSHAKE = (Where.REQUEST, Where.RESPONSE)


@dataclass(frozen=True, slots=True)
class Trial:
    """What is tried.

    Attributes:
        language: ``python``, ``csharp`` or ``node``.
        count: Forced disconnects.
        seed: Of all chance.
        restart_every: One disconnect in so many is a server that is killed and started again.
        lanes: Sessions at once.
        delay: How late bytes pass between client and server; None: at once.
    """

    language: str
    count: int
    seed: int = 0
    restart_every: int = 10
    lanes: int = 2
    delay: Delay | None = None


class Lane:
    """One session: its client behind the proxy, and what was seen of its commands."""

    def __init__(self, trial, index, port):
        self.session = f"lane{index}"
        self.coding = ("json", "msgpack")[index % 2]
        self.observed = Observed(self.session)
        self.monitor = Presence()
        self.told_ns = time.monotonic_ns()
        self.console = None
        self.heard_lines = 0
        self._faults = faults(random.Random(f"{trial.seed} {index}"))
        self._failed_in_a_row = 0
        self.is_new_server = True
        self.is_calm = False
        self.proxy = FaultProxy(port, self._plan, trial.delay, trial.seed)

    @property
    def is_live(self):
        return bool(self.proxy.connections) and self.proxy.connections[-1].is_live

    def tell(self, message):
        if message["type"] in ("command", "ack_state"):
            self.told_ns = time.monotonic_ns()
            self.observed.tell(message)

    def _plan(self):
        """The next connection's fault."""
        if self.is_calm:
            return None
        fault = next(self._faults)
        # How fast a client is back after a restart, or at all, is not to be a matter of the proxy.
        if self.is_new_server:
            self.is_new_server = False
            while fault.where not in _AFTER_A_RESTART:
                fault = next(self._faults)
            return replace(fault, after_s=max(fault.after_s, 0.3))
        self._failed_in_a_row = self._failed_in_a_row + 1 if fault.where in _HANDSHAKE else 0
        while self._failed_in_a_row > 2 and fault.where in _HANDSHAKE:
            fault = next(self._faults)
        return fault


class Run:
    """One trial, as it goes."""

    def __init__(self, trial, server):
        self._trial = trial
        self._server = server
        self._random = random.Random(f"{trial.seed} server")
        self._lanes = [Lane(trial, index, server.port) for index in range(trial.lanes)]
        self._restarts = []
        self._hit_by_restarts = 0
        self._open_at_death = 0
        self._may_act = asyncio.Event()
        self._is_over = asyncio.Event()

    async def run(self):
        """Do it all; gives the figures.

        Raises:
            AssertionError: If a client does not begin, or does not come back.
        """
        start_s = time.monotonic()
        async with AsyncExitStack() as stack:
            group = await stack.enter_async_context(asyncio.TaskGroup())
            await self._server.start()
            tasks = [
                group.create_task(work)
                for lane in self._lanes
                for work in (
                    watch(self._server.port, lane.session, lane.tell, lane.monitor),
                    act(self._server.port, lane.session, self._may_act, self._is_over),
                )
            ]
            for lane in self._lanes:
                await lane.monitor.joined.wait()
                port = await stack.enter_async_context(lane.proxy.serving())
                lane.console = await stack.enter_async_context(
                    console(
                        self._trial.language,
                        f"ws://127.0.0.1:{port}",
                        lane.session,
                        coding=lane.coding,
                    )
                )
            for lane in self._lanes:
                await lane.console.until("welcome", START_S)
            self._may_act.set()
            await self._disconnect()
            disconnecting_s = time.monotonic() - start_s
            settled = await self._settle()
            for lane in self._lanes:
                await lane.console.goodbye()
                await _until(lambda lane=lane: not lane.is_live, GOODBYE_S)
            for task in tasks:
                task.cancel()
        return self._figures(disconnecting_s, settled)

    # ------------------------------------------------------------------ what is done

    @property
    def _count(self):
        return self._hit_by_restarts + sum(len(lane.proxy.cuts) for lane in self._lanes)

    async def _disconnect(self):
        trial = self._trial
        while self._count < trial.count:
            await asyncio.sleep(POLL_S)
            if self._count >= (len(self._restarts) + 1) * trial.restart_every - 1:
                await self._restart()
            self._check()

    async def _restart(self):
        """Kill the server at some moment, and start it again.

        Only while a connection is live, and not before the first commands were issued: until then
        it has nothing to remember.
        """
        await asyncio.sleep(self._random.uniform(0.0, 0.3))
        hit = sum(lane.is_live for lane in self._lanes)
        if hit == 0 or not all(lane.observed.sequence for lane in self._lanes):
            return
        self._hit_by_restarts += hit
        killed_ns = await self._server.kill()
        self._may_act.clear()
        for lane in self._lanes:
            lane.proxy.is_open = False
        for lane in self._lanes:
            await lane.monitor.parted.wait()
            room = self._server.saved(lane.session).room
            lane.observed.die(room)
            self._open_at_death += room.command is not None
        await asyncio.sleep(self._random.choice((0.05, 0.3, 1.0, 2.0)))
        await self._server.start()
        # Nothing is to happen that no monitor sees.
        for lane in self._lanes:
            await lane.monitor.joined.wait()
        for lane in self._lanes:
            lane.is_new_server = True
            lane.proxy.is_open = True
        self._restarts.append(Restart(killed_ns, time.monotonic_ns()))
        self._may_act.set()

    def _check(self):
        """Fail at once where a client has ended, or has stopped to try."""
        now_ns = time.monotonic_ns()
        for lane in self._lanes:
            status = lane.console.process.returncode
            assert status is None, f"ended by itself, {status}: {lane.console.errors[-2000:]!r}"
            for line in lane.console.lines[lane.heard_lines :]:
                lane.observed.hear(line.said)
            lane.heard_lines = len(lane.console.lines)
            silent_s = (now_ns - lane.proxy.connections[-1].opened_ns) / 1e9
            assert lane.is_live or silent_s < BACK_S, (
                f"{lane.session} has not come back for {silent_s:.0f} s: "
                f"{lane.console.lines[-5:]} {lane.console.errors[-2000:]!r}"
            )

    async def _settle(self):
        """Let connections be, and what is open come to its end; tells whether all did."""
        for lane in self._lanes:
            lane.is_calm = True
        # A fault that is planned already may still come.
        self._is_over.set()
        end_s = time.monotonic() + SETTLE_S
        while time.monotonic() < end_s:
            await asyncio.sleep(POLL_S)
            self._check()
            quiet_ns = time.monotonic_ns() - max(lane.told_ns for lane in self._lanes)
            is_idle = all(lane.is_live and not self._is_waiting(lane) for lane in self._lanes)
            if is_idle and quiet_ns > QUIET_S * 1e9:
                return True
        return False

    def _is_waiting(self, lane):
        return any(lane.observed.fate(one) is None for one in lane.observed.ids)

    # ------------------------------------------------------------------ what came of it

    def _figures(self, disconnecting_s, settled):
        for lane in self._lanes:
            for line in lane.console.lines[lane.heard_lines :]:
                lane.observed.hear(line.said)
        cuts = [cut for lane in self._lanes for cut in lane.proxy.cuts]
        trial = self._trial
        return {
            "language": trial.language,
            "seed": trial.seed,
            "seconds": round(disconnecting_s, 1),
            "disconnects": self._count,
            "where": dict(Counter(str(cut.where) for cut in cuts)),
            "how": dict(Counter(str(cut.how) for cut in cuts)),
            "restarts": len(self._restarts),
            "hit_by_restarts": self._hit_by_restarts,
            "open_at_restarts": self._open_at_death,
            **summary([lane.observed for lane in self._lanes]),
            **resumes(self._lanes, self._restarts),
            **welcomes(self._lanes),
            "unforced": unforced(self._lanes, self._restarts),
            "settled": settled,
            "goodbyes": [lane.proxy.connections[-1].close_code for lane in self._lanes],
        }


async def _until(condition, within_s):
    async with asyncio.timeout(within_s):
        while not condition():  # noqa: ASYNC110 - what it asks knows no events
            await asyncio.sleep(POLL_S)


async def run_trial(trial):
    """Run a trial with a server of its own; gives its figures."""
    with tempfile.TemporaryDirectory(prefix="disconnects") as folder:
        async with server_process(Path(folder)) as server:
            return await Run(trial, server).run()
