"""A websocket that carries messages."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress

from fastapi import WebSocket, WebSocketDisconnect

from agent_server.protocol import codes
from agent_server.protocol import messages as m
from agent_server.protocol.codec import Codec, Wire

CLOSE_ABNORMAL = 1006


class Link:
    """One connection, in one coding.

    Args:
        websocket: The accepted websocket.
        codec: What both sides speak.
    """

    def __init__(self, websocket: WebSocket, codec: Codec) -> None:
        self.codec = codec
        self._websocket = websocket

    async def receive(self) -> Wire:
        """The next message.

        Raises:
            WebSocketDisconnect: When the client has gone.
        """
        event = await self._websocket.receive()
        if event["type"] == "websocket.disconnect":
            raise WebSocketDisconnect(event.get("code", codes.CLOSE_NORMAL))
        data: Wire = event["bytes"] if event.get("text") is None else event["text"]
        return data

    async def send(self, message: m.Message) -> None:
        """Send one message.

        Raises:
            WebSocketDisconnect: When the client has gone.
        """
        data = self.codec.encode(message)
        with _gone_as_disconnect():
            if isinstance(data, str):
                await self._websocket.send_text(data)
            else:
                await self._websocket.send_bytes(data)

    async def close(self, code: int, reason: str) -> None:
        """Close the connection; one that is gone already is closed."""
        # A close frame carries at most 123 bytes of reason.
        with suppress(WebSocketDisconnect), _gone_as_disconnect():
            await self._websocket.close(code, reason.encode()[:123].decode(errors="ignore"))

    async def dismiss(self, close_code: int, code: str, sentence: str) -> None:
        """Send a fatal error and close."""
        with suppress(WebSocketDisconnect):
            await self.send(m.ErrorMessage(code, sentence, fatal=True))
            await self.close(close_code, sentence)


@contextmanager
def _gone_as_disconnect() -> Iterator[None]:
    """A server that has closed the websocket by itself says so by a RuntimeError."""
    try:
        yield
    except RuntimeError as error:
        raise WebSocketDisconnect(CLOSE_ABNORMAL) from error
