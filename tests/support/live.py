"""A real server on a real port, in this process."""

import asyncio
from contextlib import asynccontextmanager
from dataclasses import dataclass

import msgspec

from agent_server.clock import SystemClock
from agent_server.config import Settings
from agent_server.protocol import messages as m
from agent_server.scene.rules import default_rules
from agent_server.service.hub import Hub
from agent_server.client.once import join
from agent_server.transports.server import address, bind, serving
from tests.support.models import fake_models


@dataclass
class Live:
    """A running server."""

    url: str
    hub: Hub

    def join(self, role, session="s", **options):
        return join(self.url, session, role, **options)


@asynccontextmanager
async def live(models=None, settings=None, open_journal=None):
    """Serve on a free port while the context lasts."""
    settings = settings or Settings()
    server = msgspec.structs.replace(settings.server, port=0)
    settings = msgspec.structs.replace(settings, server=server)
    models = models or fake_models()
    rules = default_rules(models.classifier.labels)
    hub = Hub(settings, rules, models, SystemClock(), open_journal)
    listener = bind(settings)
    async with serving(hub, listener):
        yield Live(address(listener), hub)


async def next_of(client, kind, within_s=5.0):
    """The next message of a type; others are passed over."""
    async with asyncio.timeout(within_s):
        async for message in client:
            if isinstance(message, kind):
                return message
    raise AssertionError(f"the connection ended without a {kind.__name__}")


async def all_decisions(client, into):
    """Collect decisions until cancelled."""
    async for message in client:
        if isinstance(message, m.DecisionMessage):
            into.append(message)
