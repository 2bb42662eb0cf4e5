"""Real websockets against a real server: what each role sends and gets."""

import asyncio
import json

import httpx
import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

from agent_server.client.link import Options
from agent_server.client.once import ConnectionFailed, join, send_paced
from agent_server.client.renderer import Renderer
from agent_server.client.timed import TimedRenderer
from agent_server.config import GateSettings, ServerSettings, Settings
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from agent_server.protocol.codes import (
    CLOSE_BAD_HELLO,
    CLOSE_FULL,
    CLOSE_GOING_AWAY,
    CLOSE_HELLO_TIMEOUT,
    CLOSE_REPLACED,
    CLOSE_TOO_MANY_ERRORS,
    CLOSE_WRONG_VERSION,
)
from agent_server.protocol.convert import skeleton_to_message
from tests.support.bodies import stream
from tests.support.live import all_decisions, live, next_of
from tests.support.models import fake_models

OPEN_GATE = Settings(gate=GateSettings(mode="off"))
HEADSET = m.Hello(m.PROTOCOL, "headset", face="none")
GESTURE = stream(6, hands_up=lambda t: 2 <= t < 4)


async def send_all(sensor, frames):
    for frame in frames:
        await sensor.send(skeleton_to_message(frame))
        await asyncio.sleep(0.001)


@pytest.mark.parametrize("subprotocol", list(CODECS))
async def test_a_gesture_becomes_a_command_in_both_codings(subprotocol):
    async with (
        live(settings=OPEN_GATE) as server,
        server.join("renderer", subprotocol=subprotocol) as renderer,
        server.join("monitor", subprotocol=subprotocol) as monitor,
        server.join("sensor", subprotocol=subprotocol) as sensor,
    ):
        await send_all(sensor, GESTURE)
        command = await next_of(renderer, m.CommandMessage)
        assert (command.reaction, command.cause, command.sequence) == ("turn_down_hifi", "loud", 1)
        assert command.id == "s/c1"
        # The hands went up at 2 s; three windows in a row must have shown it.
        assert 2.0e9 < command.originating_ns < 3.2e9
        decision = (await next_of(monitor, m.DecisionMessage)).decision
        assert decision.id.startswith("s/")
        assert set(decision.models) == {"last_frame_predictor", "rule_classifier", "calm_reader"}
        scene = await next_of(monitor, m.SceneState)
        assert scene.mode == "reacting"


async def test_acks_of_the_renderer_change_the_room():
    async with (
        live(settings=OPEN_GATE) as server,
        server.join("monitor") as monitor,
        server.join("renderer") as renderer,
        server.join("sensor") as sensor,
    ):
        assert renderer.welcome.scene.objects["hifi"] == "high"
        await send_all(sensor, GESTURE)
        command = await next_of(renderer, m.CommandMessage)
        await renderer.send(m.AckMessage(command.id, "started"))
        await renderer.send(m.AckMessage(command.id, "done"))
        while (scene := await next_of(monitor, m.SceneState)).objects["hifi"] == "high":
            pass
        assert scene.mode == "attention"
        await renderer.send(m.SceneEvent("window", "closed"))
        while (scene := await next_of(monitor, m.SceneState)).objects["window"] == "open":
            pass
        await renderer.send(m.SceneEvent("window", "ajar"))
        error = await next_of(renderer, m.ErrorMessage)
        assert (error.code, error.field, error.fatal) == ("unknown_state", "state", False)


async def test_the_gate_keeps_a_discomfort_back_and_says_so():
    async with (
        live() as server,
        server.join("monitor") as monitor,
        server.join("sensor") as sensor,
    ):
        decisions = []
        listening = asyncio.create_task(all_decisions(monitor, decisions))
        await sensor.send(m.Affect(0, 5.0, 5.0))
        await send_all(sensor, GESTURE)
        await asyncio.sleep(0.3)
        listening.cancel()
        gated = [d.decision for d in decisions if d.decision.outcome == "gated"]
        assert gated
        assert gated[0].gesture == "loud"
        assert not gated[0].gate.is_open
        assert all(d.decision.command is None for d in decisions)


async def test_a_headset_switches_the_gate_off():
    async with (
        live() as server,
        server.join("renderer") as renderer,
        server.join("sensor", hello=HEADSET) as sensor,
    ):
        await send_all(sensor, GESTURE)
        assert (await next_of(renderer, m.CommandMessage)).cause == "loud"


async def test_a_monitor_gets_the_topics_it_asked_for():
    watch = m.Hello(m.PROTOCOL, "tester", topics=["pose"])
    async with (
        live() as server,
        server.join("monitor", hello=watch) as monitor,
        server.join("sensor") as sensor,
    ):
        await send_all(sensor, stream(2))
        await sensor.send(m.Ping(1))
        await next_of(sensor, m.Pong)
        await monitor.send(m.Ping(2))
        kinds = set()
        async for message in monitor:
            kinds.add(type(message))
            if isinstance(message, m.Pong):
                break
        assert m.PoseMessage in kinds
        assert kinds <= {m.PoseMessage, m.Pong}


async def test_a_predictor_that_fails_costs_no_decision():
    models = fake_models(fail_on=frozenset({0, 2}))
    async with (
        live(models) as server,
        server.join("monitor") as monitor,
        server.join("sensor") as sensor,
    ):
        decisions = []
        listening = asyncio.create_task(all_decisions(monitor, decisions))
        await send_all(sensor, stream(3))
        await asyncio.sleep(0.3)
        listening.cancel()
        forecasts = [d.decision.forecast for d in decisions]
        assert forecasts[:4] == [
            "last_frame",
            "last_frame_predictor",
            "last_frame",
            "last_frame_predictor",
        ]
        assert "as it was told to" in decisions[0].decision.forecast_failure
        assert server.hub.sessions["s"].counters["predictor_failures"] == 2


async def test_bad_input_is_answered_and_the_session_goes_on():
    async with live() as server, server.join("sensor") as sensor:
        good = skeleton_to_message(stream(1)[3])
        await sensor.send(good)
        await sensor.send(good)
        error = await next_of(sensor, m.ErrorMessage)
        assert (error.code, error.field) == ("out_of_order", "originating_ns")
        await sensor.send(m.Skeleton(10**9, 0, "kinect_v2", good.joints))
        error = await next_of(sensor, m.ErrorMessage)
        assert (error.code, error.field, error.fatal) == ("wrong_joint_count", "joints", False)
        counters = server.hub.sessions["s"].counters
        assert counters["frames"] == 1
        assert counters["rejected_messages"] == 2


async def test_bad_input_that_persists_costs_the_connection():
    settings = Settings(server=ServerSettings(max_errors=5))
    async with live(settings=settings) as server, server.join("sensor") as sensor:
        for _ in range(6):
            await sensor.send(m.AckMessage("x", "done"))
        errors = []
        with pytest.raises(ConnectionFailed, match=str(CLOSE_TOO_MANY_ERRORS)):
            while True:
                errors.append(await next_of(sensor, m.ErrorMessage))
        assert [error.fatal for error in errors] == [False] * 5 + [True]


async def refused(url, path, *messages, subprotocols=None):
    """What a client is told before it is sent away, and the close code."""
    told = []
    async with connect(url.replace("http", "ws") + path, subprotocols=subprotocols) as socket:
        for message in messages:
            await socket.send(message)
        try:
            while True:
                told.append(json.loads(await socket.recv()))
        except ConnectionClosed as closed:
            return told[-1], closed.rcvd.code


async def test_visitors_who_cannot_stay_are_told_why():
    async with live() as server:
        hello = json.dumps({"type": "hello", "protocol": "2.0", "client": "old"})
        error, code = await refused(server.url, "/v1/sessions/s/sensor", hello)
        assert code == CLOSE_WRONG_VERSION
        assert "2.0" in error["message"]
        assert m.PROTOCOL in error["message"]
        error, code = await refused(server.url, "/v1/sessions/s/ghost")
        assert (code, error["code"]) == (CLOSE_BAD_HELLO, "unknown_role")
        error, code = await refused(server.url, "/v1/sessions/b@d/sensor")
        assert (code, error["code"]) == (CLOSE_BAD_HELLO, "bad_session_id")
        error, code = await refused(
            server.url, "/v1/sessions/s/sensor", subprotocols=["agent-server.v9.json"]
        )
        assert code == CLOSE_WRONG_VERSION
        assert "agent-server.v9.json" in error["message"]
        assert "s" not in server.hub.sessions


async def test_who_says_nothing_is_sent_away():
    settings = Settings(server=ServerSettings(hello_timeout_s=0.1))
    async with live(settings=settings) as server:
        error, code = await refused(server.url, "/v1/sessions/s/sensor")
        assert (code, error["code"]) == (CLOSE_HELLO_TIMEOUT, "no_hello")


async def test_a_full_server_says_so():
    settings = Settings(server=ServerSettings(max_sessions=1))
    async with live(settings=settings) as server, server.join("sensor", "one"):
        hello = json.dumps({"type": "hello", "protocol": "1.0", "client": "late"})
        error, code = await refused(server.url, "/v1/sessions/two/sensor", hello)
        assert (code, error["code"]) == (CLOSE_FULL, "full")


async def test_one_sensor_and_one_acting_renderer_a_session():
    take_over = m.Hello(m.PROTOCOL, "tester", take_over=True)
    mirror = m.Hello(m.PROTOCOL, "tester", mirror=True)
    async with live() as server, server.join("sensor") as first, server.join("renderer") as acting:
        frames = [skeleton_to_message(frame) for frame in stream(1)]
        await first.send(frames[0])
        async with server.join("sensor", hello=take_over) as second:
            await second.send(frames[1])
            with pytest.raises(ConnectionFailed, match=str(CLOSE_REPLACED)):
                await next_of(first, m.Pong)
            async with server.join("sensor") as third:
                await third.send(frames[2])
                assert (await next_of(third, m.ErrorMessage)).code == "stream_taken"
        with pytest.raises(ConnectionFailed, match="mirror"):
            async with server.join("renderer"):
                pass
        async with server.join("renderer", hello=mirror) as watching:
            await watching.send(m.AckMessage("s/c1", "done"))
            assert (await next_of(watching, m.ErrorMessage)).code == "not_acting"
        async with server.join("renderer", hello=take_over):
            with pytest.raises(ConnectionFailed, match=str(CLOSE_REPLACED)):
                await next_of(acting, m.Pong)


async def test_empty_sessions_close_after_a_while_and_not_before():
    settings = Settings(server=ServerSettings(session_linger_s=0.2))
    async with live(settings=settings) as server:
        async with server.join("sensor"):
            await asyncio.sleep(0.3)
            assert "s" in server.hub.sessions
        async with server.join("monitor"):
            await asyncio.sleep(0.3)
            assert "s" in server.hub.sessions
        await asyncio.sleep(0.5)
        assert "s" not in server.hub.sessions


async def test_http_tells_of_health_and_sessions():
    async with (
        live() as server,
        server.join("sensor", "one"),
        httpx.AsyncClient(base_url=server.url) as http,
    ):
        assert (await http.get("/healthz")).json()["status"] == "ok"
        ready = await http.get("/readyz")
        assert ready.json()["ready"]
        assert "rule_classifier" in ready.json()["models"]
        sessions = (await http.get("/v1/sessions")).json()["sessions"]
        assert sessions == [{"id": "one", "sensor": True, "clients": 1, "decisions": 0}]


async def test_a_body_that_leaves_ends_attention_even_when_nothing_comes_any_more():
    async with (
        live(settings=OPEN_GATE) as server,
        server.join("monitor") as monitor,
        server.join("sensor") as sensor,
    ):
        await send_paced(sensor, GESTURE, 20.0)
        resumed = await next_of(monitor, m.CommandMessage)
        while resumed.reaction != "resume_work":
            resumed = await next_of(monitor, m.CommandMessage)
        assert resumed.cause == "body_lost"
        assert server.hub.sessions["s"].counters["bodies_lost"] == 1


async def test_a_client_that_finds_no_server_is_told():
    async with live() as server:
        url = server.url
    with pytest.raises(ConnectionFailed, match="cannot connect"):
        async with live() as other:
            assert other.url != url
            async with join(url, "s", "sensor"):
                pass


async def test_a_renderer_without_a_picture_carries_commands_out():
    async with (
        live(settings=OPEN_GATE) as server,
        server.join("monitor") as monitor,
        Renderer(Options(server.url, "s")) as connection,
        server.join("sensor", hello=HEADSET) as sensor,
    ):
        renderer = TimedRenderer(connection)
        running = asyncio.create_task(renderer.run())
        await send_paced(sensor, GESTURE, 20.0)
        command = await next_of(monitor, m.CommandMessage)
        done = await next_of(monitor, m.AckTelemetry)
        while done.status != "done":
            done = await next_of(monitor, m.AckTelemetry)
        assert (done.command_id, command.reaction) == ("s/c1", "turn_down_hifi")
        while (await next_of(monitor, m.SceneState)).objects["hifi"] != "low":
            pass
        server.hub.sessions["s"].change_object("hifi", "high")
        while (await next_of(monitor, m.SceneState)).objects["hifi"] != "high":
            pass
        running.cancel()


async def test_every_ping_is_answered():
    async with live() as server, server.join("monitor") as monitor:
        for sent_ns in range(40):
            await monitor.send(m.Ping(sent_ns))
        answered = [(await next_of(monitor, m.Pong)).sent_ns for _ in range(40)]
        assert answered == list(range(40))


async def test_a_server_that_stops_says_goodbye():
    async with live() as server, server.join("sensor") as sensor:
        server.hub.stop()
        assert [message async for message in sensor] == []
        assert sensor._socket.close_code == CLOSE_GOING_AWAY
        with pytest.raises(ConnectionFailed, match="stopping"):
            async with server.join("sensor"):
                pass


async def test_a_session_that_is_opened_anew_has_another_epoch():
    settings = Settings(server=ServerSettings(session_linger_s=0.05))
    async with live(settings=settings) as server:
        async with server.join("sensor") as sensor:
            first = sensor.welcome.epoch
        await asyncio.sleep(0.3)
        async with server.join("sensor") as sensor:
            assert sensor.welcome.epoch != first


async def test_objects_are_set_by_hand_over_http():
    async with (
        live() as server,
        server.join("renderer") as renderer,
        httpx.AsyncClient(base_url=server.url) as http,
    ):
        path = "/v1/sessions/s/objects/window"
        answer = await http.put(path, params={"state": "closed"})
        assert answer.json()["objects"]["window"] == "closed"
        assert (await next_of(renderer, m.SceneState)).objects["window"] == "closed"
        wrong = await http.put(path, params={"state": "ajar"})
        assert (wrong.status_code, "ajar" in wrong.json()["detail"]) == (422, True)
        assert (await http.put("/v1/sessions/none/objects/window?state=open")).status_code == 404


async def test_a_renderer_that_only_stands_in_gives_its_place_away():
    stand_in = m.Hello(m.PROTOCOL, "t", capabilities=["stand_in"])
    async with live() as server, server.join("renderer", hello=stand_in) as first:
        async with server.join("renderer"):
            with pytest.raises(ConnectionFailed, match=str(CLOSE_REPLACED)):
                await next_of(first, m.Pong)
        async with server.join("renderer", hello=stand_in):
            with pytest.raises(ConnectionFailed, match="another renderer"):
                async with server.join("renderer"), server.join("renderer"):
                    pass
