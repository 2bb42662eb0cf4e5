"""What either side may send."""

from typing import Annotated

from agent_server.protocol.messages.fields import Message, Nanoseconds, told


class Ping(Message, frozen=True, tag="ping"):
    """Asks for a pong, which shows that the other side is there, and what its clock says."""

    sent_ns: Annotated[Nanoseconds, told("The asking side's own monotonic clock.")]


class Pong(Message, frozen=True, tag="pong"):
    """Answers a ping."""

    sent_ns: Annotated[Nanoseconds, told("As it stood in the ping.")]
    time_ns: Annotated[
        Nanoseconds, told("The answering side's own monotonic clock when it answered.")
    ]
