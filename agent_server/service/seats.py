"""Who of a session's clients may speak for the body, the face and the room: one at a time."""

from agent_server.errors import InvalidInput
from agent_server.protocol.codes import CLOSE_REPLACED
from agent_server.service.audience import Client

STAND_IN = "stand_in"
"""Capability of a renderer that gives its place to any other one."""


def _may_replace(client: Client, other: Client) -> bool:
    """Whether a client asks to take over, is the same again, or the other one only stands in."""
    hello = client.hello
    is_same = hello.instance is not None and hello.instance == other.hello.instance
    return hello.take_over or is_same or STAND_IN in other.hello.capabilities


class Seats:
    """One sender a stream and one acting renderer; another takes over only when it asks to."""

    def __init__(self) -> None:
        self._senders: dict[str, Client] = {}
        self._renderer: Client | None = None

    def require_stream(self, kind: str, client: Client) -> None:
        """Refuse a sensor that may not send the stream ``kind``; changes nothing.

        Raises:
            InvalidInput: If another sensor has the seat and this one did not ask to take over.
        """
        sender = self._senders.get(kind, client)
        if sender is not client and not _may_replace(client, sender):
            raise InvalidInput(
                f"another sensor already sends this session's {kind}: say hello with "
                "take_over = true to replace it",
                code="stream_taken",
            )

    def take_stream(self, kind: str, client: Client) -> None:
        """Give the seat of ``kind`` to a sensor that may have it and whose message was taken."""
        sender = self._senders.get(kind)
        if sender is not None and sender is not client:
            sender.outbox.close(CLOSE_REPLACED, f"another sensor took over the {kind}")
        self._senders[kind] = client

    def claim_room(self, client: Client) -> None:
        """Take the seat of the acting renderer.

        Raises:
            InvalidInput: If another renderer has it and this one did not ask to take over.
        """
        if self._renderer is not None:
            if not _may_replace(client, self._renderer):
                raise InvalidInput(
                    "another renderer acts for this session: say hello with mirror = true to "
                    "watch, or with take_over = true to replace it",
                    code="renderer_taken",
                )
            self._renderer.outbox.close(CLOSE_REPLACED, "another renderer took over")
        self._renderer = client

    def require_room(self, client: Client) -> None:
        """Refuse a renderer that does not act.

        Raises:
            InvalidInput: If it is not the acting renderer.
        """
        if self._renderer is not client:
            raise InvalidInput(
                "only the acting renderer speaks for the room; a mirror watches",
                code="not_acting",
            )

    def leave(self, client: Client) -> bool:
        """Free the client's seats; tells whether it was the acting renderer."""
        for kind in [kind for kind, sender in self._senders.items() if sender is client]:
            del self._senders[kind]
        was_acting = self._renderer is client
        if was_acting:
            self._renderer = None
        return was_acting
