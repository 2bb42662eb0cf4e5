"""A link that runs in the background, and what comes of it."""

import asyncio
from collections.abc import AsyncIterator
from types import TracebackType
from typing import Generic, Self, TypeVar

from agent_server.client.link import Link

T = TypeVar("T")


class Running:
    """A client whose link runs as long as it is entered as a context manager.

    Attributes:
        link: The connection.
    """

    link: Link

    def __init__(self) -> None:
        self._task: asyncio.Task[None] | None = None

    async def __aenter__(self) -> Self:
        self._task = asyncio.create_task(self.link.run(), name=self.link.role)
        self._task.add_done_callback(lambda _: self._end())
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)

    def check(self) -> None:
        """Raise what has ended the link for good, if anything has.

        Raises:
            ConnectionFailed: If the server says that coming back is of no use.
        """
        if self._task is not None and self._task.done() and not self._task.cancelled():
            self._task.result()

    def _end(self) -> None:
        """The link has ended for good."""


class Listening(Running, Generic[T]):
    """A client that is iterated for what comes."""

    def __init__(self) -> None:
        super().__init__()
        self._events: asyncio.Queue[T | None] = asyncio.Queue()  # None is the end

    async def __aiter__(self) -> AsyncIterator[T]:
        """What comes, in order, over lost connections.

        Raises:
            ConnectionFailed: If the server says that coming back is of no use.
        """
        while (event := await self._events.get()) is not None:
            yield event
        self.check()

    def _end(self) -> None:
        self._events.put_nowait(None)
