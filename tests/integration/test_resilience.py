"""Sessions are apart, a stop is orderly, and clients that only send live long."""

import asyncio
import time
from functools import partial

import httpx
import pytest

from agent_server.config import GateSettings, ServerSettings, Settings
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from agent_server.protocol.convert import skeleton_to_message
from agent_server.service.load import Load
from tests.support import chaos
from tests.support.bodies import stream
from tests.support.live import live, next_of
from tests.support.models import fake_models
from tests.support.patience import patience
from tests.support.raw_socket import RawSocket

JSON = CODECS[m.SUBPROTOCOL_JSON]
FLOOD = 3000


async def flooder(server):
    port = int(server.url.rpartition(":")[2])
    socket = await RawSocket.open(port, "/v1/sessions/flood/monitor", m.SUBPROTOCOL_JSON)
    socket.send(JSON.encode(m.Hello(m.PROTOCOL, "flooder")).encode(), is_text=True)
    while not isinstance(JSON.decode_server((await socket.receive())[1].decode()), m.Welcome):
        pass
    return socket


async def test_a_flood_of_one_client_is_worth_no_more_than_a_message_of_another():
    """However much one sends, others wait for one of its messages at a time.

    Measured as a ratio, not as a time: of a flood that is all there before another client says a
    word, how much is dealt with before that word is answered.
    """
    settings = Settings(server=ServerSettings(max_messages_per_s=10**6, command_queue=10**5))
    async with live(settings=settings) as server, server.join("monitor") as other:
        socket = await flooder(server)
        for index in range(FLOOD):
            socket.send(JSON.encode(m.Ping(index)).encode(), is_text=True)
        await asyncio.sleep(0)
        await other.send(m.Ping(7))
        await next_of(other, m.Pong)
        answered = 0
        done = asyncio.Event()

        async def count():
            nonlocal answered
            while answered < FLOOD and (received := await socket.receive()) is not None:
                answered += b'"pong"' in received[1]
            done.set()

        counting = asyncio.create_task(count())
        # What had been answered by then has arrived already.
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        assert answered < FLOOD / 5
        async with patience():
            await done.wait()
        await counting
        socket.abort()


async def test_who_sends_too_fast_is_read_no_faster_and_loses_nothing():
    settings = Settings(server=ServerSettings(max_messages_per_s=100))
    async with live(settings=settings) as server:
        socket = await flooder(server)
        start = time.monotonic()
        for index in range(200):
            socket.send(JSON.encode(m.Ping(index)).encode(), is_text=True)
        pongs = []
        while len(pongs) < 200:
            answer = JSON.decode_server((await socket.receive())[1].decode())
            if isinstance(answer, m.Pong):
                pongs.append(answer.sent_ns)
        # A second's worth may come at once; hello was a message too.
        assert time.monotonic() - start > 0.8
        assert pongs == list(range(200))
        socket.abort()


async def test_a_client_that_takes_nothing_costs_others_nothing():
    """Decisions of one session with and without a stuck monitor in each of some others."""
    settings = Settings(gate=GateSettings(mode="off"))

    async def typical_ms(server, name):
        async with server.join("monitor", name) as monitor, server.join("sensor", name) as sensor:
            for frame in stream(3):
                await sensor.send(skeleton_to_message(frame))
                await asyncio.sleep(0.005)
            times = [(await next_of(monitor, m.DecisionMessage)).timing.total_ms for _ in range(2)]
            return sum(times) / len(times)

    async with live(settings=settings) as server:
        alone_ms = min([await typical_ms(server, f"alone{index}") for index in range(3)])
        port = int(server.url.rpartition(":")[2])
        stuck = []
        for index in range(8):
            path = f"/v1/sessions/stuck{index}/monitor"
            socket = await RawSocket.open(port, path, m.SUBPROTOCOL_JSON)
            socket.send(JSON.encode(m.Hello(m.PROTOCOL, "stuck")).encode(), is_text=True)
            stuck.append(socket)
        beside_ms = min([await typical_ms(server, f"beside{index}") for index in range(3)])
        assert beside_ms < 5 * alone_ms + 5
        for socket in stuck:
            socket.abort()


async def test_a_client_that_only_sends_answers_pings_still():
    settings = Settings(server=ServerSettings(heartbeat_s=0.01))
    async with live(settings=settings) as server, server.join("sensor") as sensor:
        await asyncio.sleep(0.6)  # far more pings than a client keeps unread by default
        answered = await sensor._socket.ping()
        async with patience():
            assert await answered < 2


async def test_an_overloaded_server_says_so_and_leaves_windows_out_but_no_command():
    settings = Settings(gate=GateSettings(mode="off"))
    async with (
        live(settings=settings) as server,
        server.join("renderer") as renderer,
        server.join("sensor") as sensor,
        httpx.AsyncClient(base_url=server.url) as http,
    ):
        server.hub._take_lag = lambda _: None
        server.hub.gauge.load = Load.WINDOWS
        server.hub.gauge.push = lambda _: False
        assert (await http.get("/readyz")).json()["load"] == "windows"
        with pytest.raises(Exception, match="overloaded"):
            async with server.join("monitor", "another"):
                pass
        for frame in stream(6, hands_up=lambda t: 2 <= t < 5):
            await sensor.send(skeleton_to_message(frame))
            await asyncio.sleep(0.002)
        assert (await next_of(renderer, m.CommandMessage)).cause == "loud"
        counters = server.hub.sessions["s"].counters
        assert counters["windows_left_out"] >= counters["decisions"] - 2 > 0


async def test_a_stuck_model_makes_the_server_unready_and_sessions_wait():
    models = fake_models()
    settings = Settings(server=ServerSettings(watchdog_s=0.6))
    async with (
        live(models, settings) as server,
        server.join("sensor") as sensor,
        httpx.AsyncClient(base_url=server.url) as http,
    ):
        assert (await http.get("/readyz")).status_code == 200
        predict = models.predictor.predict

        def slowly(seen):
            time.sleep(3.0)
            return predict(seen)

        models.predictor.predict = slowly
        for frame in stream(2):
            await sensor.send(skeleton_to_message(frame))
        async with patience():
            while (answer := await http.get("/readyz")).json()["stalls"]["inference"] == 0:  # noqa: ASYNC110
                await asyncio.sleep(0.05)
        assert answer.status_code == 503
        assert (await http.get("/healthz")).status_code == 200


@pytest.mark.parametrize(
    "scenario",
    [
        partial(chaos.stopped, sessions=3, seconds=3.0),
        partial(chaos.disk_full, seconds=4.0, largest_file=30_000),
        chaos.clock_stepped,
        chaos.black_holed,
    ],
    ids=["stopped", "disk_full", "clock_stepped", "black_holed"],
)
async def test_what_is_promised_of_misfortunes_is_kept(scenario):
    seen = await scenario()
    assert seen["kept"], seen
