"""What waits for a client, each edge with its own promise.

Telemetry may be lost: only the latest of each topic waits. Commands may not: they wait in
order, and a client that lets too many pile up is disconnected.
"""

import asyncio
from collections import Counter, deque

from agent_server.protocol.messages import Message, Missed


class Overflow(Exception):
    """Too many commands wait for a slow client."""


class Outbox:
    """Everything that waits for one connection.

    Args:
        max_commands: Messages that may wait in order before :class:`Overflow` is raised.
    """

    def __init__(self, max_commands: int) -> None:
        self._ordered: deque[Message] = deque()
        self._latest: dict[str, Message] = {}
        self._max_commands = max_commands
        self._ready = asyncio.Event()
        self._closing = asyncio.Event()
        self._untold: Counter[str] = Counter()
        self.missed = 0
        self.close_code: int | None = None
        self.close_reason = ""

    def post(self, message: Message) -> None:
        """Queue a message that must arrive, in order.

        Raises:
            Overflow: If too many wait already.
        """
        if len(self._ordered) >= self._max_commands:
            raise Overflow
        self._ordered.append(message)
        self._ready.set()

    def precede(self, message: Message) -> None:
        """Queue a message ahead of all others."""
        self._ordered.appendleft(message)
        self._ready.set()

    def show(self, topic: str, message: Message, key: str = "") -> None:
        """Replace what waits on a telemetry topic, and count what was never sent.

        Args:
            topic: Kind of telemetry.
            message: The latest of it.
            key: Of what it is the latest, where a topic speaks of several things.
        """
        if self.update(f"{topic} {key}", message):
            self.missed += 1
            self._untold[topic] += 1

    def skip(self, topic: str) -> None:
        """Count telemetry that is left out; the client is told with what comes next."""
        self.missed += 1
        self._untold[topic] += 1

    def update(self, key: str, message: Message) -> bool:
        """Replace what waits under ``key``; tells whether something did."""
        was_waiting = self._latest.pop(key, None) is not None
        self._latest[key] = message
        self._ready.set()
        return was_waiting

    @property
    def waiting(self) -> int:
        """How many messages wait, commands and telemetry."""
        return len(self._ordered) + len(self._latest)

    def close(self, code: int, reason: str) -> None:
        """Ask the writer to close the connection after what waits in order was sent."""
        if self.close_code is None:
            self.close_code, self.close_reason = code, reason
        self._ready.set()
        self._closing.set()

    async def closing(self) -> None:
        """Wait until the connection is to be closed."""
        await self._closing.wait()

    async def take(self) -> list[Message]:
        """Wait for something to send; an empty list means that it is time to close."""
        await self._ready.wait()
        self._ready.clear()
        messages = [*self._ordered, *self._latest.values()]
        if self._untold:
            messages.append(Missed(dict(self._untold)))
        self._ordered.clear()
        self._latest.clear()
        self._untold.clear()
        if self.close_code is not None and messages:
            self._ready.set()
        return messages
