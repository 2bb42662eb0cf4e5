"""A renderer's client: orders come once, whatever happens to the connection."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from random import Random
from typing import Any

from agent_server.client.ledger import PREEMPTED, CommandLedger
from agent_server.client.link import Link, Options
from agent_server.client.running import Listening
from agent_server.clock import Clock, SystemClock
from agent_server.protocol import messages as m

FORGOTTEN = "forgotten"


@dataclass(frozen=True, slots=True)
class Cancelled:
    """A command that is to be cut short.

    Attributes:
        command: Which one.
        reason: ``preempted`` by a newer one, or ``forgotten`` by a server that began anew.
    """

    command: m.CommandMessage
    reason: str


Event = (
    m.CommandMessage | Cancelled | m.PoseStreamMessage | m.SceneState | m.Welcome | m.ErrorMessage
)


class Renderer(Listening[Event]):
    """Carries commands out for a session; use it as a context manager.

    Args:
        options: Server, session, and what the client is.
        objects: Gives the state of each object as it is shown, to be reconciled; None shows none.
        mirror: Only watch: commands come, and nothing is answered.
        capabilities: What it can do beside resuming and reporting steps; with ``pose_stream``
            generated motion comes too.
        clock: Where to read the time.
        random: Where waiting times come from.

    Iterating it gives what comes: welcomes, orders, stretches of the motion of the one under way,
    cancellations, the room and errors, in order.
    """

    def __init__(
        self,
        options: Options,
        *,
        objects: Callable[[], Mapping[str, str]] | None = None,
        mirror: bool = False,
        capabilities: tuple[str, ...] = (),
        clock: Clock | None = None,
        random: Random | None = None,
    ) -> None:
        super().__init__()
        self._clock = clock or SystemClock()
        self._ledger = CommandLedger()
        self._objects = objects
        self._mirror = mirror
        self._unsent: dict[str, m.AckMessage] = {}
        self.link = Link(
            options,
            "renderer",
            welcomed=self._welcome,
            received=self._receive,
            resume=self._resume,
            capabilities=("resume", "progress", *capabilities),
            clock=self._clock,
            random=random,
        )

    # ------------------------------------------------------------------ what the application says

    def start(self, command_id: str) -> bool:
        """Begin a command. False: it is over, or too late to begin; then do nothing."""
        may, ack = self._ledger.start(command_id, self._clock.now_ns())
        self._say(ack)
        return may

    def progress(self, command_id: str, step: int) -> bool:
        """A step has ended. False: the command is not running any more."""
        return self._say(self._ledger.progress(command_id, step))

    def done(self, command_id: str) -> bool:
        """A command was carried out. False: it was not running any more."""
        return self._say(self._ledger.finish(command_id))

    def fail(self, command_id: str, reason: str) -> bool:
        """A command cannot be carried out, for a reason in words. False: it is over."""
        return self._say(self._ledger.finish(command_id, reason))

    async def report(self, name: str, state: str) -> bool:
        """Somebody changed an object by hand. False: there is no connection to say it on.

        A change that was not said comes out by the objects of the next hello.
        """
        return await self.link.send(m.SceneEvent(name, state))

    # ------------------------------------------------------------------ what the server says

    def _resume(self) -> dict[str, Any]:
        known: dict[str, Any] = {"mirror": self._mirror}
        if self._objects is not None:
            known["objects"] = dict(self._objects())
        if self._ledger.ledger is not None:
            known["ledger"] = self._ledger.ledger
            known["last_sequence"] = self._ledger.sequence
        return known

    def _welcome(self, welcome: m.Welcome) -> None:
        forgotten = self._ledger.welcome(welcome.ledger)
        if forgotten is not None:
            self._events.put_nowait(Cancelled(forgotten, FORGOTTEN))
        if not welcome.resumed:
            self._unsent.clear()
        self._events.put_nowait(welcome)
        unsent, self._unsent = self._unsent, {}
        if (ack := self._ledger.open_ack()) is not None:
            unsent[ack.command_id] = ack
        for ack in unsent.values():
            self._say(ack)

    def _receive(self, message: m.Message) -> None:
        match message:
            case m.CommandMessage() if self._mirror:
                self._events.put_nowait(message)
            case m.CommandMessage():
                taken = self._ledger.take(message, self._clock.now_ns())
                for ack in taken.acks:
                    self._say(ack)
                if taken.cancelled is not None:
                    self._events.put_nowait(Cancelled(taken.cancelled, PREEMPTED))
                if taken.order is not None:
                    self._events.put_nowait(taken.order)
            case m.PoseStreamMessage(command_id=command_id):
                running = self._ledger.running
                if self._mirror or (running is not None and running.id == command_id):
                    self._events.put_nowait(message)
            case m.SceneState() | m.ErrorMessage():
                self._events.put_nowait(message)

    def _say(self, ack: m.AckMessage | None) -> bool:
        """Say a word now, or remember it for the next connection."""
        if ack is None:
            return False
        if not self.link.post(ack):
            self._unsent[ack.command_id] = ack
        return True
