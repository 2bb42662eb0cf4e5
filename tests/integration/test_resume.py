"""Renderers whose connection breaks, and servers that restart: commands take effect once."""

import asyncio
from contextlib import asynccontextmanager, suppress

import msgspec
import pytest

from agent_server.client import Cancelled, ConnectionFailed, Monitor, Options, Renderer, Sensor
from agent_server.config import GateSettings, ServerSettings, Settings
from agent_server.protocol import messages as m
from agent_server.protocol.codes import CLOSE_REPLACED, CLOSE_SILENT
from agent_server.recording.reader import open_recording
from agent_server.service.core import Core
from agent_server.service.replay import log_line, replay
from agent_server.service.store import FolderStore
from agent_server.transports.server import build_hub
from tests.support.bodies import stream
from tests.support.live import live, next_of
from tests.support.models import fake_models
from tests.support.patience import PATIENCE_S, until

GESTURE = stream(6, hands_up=lambda t: 2 <= t < 4)
OBJECTS = {"window": "open", "hifi": "high", "cigarette": "lit", "curtain": "open"}


def settings(folder=None, **server):
    server = ServerSettings(state=folder and str(folder), **server)
    return Settings(gate=GateSettings(mode="off"), server=server)


def raw_hello(**fields):
    return m.Hello(m.PROTOCOL, "raw", capabilities=["resume"], **fields)


async def gesture(server):
    """Somebody covers their ears, and does not leave."""
    async with Sensor(Options(server.url, "s", hello={"face": "none"})) as sensor:
        await until(lambda: sensor.link.phase == "live")
        for frame in GESTURE:
            assert await sensor.send(frame)
            await asyncio.sleep(0.001)


async def event_of(events, kind, within_s=PATIENCE_S):
    """The next event of a kind; others are passed over."""
    async with asyncio.timeout(within_s):
        async for event in events:
            if isinstance(event, kind):
                return event
    raise AssertionError("the events ended")


async def cut(renderer):
    """Break the connection without a goodbye."""
    renderer.link._socket.transport.abort()
    await until(lambda: renderer.link.phase != "live")


@asynccontextmanager
async def ends_of(server):
    """How commands end, by their id, as monitors hear of it."""
    ends = {}

    async def listen():
        async with Monitor(Options(server.url, "s"), ["ack"]) as monitor:
            async for message in monitor:
                if isinstance(message, m.AckTelemetry):
                    ends[message.command_id] = message.status

    task = asyncio.create_task(listen())
    await asyncio.sleep(0.1)
    try:
        yield ends
    finally:
        task.cancel()
        with suppress(asyncio.CancelledError):
            await task


async def test_a_renderer_that_was_cut_off_gets_what_is_not_over_and_does_it_once():
    async with (
        live(settings=settings()) as server,
        ends_of(server) as ends,
        Renderer(Options(server.url, "s")) as renderer,
    ):
        events = aiter(renderer)
        first = await event_of(events, m.Welcome)
        assert not first.resumed
        await gesture(server)
        command = await event_of(events, m.CommandMessage)
        assert renderer.start(command.id)
        await cut(renderer)
        back = await event_of(events, m.Welcome)
        assert back.resumed
        assert (back.epoch, back.ledger, back.sequence) == (first.epoch, first.ledger, 1)
        assert back.scene.command_id == command.id
        assert renderer.done(command.id)
        assert not renderer.done(command.id)
        await until(lambda: ends.get(command.id) == "done")
        session = server.hub.sessions["s"]
        assert session.delivery.scene().objects["hifi"] == "low"
        assert session.counters["resent_commands"] == 1
        # It was sent twice, and the application has heard of it once.
        with pytest.raises(TimeoutError):
            await event_of(events, m.CommandMessage, within_s=0.3)


async def test_what_was_said_while_there_was_no_connection_is_said_later():
    async with live(settings=settings()) as server, ends_of(server) as ends:
        async with Renderer(Options(server.url, "s")) as renderer:
            events = aiter(renderer)
            await gesture(server)
            command = await event_of(events, m.CommandMessage)
            assert renderer.start(command.id)
            renderer.link._backoff._random = lambda: 1.0
            await cut(renderer)
            assert renderer.done(command.id)
            await until(lambda: ends.get(command.id) == "done")
        assert server.hub.sessions["s"].counters["commands_done"] == 1


async def test_a_command_that_nobody_starts_in_time_expires_and_is_not_sent_again():
    async with (
        live(settings=settings()) as server,
        ends_of(server) as ends,
        server.join("renderer", hello=raw_hello()) as renderer,
    ):
        await gesture(server)
        command = await next_of(renderer, m.CommandMessage)
        renderer._socket.transport.abort()
        await until(lambda: ends.get(command.id) == "expired")
        async with server.join("renderer", hello=raw_hello(ledger="x")) as late:
            assert late.welcome.scene.objects == OBJECTS
            assert late.welcome.scene.command_id != command.id


async def test_a_renderer_keeps_its_seat_for_a_while_and_then_the_room_goes_on_by_itself():
    async with live(settings=settings(resume_s=0.3)) as server, ends_of(server) as ends:
        async with server.join("renderer", hello=raw_hello()) as renderer:
            await gesture(server)
            command = await next_of(renderer, m.CommandMessage)
            await renderer.send(m.AckMessage(command.id, "started"))
            renderer._socket.transport.abort()
        await until(lambda: ends.get(command.id) == "assumed")
        assert server.hub.sessions["s"].delivery.scene().objects["hifi"] == "low"


async def test_one_that_says_goodbye_leaves_the_room_to_itself_at_once():
    async with live(settings=settings(resume_s=60)) as server, ends_of(server) as ends:
        async with server.join("renderer", hello=raw_hello()) as renderer:
            await gesture(server)
            command = await next_of(renderer, m.CommandMessage)
        await until(lambda: ends.get(command.id) == "assumed")
        assert server.hub.sessions["s"].delivery.scene().objects["hifi"] == "low"


async def test_a_connection_takes_the_place_of_an_earlier_one_of_the_same_client():
    mine = raw_hello(instance="mine")
    async with live(settings=settings()) as server, server.join("renderer", hello=mine) as old:
        async with server.join("renderer", hello=mine) as new:
            assert new.welcome.role == "renderer"
            with pytest.raises(ConnectionFailed, match=str(CLOSE_REPLACED)):
                await next_of(old, m.Pong)
        with pytest.raises(ConnectionFailed, match="another renderer acts"):
            async with (
                server.join("renderer", hello=raw_hello(instance="a")),
                server.join("renderer", hello=raw_hello(instance="b")),
            ):
                pass


async def test_a_client_that_was_replaced_stays_away_and_says_so():
    async with live(settings=settings()) as server, Renderer(Options(server.url, "s")) as first:
        await event_of(aiter(first), m.Welcome)
        async with Renderer(Options(server.url, "s", take_over=True)) as second:
            await event_of(aiter(second), m.Welcome)
            with pytest.raises(ConnectionFailed, match="took over"):
                await event_of(aiter(first), m.Pong)


async def test_a_restarted_server_goes_on_with_the_room_and_the_open_command(tmp_path):
    at_start = {}
    async with live(settings=settings(tmp_path)) as server:
        port = int(server.url.rpartition(":")[2])
        renderer = Renderer(Options(server.url, "s"))
        await renderer.__aenter__()
        events = aiter(renderer)
        at_start = await event_of(events, m.Welcome)
        await renderer.report("window", "closed")
        await gesture(server)
        command = await event_of(events, m.CommandMessage)
        assert renderer.start(command.id)
    # The server has stopped; what is said now is said to the next one.
    assert renderer.done(command.id)
    async with live(settings=settings(tmp_path), port=port) as server:
        back = await event_of(events, m.Welcome)
        assert back.epoch != at_start.epoch
        assert (back.ledger, back.resumed, back.sequence) == (at_start.ledger, True, 1)
        assert back.scene.objects["window"] == "closed"
        session = server.hub.sessions["s"]
        await until(lambda: session.delivery.scene().objects["hifi"] == "low")
        assert session.counters["commands_done"] == 1
        await renderer.__aexit__(None, None, None)


async def test_a_fresh_renderer_gets_the_command_of_before_the_restart(tmp_path):
    async with (
        live(settings=settings(tmp_path)) as server,
        server.join("renderer", hello=raw_hello()) as renderer,
    ):
        await gesture(server)
        command = await next_of(renderer, m.CommandMessage)
        renderer._socket.transport.abort()
    async with (
        live(settings=settings(tmp_path)) as server,
        server.join("renderer", hello=raw_hello()) as renderer,
    ):
        again = await next_of(renderer, m.CommandMessage)
        assert (again.id, again.sequence, again.steps) == (command.id, 1, command.steps)
        assert again.epoch == renderer.welcome.epoch != command.epoch
        assert 0 < again.age_ms < again.ttl_ms


async def test_without_a_folder_a_restart_begins_a_new_ledger_and_running_things_are_cut():
    async with live(settings=settings()) as server:
        port = int(server.url.rpartition(":")[2])
        renderer = Renderer(Options(server.url, "s"))
        await renderer.__aenter__()
        events = aiter(renderer)
        before = await event_of(events, m.Welcome)
        await gesture(server)
        command = await event_of(events, m.CommandMessage)
        assert renderer.start(command.id)
    async with live(settings=settings(), port=port) as server:
        cancelled = await event_of(events, Cancelled)
        assert (cancelled.command.id, cancelled.reason) == (command.id, "forgotten")
        after = await event_of(events, m.Welcome)
        assert after.ledger != before.ledger
        assert not after.resumed
        await gesture(server)
        # The same id, and another command.
        assert (await event_of(events, m.CommandMessage)).id == command.id
        await renderer.__aexit__(None, None, None)


async def test_a_session_that_ended_is_not_remembered(tmp_path):
    async with live(settings=settings(tmp_path, session_linger_s=0.1)) as server:
        async with server.join("renderer") as renderer:
            ledger = renderer.welcome.ledger
            await renderer.send(m.SceneEvent("window", "closed"))
            await until(lambda: list(tmp_path.glob("*.session.jsonl")))
        await until(lambda: not list(tmp_path.glob("*.session.jsonl")))
        async with server.join("renderer") as renderer:
            assert renderer.welcome.ledger != ledger
            assert renderer.welcome.scene.objects["window"] == "open"


async def test_a_damaged_file_costs_the_memory_and_not_the_session(tmp_path, caplog):
    (tmp_path / "s.session.jsonl").write_text('{"session":"s","led')
    async with live(settings=settings(tmp_path)) as server, server.join("renderer") as renderer:
        assert renderer.welcome.sequence == 0
    assert "s.session.jsonl holds no state that can be read" in caplog.text


def test_files_of_a_day_ago_are_removed(tmp_path):
    old = tmp_path / "s.session.jsonl"
    old.write_text("{}")
    other = tmp_path / "notes.txt"
    other.write_text("mine")
    FolderStore(tmp_path, old.stat().st_mtime_ns + 23 * 3600 * 10**9)
    assert old.exists()
    FolderStore(tmp_path, old.stat().st_mtime_ns + 25 * 3600 * 10**9)
    assert not old.exists()
    assert other.exists()


async def test_where_renderer_and_room_differ_the_rule_file_says_who_wins():
    shown = {**OBJECTS, "window": "closed", "hifi": "low", "lamp": "on"}
    rules = {"hifi": "renderer"}
    async with live(settings=settings(), authority=rules) as server:
        async with (
            server.join("monitor", hello=m.Hello(m.PROTOCOL, "m", topics=["error"])) as monitor,
            server.join("renderer", hello=raw_hello(objects=shown)) as renderer,
        ):
            assert renderer.welcome.differences == [
                m.Difference("window", "closed", "open", "server"),
                m.Difference("hifi", "low", "high", "renderer"),
                m.Difference("lamp", "on", "", "server"),
            ]
            assert renderer.welcome.scene.objects["window"] == "open"
            assert renderer.welcome.scene.objects["hifi"] == "low"
            error = await next_of(monitor, m.ErrorMessage)
            assert error.code == "scene_differs"
            assert "lamp" in error.message
        assert server.hub.sessions["s"].counters["scene_differences"] == 3


async def test_a_session_over_a_restart_replays_to_the_same_decisions(tmp_path):
    models = fake_models()
    decided = []
    for _ in range(2):
        chosen = settings(tmp_path / "state")
        hub = build_hub(chosen, models, tmp_path / "recordings")
        async with live(models, chosen, hub=hub) as server:
            async with (
                Monitor(Options(server.url, "s"), ["decision"]) as monitor,
                server.join("renderer", hello=raw_hello()) as renderer,
            ):
                messages = aiter(monitor)
                await event_of(messages, m.Welcome)
                await gesture(server)
                await asyncio.sleep(0.3)
                lines = []
                with suppress(TimeoutError):
                    while True:
                        found = await event_of(messages, m.DecisionMessage, within_s=0.2)
                        lines.append(msgspec.json.encode(found.decision))
                renderer._socket.transport.abort()
                await asyncio.sleep(0.05)
            decided.append(lines)
        await asyncio.sleep(0.05)
    files = sorted((tmp_path / "recordings").glob("*.mcap"), key=lambda path: path.stat().st_mtime)
    assert len(files) == 2
    for path, live_lines in zip(files, decided, strict=True):
        core = Core("s", settings(), hub._rules, models)
        again = [log_line(decision) for decision in replay(open_recording(path), core, models)]
        assert len(live_lines) > 10
        assert set(live_lines) <= set(again)
    # The second one begins where the first has stopped.
    assert b'"s/c2"' in b"".join(decided[1]) or b"busy" in b"".join(decided[1])


async def test_a_client_that_promised_to_answer_pings_and_does_not_is_sent_away():
    async with (
        live(settings=settings(heartbeat_s=0.1)) as server,
        server.join("monitor", hello=m.Hello(m.PROTOCOL, "m", capabilities=["heartbeat"])) as dumb,
        server.join("monitor") as simple,
    ):
        with pytest.raises(ConnectionFailed, match=str(CLOSE_SILENT)):
            await next_of(dumb, m.CommandMessage)
        # One that promised nothing only gets pings.
        assert await next_of(simple, m.Ping)


async def test_either_side_knows_the_other_ones_clock():
    async with (
        live(settings=settings(heartbeat_s=0.05)) as server,
        Monitor(Options(server.url, "s")) as monitor,
    ):
        await event_of(aiter(monitor), m.Welcome)
        await until(lambda: monitor.link.clock_estimate.offset_ns is not None)
        # One machine, one monotonic clock.
        assert abs(monitor.link.clock_estimate.offset_ns) < 50_000_000
        (client,) = server.hub.sessions["s"].audience.clients
        await until(lambda: client.clock.offset_ns is not None)
        assert abs(client.stats().offset_ms) < 50


async def test_a_clock_that_jumps_is_told_to_monitors():
    hour_ns = 3600 * 10**9
    async with (
        live(settings=settings(heartbeat_s=0.05)) as server,
        server.join("renderer") as renderer,
        server.join("monitor", hello=m.Hello(m.PROTOCOL, "m", topics=["error"])) as monitor,
    ):
        for shift_ns in (0, hour_ns, hour_ns, hour_ns):
            ping = await next_of(renderer, m.Ping)
            await renderer.send(m.Pong(ping.sent_ns, ping.sent_ns + shift_ns))
        error = await next_of(monitor, m.ErrorMessage)
        assert error.code == "clock_jump"
        assert "renderer" in error.message
        session = server.hub.sessions["s"]
        assert session.counters["clock_jumps"] == 1
        (client,) = session.audience.having("renderer")
        assert client.stats().offset_ms == pytest.approx(3.6e6, abs=100)


async def test_hello_and_address_must_agree():
    async with live(settings=settings()) as server:
        for wrong in ({"session": "other"}, {"role": "sensor"}):
            with pytest.raises(ConnectionFailed, match="the address says"):
                async with server.join("monitor", hello=m.Hello(m.PROTOCOL, "m", **wrong)):
                    pass
