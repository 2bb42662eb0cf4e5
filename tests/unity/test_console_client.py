"""The C# console client against a real server: commands arrive, are carried out, and once."""

import asyncio
import json
from contextlib import asynccontextmanager

import pytest

from agent_server.client import Monitor, Options, Sensor
from agent_server.config import GateSettings, ServerSettings, Settings
from agent_server.protocol import messages as m
from tests.support.bodies import stream
from tests.support.live import live
from tests.support.patience import PATIENCE_S, patience, until
from tests.unity.build import console_client, needs_mono

pytestmark = needs_mono

GESTURE = stream(6, hands_up=lambda t: 2 <= t < 4)


@pytest.fixture(autouse=True, scope="module")
def _built():
    """Compile before a server runs: it would stand still meanwhile."""
    console_client()


class Console:
    """A running console client and what it has said."""

    def __init__(self, process):
        self.process = process
        self.said = []

    async def until(self, event, **fields):
        """The next line of an event with these fields; others are kept in ``said``."""
        async with patience():
            async for line in self.process.stdout:
                said = json.loads(line)
                self.said.append(said)
                if said["event"] == event and fields.items() <= said.items():
                    return said
        raise AssertionError(f"no {event}: {self.said}")

    async def goodbye(self):
        self.process.stdin.close()
        await self.until("end")
        return await asyncio.wait_for(self.process.wait(), PATIENCE_S)

    def events(self, event):
        return [said for said in self.said if said["event"] == event]


@asynccontextmanager
async def console(url, *arguments):
    process = await asyncio.create_subprocess_exec(
        *("mono", str(console_client()), "--url", url, "--session", "s", "--json", *arguments),
        stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE,
    )
    try:
        yield Console(process)
    finally:
        if process.returncode is None:
            process.kill()
        await process.wait()


async def gesture(server):
    """Somebody covers their ears."""
    async with Sensor(Options(server.url, "s", hello={"face": "none"})) as sensor:
        await until(lambda: sensor.link.phase == "live")
        for frame in GESTURE:
            await sensor.send(frame)
            await asyncio.sleep(0.001)


@asynccontextmanager
async def watched(server):
    """What monitors hear of acks and of the room."""
    acks, scenes = [], []

    async def listen():
        async with Monitor(Options(server.url, "s"), ["ack", "scene"]) as monitor:
            async for message in monitor:
                if isinstance(message, m.AckTelemetry):
                    acks.append((message.command_id, message.status))
                elif isinstance(message, m.SceneState):
                    scenes.append(message)

    task = asyncio.create_task(listen())
    try:
        yield acks, scenes
    finally:
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)


def settings(folder=None, **server):
    server = ServerSettings(state=folder and str(folder), **server)
    return Settings(gate=GateSettings(mode="off"), server=server)


@pytest.mark.parametrize("coding", ["json", "msgpack"])
async def test_a_command_arrives_and_the_room_changes(coding):
    async with (
        live(settings=settings()) as server,
        watched(server) as (acks, scenes),
        console(server.url, "--coding", coding, "--step-scale", "0.05") as renderer,
    ):
        welcome = await renderer.until("welcome")
        assert welcome["ledger"] and welcome["epoch"] and not welcome["resumed"]
        await asyncio.sleep(0.3)  # the clocks are compared by then
        await gesture(server)
        command = await renderer.until("command")
        assert command["latency_ns"] is not None
        assert abs(command["latency_ns"] - command["direct_ns"]) < 20e6
        await renderer.until("effect", id=command["id"])
        await until(lambda: (command["id"], "done") in acks)
        statuses = [status for one, status in acks if one == command["id"]]
        assert statuses[:2] == ["accepted", "started"]
        assert statuses[-1] == "done"
        await until(lambda: any(scene.objects["hifi"] == "low" for scene in scenes))
        assert await renderer.goodbye() == 0
        assert not renderer.events("cancel")


async def test_a_server_that_restarts_gets_the_command_done_once(tmp_path):
    chosen = settings(tmp_path)
    async with live(settings=chosen) as server:
        port = int(server.url.rpartition(":")[2])
        renderer_context = console(server.url, "--step-scale", "0.5")
        renderer = await renderer_context.__aenter__()
        welcome = await renderer.until("welcome")
        await gesture(server)
        command = await renderer.until("command")
    try:
        async with live(settings=chosen, port=port) as server, watched(server) as (acks, _):
            again = await renderer.until("welcome")
            assert again["resumed"]
            assert again["ledger"] == welcome["ledger"]
            assert again["epoch"] != welcome["epoch"]
            await until(lambda: (command["id"], "done") in acks)
            assert await renderer.goodbye() == 0
            assert renderer.events("effect") == [{"event": "effect", "id": command["id"]}]
            assert len(renderer.events("command")) == 1
    finally:
        await renderer_context.__aexit__(None, None, None)


async def test_a_monitor_prints_what_comes():
    async with (
        live(settings=settings()) as server,
        console(server.url, "--role", "monitor") as monitor,
    ):
        await monitor.until("welcome")
        await gesture(server)
        await monitor.until("message", type="pose")
        assert await monitor.goodbye() == 0


async def test_a_server_that_is_not_there_is_waited_for():
    async with console("ws://127.0.0.1:9", "--session", "s") as renderer:
        waiting = await renderer.until("phase", phase="waiting")
        assert "cannot connect to ws://127.0.0.1:9/v1/sessions/s/renderer" in waiting["fault"]
        assert await renderer.goodbye() == 0


async def test_a_taken_place_ends_the_client():
    async with live(settings=settings()) as server, console(server.url) as first:
        await first.until("welcome")
        async with console(server.url) as second:
            stopped = await second.until("phase", phase="stopped")
            assert stopped["fault"]
            assert await asyncio.wait_for(second.process.wait(), PATIENCE_S) == 1


async def test_wrong_arguments_are_refused():
    process = await asyncio.create_subprocess_exec(
        *("mono", str(console_client()), "--role", "sensor"), stderr=asyncio.subprocess.PIPE
    )
    _, errors = await process.communicate()
    assert process.returncode == 2
    assert b"--role is 'sensor': give renderer or monitor" in errors
