"""What a renderer remembers of its commands, so that each takes effect once (docs/clients.md)."""

from collections import OrderedDict
from dataclasses import dataclass

from agent_server.domain.stamp import NS_PER_MS
from agent_server.protocol.messages import AckMessage, CommandMessage

REMEMBERED = 256
"""Commands that are over and whose end can be said again."""
LONGEST_REASON = 500
"""Letters of a reason that the server takes."""
EXPIRED = "expired"
PREEMPTED = "preempted"


@dataclass(frozen=True, slots=True)
class Taken:
    """What a command came to.

    Attributes:
        acks: What to say to the server, in order.
        cancelled: The running command to cut short first, or None.
        order: The command if it is to be carried out, else None.
    """

    acks: tuple[AckMessage, ...]
    cancelled: CommandMessage | None = None
    order: CommandMessage | None = None


@dataclass(slots=True)
class _Open:
    """The command that is not over."""

    command: CommandMessage
    expires_ns: int
    ack: AckMessage
    is_started: bool = False


class CommandLedger:
    """The commands of one ledger of the server; survives connections, not the process.

    Attributes:
        ledger: Which one it is, or None before the first welcome.
        sequence: Highest sequence that came, 0 before the first.
    """

    def __init__(self) -> None:
        self.ledger: str | None = None
        self.sequence = 0
        self._open: _Open | None = None
        self._over: OrderedDict[str, AckMessage] = OrderedDict()

    @property
    def running(self) -> CommandMessage | None:
        """The command that is not over, or None."""
        return None if self._open is None else self._open.command

    def welcome(self, ledger: str) -> CommandMessage | None:
        """Take the ledger of a welcome; another one than before makes everything forgotten.

        Returns:
            The command that is to be cut short without a word, or None.
        """
        if ledger == self.ledger:
            return None
        cancelled = self.running
        self.ledger, self.sequence, self._open = ledger, 0, None
        self._over.clear()
        return cancelled

    def take(self, command: CommandMessage, now_ns: int) -> Taken:
        """Take a command that came at ``now_ns`` of this side's clock."""
        if self._open is not None and self._open.command.id == command.id:
            return Taken((self._open.ack,))
        if (ack := self._over.get(command.id)) is not None:
            return Taken((ack,))
        if command.age_ms >= command.ttl_ms:
            self.sequence = max(self.sequence, command.sequence)
            return Taken((self._end(AckMessage(command.id, "failed", reason=EXPIRED)),))
        if command.sequence < self.sequence:
            return Taken((self._end(AckMessage(command.id, "failed", reason=PREEMPTED)),))
        cancelled = self.running
        acks = []
        if cancelled is not None:
            acks.append(self._end(AckMessage(cancelled.id, "failed", reason=PREEMPTED)))
        self.sequence = command.sequence
        accepted = AckMessage(command.id, "accepted")
        expires_ns = now_ns + (command.ttl_ms - command.age_ms) * NS_PER_MS
        self._open = _Open(command, expires_ns, accepted)
        return Taken((*acks, accepted), cancelled, command)

    def start(self, command_id: str, now_ns: int) -> tuple[bool, AckMessage | None]:
        """The application wants to start a command.

        Returns:
            Whether it may, and what to say to the server.
        """
        entry = self._find(command_id)
        if entry is None or entry.is_started:
            return False, None
        if now_ns > entry.expires_ns:
            return False, self._end(AckMessage(command_id, "failed", reason=EXPIRED))
        entry.is_started = True
        entry.ack = AckMessage(command_id, "started")
        return True, entry.ack

    def progress(self, command_id: str, step: int) -> AckMessage | None:
        """A step has ended; None if the command is not running."""
        entry = self._find(command_id)
        if entry is None or not entry.is_started:
            return None
        entry.ack = AckMessage(command_id, "progress", step)
        return entry.ack

    def finish(self, command_id: str, failure: str | None = None) -> AckMessage | None:
        """A command is over, failed for a reason or done; None if it was not running."""
        entry = self._find(command_id)
        if entry is None or (failure is None and not entry.is_started):
            return None
        if failure is None:
            return self._end(AckMessage(command_id, "done"))
        return self._end(AckMessage(command_id, "failed", reason=failure[:LONGEST_REASON]))

    def open_ack(self) -> AckMessage | None:
        """The last word on the command that is not over, to be said again."""
        return None if self._open is None else self._open.ack

    def _find(self, command_id: str) -> _Open | None:
        entry = self._open
        return entry if entry is not None and entry.command.id == command_id else None

    def _end(self, ack: AckMessage) -> AckMessage:
        if self._find(ack.command_id) is not None:
            self._open = None
        self._over[ack.command_id] = ack
        while len(self._over) > REMEMBERED:
            self._over.popitem(last=False)
        return ack
