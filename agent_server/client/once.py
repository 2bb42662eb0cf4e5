"""One connection and no more: says hello, sends and receives messages. For tools and tests."""

import asyncio
from collections.abc import AsyncIterator, Iterable
from contextlib import asynccontextmanager

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, WebSocketException
from websockets.typing import Subprotocol

from agent_server import __version__
from agent_server.domain.inputs import SensorInput
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import AgentServerError
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS, Codec
from agent_server.protocol.inputs import input_to_message, packed


class ConnectionFailed(AgentServerError):
    """The server cannot be reached, or does not want this client; the text says why."""


class Client:
    """An open connection whose hello was answered.

    Attributes:
        welcome: The server's answer.
    """

    def __init__(self, socket: ClientConnection, codec: Codec, welcome: m.Welcome) -> None:
        self.welcome = welcome
        self._socket = socket
        self._codec = codec

    async def send(self, message: m.Message) -> None:
        """Send one message.

        Raises:
            ConnectionFailed: If the connection is gone.
        """
        if self._codec.subprotocol == m.SUBPROTOCOL_MSGPACK:
            message = packed(message)
        try:
            await self._socket.send(self._codec.encode(message))
        except ConnectionClosed as error:
            raise ConnectionFailed(f"the server closed the connection: {error}") from error

    async def __aiter__(self) -> AsyncIterator[m.Message]:
        """Messages of the server until the connection ends in order.

        Raises:
            ConnectionFailed: If it ends otherwise.
        """
        try:
            async for data in self._socket:
                yield self._codec.decode_server(data)
        except ConnectionClosed as error:
            raise ConnectionFailed(f"the server closed the connection: {error}") from error


def socket_address(url: str, session: str, role: m.Role) -> str:
    """Where a role of a session connects; the server's address may be ``http`` or ``ws``."""
    base = url.rstrip("/")
    base = base.replace("http", "ws", 1) if base.startswith("http") else base
    return f"{base}/v1/sessions/{session}/{role}"


@asynccontextmanager
async def join(
    url: str,
    session: str,
    role: m.Role,
    *,
    hello: m.Hello | None = None,
    subprotocol: str = m.SUBPROTOCOL_JSON,
) -> AsyncIterator[Client]:
    """Connect to a session and be welcomed.

    Args:
        url: Address of the server, for example ``ws://127.0.0.1:8765``; ``http`` will do.
        session: Id of the session.
        role: What to come as.
        hello: What to say; None says who this is.
        subprotocol: Which coding to speak.

    Raises:
        ConnectionFailed: If the server cannot be reached or refuses.
    """
    codec = CODECS[subprotocol]
    hello = hello or m.Hello(m.PROTOCOL, "agent-server-client", __version__)
    address = socket_address(url, session, role)
    try:
        socket = await connect(
            address,
            subprotocols=[Subprotocol(subprotocol)],
            compression=None,
            max_size=None,
            # Who only sends need not read; pings are answered still, which a full queue prevents.
            max_queue=None,
            # A client that has stopped reading would otherwise wait long for a farewell.
            close_timeout=1.0,
        )
    except (OSError, WebSocketException, TimeoutError) as error:
        raise ConnectionFailed(f"cannot connect to {address}: {error}") from error
    async with socket:
        try:
            await socket.send(codec.encode(hello))
            answer = codec.decode_server(await socket.recv())
        except ConnectionClosed as error:
            raise ConnectionFailed(f"{address} closed the connection: {error}") from error
        if isinstance(answer, m.ErrorMessage):
            raise ConnectionFailed(f"{address} refused: {answer.message}")
        if not isinstance(answer, m.Welcome):
            raise ConnectionFailed(f"{address} did not answer hello with welcome")
        yield Client(socket, codec, answer)


async def send_paced(client: Client, events: Iterable[SensorInput], speed: float) -> int:
    """Send recorded events with the timing of their stamps.

    Args:
        client: A sensor's connection.
        events: Ordered by their stamps.
        speed: 1 is real time, 2 twice as fast; ``inf`` sends as fast as the server takes them.

    Returns:
        How many were sent.
    """
    loop = asyncio.get_running_loop()
    start_s = loop.time()
    first_ns: int | None = None
    count = 0
    for event in events:
        first_ns = event.originating_ns if first_ns is None else first_ns
        due_s = start_s + (event.originating_ns - first_ns) / NS_PER_S / speed
        if (wait_s := due_s - loop.time()) > 0:
            await asyncio.sleep(wait_s)
        await client.send(input_to_message(event))
        count += 1
    return count
