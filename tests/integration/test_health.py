"""``/v1/health``: how sessions fare, and whose business that is."""

import httpx

from agent_server.clock import ManualClock
from agent_server.domain.stamp import NS_PER_S
from agent_server.protocol import messages as m
from agent_server.service.audience import Client
from agent_server.service.health import BACKLOG, health_of
from agent_server.service.mailbox import Outbox
from tests.integration.test_sight import UNGATED, perform
from tests.support.live import live


async def health(server):
    async with httpx.AsyncClient(base_url=server.url) as http:
        told = (await http.get("/v1/health")).json()
    return told, {session["id"]: session for session in told["sessions"]}


async def test_a_session_that_is_served_is_good():
    async with live(settings=UNGATED) as server, server.join("renderer", "ann"):
        await perform(server, "ann")
        told, sessions = await health(server)
        ann = sessions["ann"]
        assert told["ready"]
        assert told["rss_mb"] > 10
        assert ann["reason"].startswith("loud: ")
        assert ann["commands"] >= 1
        assert 0 < ann["p50_ms"] <= ann["worst_ms"]
        assert [client["role"] for client in ann["clients"]] == ["renderer"]
        # The sensor has left.
        assert (ann["state"], ann["words"]) == ("quiet", "no sensor is connected")


async def test_what_is_amiss_is_said():
    async with live(settings=UNGATED) as server, server.join("sensor", "lab"):
        _, sessions = await health(server)
        assert sessions["lab"]["state"] == "amiss"
        assert "has not sent a frame yet" in sessions["lab"]["words"]
        session = server.hub.sessions["lab"]
        session.counters["frames"] += 1
        assert health_of(session, server.hub.clock.now_ns()).state == "good"
        outbox = Outbox(64)
        for index in range(BACKLOG):
            outbox.post(m.Pong(index, index))
        slow = Client("monitor", m.Hello(m.PROTOCOL, "slow one"), outbox)
        session.audience.clients.append(slow)
        words = health_of(session, server.hub.clock.now_ns()).words
        session.audience.clients.remove(slow)
        assert "wait for monitor 'slow one': it reads too slowly" in words


async def test_a_silent_sensor_is_noticed():
    async with live(settings=UNGATED) as server, server.join("sensor") as sensor:
        await sensor.send(m.Affect(0, 0.0, 0.0))
        await sensor.send(m.Ping(1))
        async for message in sensor:
            if isinstance(message, m.Pong):
                break
        session = server.hub.sessions["s"]
        session.counters["frames"] += 1
        later = ManualClock(server.hub.clock.now_ns() + 5 * NS_PER_S)
        assert (
            "nothing has come from the sensor for 5 s" in health_of(session, later.now_ns()).words
        )


async def test_the_page_is_confined_to_its_server():
    async with live() as server, httpx.AsyncClient(base_url=server.url) as http:
        for path, kind in (("/admin", "html"), ("/admin.js", "javascript"), ("/admin.css", "css")):
            answer = await http.get(path)
            assert answer.status_code == 200
            assert kind in answer.headers["content-type"]
            assert answer.headers["content-security-policy"].startswith("default-src 'self'")
