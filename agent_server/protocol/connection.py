"""The server's side of one connection, without any input or output.

The shell feeds what a websocket received into :meth:`ServerConnection.receive` and acts on the
event that comes back. State changes in one place, :meth:`ServerConnection._enter`.
"""

from dataclasses import dataclass
from enum import Enum, auto

from agent_server.errors import InvalidInput
from agent_server.protocol import messages as m
from agent_server.protocol.clock_estimate import ClockEstimate
from agent_server.protocol.codec import Codec, Wire
from agent_server.protocol.codes import (
    CLOSE_BAD_HELLO,
    CLOSE_SILENT,
    CLOSE_TOO_MANY_ERRORS,
    CLOSE_WRONG_VERSION,
)
from agent_server.protocol.roles import CLIENT_SENDS

HEARTBEAT = "heartbeat"
"""Capability of clients that answer pings."""
SILENT_HEARTBEATS = 2.5
"""A client that does, and was not heard for so many heartbeats, is gone."""

FORGIVENESS = 0.1
"""How much of an error a good message pays back: below one bad message in ten nobody is cut."""


class State(Enum):
    """Life of a connection."""

    OPENING = auto()
    OPEN = auto()
    CLOSED = auto()


_NEXT = {
    State.OPENING: {State.OPEN, State.CLOSED},
    State.OPEN: {State.CLOSED},
    State.CLOSED: set[State](),
}


@dataclass(frozen=True, slots=True)
class Greeted:
    """The client said hello; answer with a welcome."""

    hello: m.Hello


@dataclass(frozen=True, slots=True)
class Received:
    """A message for the session."""

    message: m.Message


@dataclass(frozen=True, slots=True)
class Reply:
    """Send this, and nothing else happened."""

    message: m.Message


@dataclass(frozen=True, slots=True)
class ClockJumped:
    """The client's clock, or this one, has jumped by so many nanoseconds."""

    by_ns: int


@dataclass(frozen=True, slots=True)
class Refused:
    """Send this error; close the connection when a close code is given."""

    error: m.ErrorMessage
    close_code: int | None = None


Event = Greeted | Received | Reply | ClockJumped | Refused | None


class ServerConnection:
    """One connection's protocol state.

    Args:
        session: Session of the client's address.
        role: What the client came as.
        codec: The coding that was agreed.
        max_message_bytes: Longer messages are refused ...
        max_image_bytes: ... but for images, which may have this many.
        max_errors: Errors that may be open before the connection is closed.
        heartbeat_ns: Time from one ping to the next.
    """

    def __init__(
        self,
        session: str,
        role: m.Role,
        codec: Codec,
        *,
        max_message_bytes: int,
        max_image_bytes: int,
        max_errors: int,
        heartbeat_ns: int,
    ) -> None:
        self.clock = ClockEstimate()
        self.session = session
        self.role = role
        self.codec = codec
        self.state = State.OPENING
        self.rejected = 0
        self._max_message_bytes = max_message_bytes
        self._max_image_bytes = max_image_bytes
        self._max_errors = max_errors
        self._errors = 0.0
        self._allowed = CLIENT_SENDS[role]
        self._heartbeat_ns = heartbeat_ns
        self._heard_ns = 0
        self._answers_pings = False

    def receive(self, data: Wire, now_ns: int) -> Event:
        """Take one websocket message.

        Args:
            data: Text or bytes as received.
            now_ns: The server's monotonic clock.

        Returns:
            What it means, or None for a message that asks for nothing.
        """
        self._heard_ns = now_ns
        size = len(data) if isinstance(data, bytes) or data.isascii() else len(data.encode())
        try:
            # Only binary messages can be images; which of them are, decoding tells.
            self._check_size(size, is_image=isinstance(data, bytes))
            message = self.codec.decode_client(data)
            self._check_size(size, is_image=isinstance(message, m.Image))
            event = self._accept(message, now_ns)
        except InvalidInput as error:
            return self.refuse(error)
        if self._errors > 0.0:
            self._errors = max(0.0, self._errors - FORGIVENESS)
        return event

    def refuse(self, error: InvalidInput) -> Refused:
        """Count an error that the client made, found here or further in."""
        self.rejected += 1
        self._errors += 1.0
        close_code = None
        message = str(error)
        if self.state is State.OPENING:
            close_code = CLOSE_WRONG_VERSION if error.code == "wrong_version" else CLOSE_BAD_HELLO
        elif self._errors > self._max_errors:
            close_code = CLOSE_TOO_MANY_ERRORS
            message += f" (closing: more than {self._max_errors} errors are open)"
        if close_code is not None:
            self.close()
        return Refused(
            m.ErrorMessage(error.code, message, error.field, fatal=close_code is not None),
            close_code,
        )

    def beat(self, now_ns: int) -> Reply | Refused:
        """A heartbeat has passed: ping the client, or give it up if it ought to have answered."""
        silent_ns = now_ns - self._heard_ns
        if not self._answers_pings or silent_ns <= SILENT_HEARTBEATS * self._heartbeat_ns:
            return Reply(m.Ping(now_ns))
        self.close()
        sentence = f"nothing was heard for {silent_ns / 1e9:.1f} s, though pings were sent"
        return Refused(m.ErrorMessage("silent", sentence, fatal=True), CLOSE_SILENT)

    def close(self) -> None:
        """Note that the connection is over."""
        if self.state is not State.CLOSED:
            self._enter(State.CLOSED)

    def _check_size(self, size: int, *, is_image: bool) -> None:
        limit = self._max_image_bytes if is_image else self._max_message_bytes
        if size > limit:
            kind = "image" if is_image else "message"
            raise InvalidInput(
                f"the {kind} has {size} bytes, the limit is {limit}", code="too_large"
            )

    def _accept(self, message: m.Message, now_ns: int) -> Event:
        if self.state is State.OPENING:
            return self._greet(message)
        match message:
            case m.Ping(sent_ns=sent_ns):
                return Reply(m.Pong(sent_ns, now_ns))
            case m.Pong(sent_ns=sent_ns, time_ns=time_ns):
                jump_ns = self.clock.push(sent_ns, time_ns, now_ns)
                return None if jump_ns is None else ClockJumped(jump_ns)
            case _ if isinstance(message, self._allowed):
                return Received(message)
        tag = message.__struct_config__.tag
        raise InvalidInput(
            f"a {self.role} does not send {tag!r} messages"
            + (" twice" if isinstance(message, m.Hello) else ""),
            field="type",
            code="wrong_role",
        )

    def _greet(self, message: m.Message) -> Event:
        if not isinstance(message, m.Hello):
            raise InvalidInput(
                f"the first message must be hello, got {message.__struct_config__.tag!r}",
                field="type",
                code="hello_expected",
            )
        major = int(message.protocol.partition(".")[0])
        if major != m.PROTOCOL_MAJOR:
            raise InvalidInput(
                f"the client speaks protocol {message.protocol}, this server speaks "
                f"{m.PROTOCOL}: use a client of major version {m.PROTOCOL_MAJOR}",
                field="protocol",
                code="wrong_version",
            )
        for name, meant, found in (
            ("session", message.session, self.session),
            ("role", message.role, self.role),
        ):
            if meant not in (None, found):
                raise InvalidInput(
                    f"hello says {name} {meant!r}, the address says {found!r}: let both say the "
                    "same, or leave it out of hello",
                    field=name,
                    code="wrong_address",
                )
        self._answers_pings = HEARTBEAT in message.capabilities
        self._enter(State.OPEN)
        return Greeted(message)

    def _enter(self, state: State) -> None:
        if state not in _NEXT[self.state]:
            raise RuntimeError(f"a connection cannot go from {self.state} to {state}")
        self.state = state
