"""A real server on a real port, in this process."""

from contextlib import asynccontextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import msgspec

from agent_server.client.once import join
from agent_server.clock import SystemClock
from agent_server.config import Settings
from agent_server.domain.scene import Authority
from agent_server.inference.fake import LastFramePredictor
from agent_server.protocol import messages as m
from agent_server.scene.rules import default_rules
from agent_server.service.auth import OPEN
from agent_server.service.hub import Hub
from agent_server.service.store import FolderStore
from agent_server.transports.server import address, bind, serving
from tests.support.models import fake_models
from tests.support.patience import patience


@dataclass
class Live:
    """A running server."""

    url: str
    hub: Hub

    def join(self, role, session="s", **options):
        return join(self.url, session, role, **options)


@asynccontextmanager
async def live(
    models=None,
    settings=None,
    open_journal=None,
    *,
    port=0,
    authority=None,
    alter_rule=None,
    hub=None,
    access=OPEN,
):
    """Serve on a free port, or a given one, while the context lasts.

    ``authority`` says of objects by name whose word holds, ``alter_rule`` makes another rule of
    each; ``hub`` is one of the test's own.
    """
    settings = settings or Settings()
    server = msgspec.structs.replace(settings.server, port=port)
    settings = msgspec.structs.replace(settings, server=server)
    models = models or fake_models()
    rules = default_rules(models.classifier.labels)
    for name, side in (authority or {}).items():
        rules.objects[name] = replace(rules.objects[name], authority=Authority(side))
    if alter_rule is not None:
        for gesture, own in rules.rules.items():
            rules.rules[gesture] = tuple(map(alter_rule, own))
    if hub is None:
        state = settings.server.state
        clock = SystemClock()
        store = None if state is None else FolderStore(Path(state), clock.wall_ns())
        hub = Hub(settings, rules, models, clock, open_journal, store)
    listener = bind(settings)
    is_secure = settings.server.tls_cert is not None
    async with serving(hub, listener, access):
        await hub.warm.wait()
        if isinstance(models.predictor, LastFramePredictor):
            models.predictor.calls = 0  # those of the warm-up do not count
        yield Live(address(listener, is_secure=is_secure), hub)


async def next_of(client, kind):
    """The next message of a type; others are passed over."""
    async with patience():
        async for message in client:
            if isinstance(message, kind):
                return message
    raise AssertionError(f"the connection ended without a {kind.__name__}")


async def all_decisions(client, into):
    """Collect decisions until cancelled."""
    async for message in client:
        if isinstance(message, m.DecisionMessage):
            into.append(message)
