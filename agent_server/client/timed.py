"""A renderer without a picture: it carries commands out by their nominal times."""

import asyncio

from agent_server.client.renderer import Cancelled, Renderer
from agent_server.protocol import messages as m


class TimedRenderer:
    """Acts for a room that nobody draws.

    Args:
        renderer: An entered client.
        scale: 1 takes the nominal time for each step, 0.1 a tenth of it.
    """

    def __init__(self, renderer: Renderer, scale: float = 1.0) -> None:
        self._renderer = renderer
        self._scale = scale
        self._performing: asyncio.Task[None] | None = None

    async def run(self) -> None:
        """Carry out what comes.

        Raises:
            ConnectionFailed: If the server says that coming back is of no use.
        """
        try:
            async for event in self._renderer:
                match event:
                    case m.CommandMessage():
                        self._cut()
                        self._performing = asyncio.create_task(self._perform(event))
                    case Cancelled():
                        self._cut()
        finally:
            self._cut()

    async def _perform(self, command: m.CommandMessage) -> None:
        if not self._renderer.start(command.id):
            return
        for index, step in enumerate(command.steps):
            await asyncio.sleep(step.duration_s * self._scale)
            self._renderer.progress(command.id, index)
        self._renderer.done(command.id)

    def _cut(self) -> None:
        if self._performing is not None:
            self._performing.cancel()
            self._performing = None
