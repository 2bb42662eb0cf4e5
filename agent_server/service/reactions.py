"""A session's generated reactions: made beside its decisions, sent while they are made."""

import asyncio
import logging
from collections.abc import Iterator
from dataclasses import dataclass

from agent_server.domain.command import Command, Motion
from agent_server.domain.motion import Forecast, Window
from agent_server.domain.reaction import Stretch
from agent_server.protocol import convert
from agent_server.protocol import messages as m
from agent_server.service.context import Context
from agent_server.service.worker import InferenceWorker
from agent_server.stages.react import react

log = logging.getLogger(__name__)


@dataclass(frozen=True, slots=True)
class _Asked:
    """A reaction that is to be made: the command, and what will be its stretches."""

    command_id: str
    making: Iterator[Stretch]


class Reactions:
    """Makes one reaction at a time; the next command, or the end of its own, cuts it short.

    Args:
        context: The session.
        worker: The models.
    """

    def __init__(self, context: Context, worker: InferenceWorker) -> None:
        self._context = context
        self._worker = worker
        self._asked: _Asked | None = None
        self._wake = asyncio.Event()
        self._seen: tuple[Window, Forecast] | None = None

    def see(self, window: Window, forecast: Forecast) -> None:
        """Take what the person does, which the next command answers."""
        self._seen = window, forecast

    def begin(self, command: Command) -> None:
        """Give up what is under way for this command, and make its motion if it has one."""
        reactor = self._worker.models.reactor
        self._asked = None
        is_wanted = command.motion is Motion.GENERATED and self._context.audience.wants_motion
        if not is_wanted or reactor is None or self._seen is None:
            return
        self._asked = _Asked(command.id, react(reactor, *self._seen, seed=command.id))
        self._wake.set()

    def end(self, command_id: str) -> None:
        """The command is over: nothing more of its motion is made."""
        if self._asked is not None and self._asked.command_id == command_id:
            self._asked = None

    async def run(self) -> None:
        """Make what is asked for until cancelled."""
        while True:
            await self._wake.wait()
            self._wake.clear()
            asked = self._asked
            is_over = asked is None
            while asked is not None and not is_over:
                stretch = await self._worker.go_on(asked.making)
                is_over = asked is not self._asked or self._send(asked.command_id, stretch)

    def _send(self, command_id: str, stretch: Stretch) -> bool:
        """Hand on a stretch; tells whether it was the last one."""
        context = self._context
        message = convert.pose_stream_message(command_id, stretch)
        context.audience.move(message)
        context.journal.append_output(message, context.now())
        if stretch.refused is not None:
            context.counters["reactions_refused"] += 1
            said = f"the generated motion of {command_id} is not played on: {stretch.refused}"
            log.warning("session %s: %s", context.id, said)
            context.audience.show("error", m.ErrorMessage("reaction_refused", said))
        elif stretch.is_last:
            context.counters["reactions_generated"] += 1
        return stretch.is_last
