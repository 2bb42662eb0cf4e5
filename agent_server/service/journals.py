"""The journals of all sessions, and the ends of those that are over."""

import asyncio
import logging
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

from agent_server.service.journal import Journal, NoJournal

log = logging.getLogger(__name__)

MAX_CLOSERS = 64
END_S = 4.0
"""How long a server that stops waits for its recordings; with all else it takes under 10 s."""


class Journals:
    """Opens a journal for each session, and ends it off the event loop.

    Args:
        open_journal: Where a session of a given id is written down; None writes nothing.
    """

    def __init__(self, open_journal: Callable[[str], Journal] | None) -> None:
        self._open_journal = open_journal
        self._open: dict[str, Journal] = {}
        self._closings: set[asyncio.Future[None]] = set()
        self._closers = ThreadPoolExecutor(MAX_CLOSERS, thread_name_prefix="closing")

    def open(self, session: str) -> Journal:
        """The journal of a session that begins."""
        journal = NoJournal() if self._open_journal is None else self._open_journal(session)
        self._open[session] = journal
        return journal

    def close(self, session: str) -> None:
        """A session is over. A slow disk may take its time to finish, and nobody else's."""
        journal = self._open.pop(session)
        if self._open_journal is None:
            return  # there is nothing to finish, and a thread costs memory
        closing = asyncio.get_running_loop().run_in_executor(self._closers, journal.close)
        self._closings.add(closing)
        closing.add_done_callback(self._closings.discard)

    async def end(self) -> None:
        """Wait for those that are being finished, but not for long."""
        self._closers.shutdown(wait=False)
        if self._closings:
            _, hanging = await asyncio.wait(self._closings, timeout=END_S)
            if hanging:
                log.error("%d recordings are not finished: the disk hangs", len(hanging))
