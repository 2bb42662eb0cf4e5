"""A renderer without a picture: it carries commands out by their nominal times."""

import asyncio
from contextlib import suppress

from agent_server.protocol import messages as m
from agent_server.transports.client import Client, ConnectionFailed


class TimedRenderer:
    """Acts for a room that nobody draws.

    Args:
        client: An open connection in the role ``renderer``.
    """

    def __init__(self, client: Client) -> None:
        self._client = client
        self._initial = dict(client.welcome.scene.objects)

    async def run(self) -> None:
        """Carry out what comes; a newer command cuts short the one that is going on.

        Raises:
            ConnectionFailed: When the connection ends.
        """
        performing: asyncio.Task[None] | None = None
        try:
            async for message in self._client:
                if isinstance(message, m.CommandMessage):
                    if performing is not None:
                        performing.cancel()
                    performing = asyncio.create_task(self._perform(message))
        finally:
            if performing is not None:
                performing.cancel()

    async def restore(self) -> None:
        """Put every object back into the state that it had when the renderer came."""
        for name, state in self._initial.items():
            await self._client.send(m.SceneEvent(name, state))

    async def _perform(self, command: m.CommandMessage) -> None:
        # Whoever reads the connection learns that it is gone.
        with suppress(ConnectionFailed):
            await self._client.send(m.AckMessage(command.id, "started"))
            for index, step in enumerate(command.steps):
                await asyncio.sleep(step.duration_s)
                await self._client.send(m.AckMessage(command.id, "progress", index))
            await self._client.send(m.AckMessage(command.id, "done"))
