"""A client that takes nothing any more loses its place, and nobody waits for it."""

import asyncio
import time

from agent_server.clock import SystemClock
from agent_server.config import ServerSettings, Settings
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from agent_server.protocol.codes import CLOSE_TOO_SLOW
from agent_server.scene.rules import default_rules
from agent_server.service.auth import OPEN
from agent_server.service.hub import Hub
from agent_server.transports.link import Link
from agent_server.transports.visit import FAREWELL_S, Entrance, Visit
from tests.support.models import fake_models

JSON = CODECS[m.SUBPROTOCOL_JSON]


class StuckWebSocket:
    """Says hello, takes the welcome, and then neither sends nor takes anything."""

    def __init__(self):
        self._hello = JSON.encode(m.Hello(m.PROTOCOL, "stuck"))
        self.welcomed = asyncio.Event()

    async def receive(self):
        if self._hello is None:
            await asyncio.Event().wait()
        hello, self._hello = self._hello, None
        return {"type": "websocket.receive", "text": hello}

    async def send_text(self, data):
        if self.welcomed.is_set():
            await asyncio.Event().wait()
        assert '"welcome"' in data
        self.welcomed.set()


async def test_a_renderer_that_takes_nothing_is_let_go_when_commands_pile_up():
    settings = Settings(server=ServerSettings(command_queue=3))
    models = fake_models()
    hub = Hub(settings, default_rules(), models, SystemClock())
    socket = StuckWebSocket()
    async with hub.run():
        link, entrance = Link(socket, JSON), Entrance(OPEN, None)
        visit = asyncio.create_task(Visit(hub, link, "s", "renderer", entrance).run())
        await socket.welcomed.wait()
        session = hub.sessions["s"]
        (client,) = session.audience.clients
        command = m.CommandMessage("s/c1", 1, "e", "greet", "hello", [], 5, 0, 0, 1000)
        start = time.monotonic()
        for _ in range(6):
            session.audience.order(command)
            await asyncio.sleep(0)  # the writer gets stuck on the first one
        assert client.outbox.close_code == CLOSE_TOO_SLOW
        await visit
        assert time.monotonic() - start < FAREWELL_S + 1
        assert session.audience.clients == []
