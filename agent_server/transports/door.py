"""How many connections there may be, and how long one may take to say what it wants.

This is decided before a byte is read, below the application: uvicorn has no such limits.
"""

import asyncio
import logging
from collections import Counter
from contextlib import suppress
from typing import Any

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.exceptions import InvalidState

from agent_server.config import Settings

log = logging.getLogger(__name__)

READ_AHEAD = 8
"""Messages of one client that may wait to be looked at before no more is read of it."""

_FULL = (
    b"HTTP/1.1 429 Too Many Requests\r\ncontent-type: application/json\r\nconnection: close\r\n"
    b"content-length: %d\r\nretry-after: 15\r\n\r\n%s"
)


class _Quiet(logging.Filter):
    """Leaves out what any client can make uvicorn log as an error of the server's."""

    def filter(self, record: logging.LogRecord) -> bool:
        return not str(record.msg).startswith("Invalid UTF-8 sequence")


class Door:
    """Counts connections.

    Args:
        settings: The limits.
    """

    def __init__(self, settings: Settings) -> None:
        self._server = settings.server
        self._trusted = frozenset(settings.access.trusted_proxies)
        self._inside: Counter[str] = Counter()
        self.handshake_timeout_s = settings.server.handshake_timeout_s
        self.turned_away = 0
        self.too_slow = 0

    def enter(self, address: str) -> str | None:
        """Let a connection in; else why not."""
        server = self._server
        refusal = None
        if self._inside.total() >= server.max_connections:
            refusal = f"{server.max_connections} connections are open and no more are taken"
        elif (
            address not in self._trusted
            and self._inside[address] >= server.max_connections_per_address
        ):
            refusal = f"{server.max_connections_per_address} connections of this address are open"
        if refusal is None:
            self._inside[address] += 1
        else:
            self.turned_away += 1
            log.info("turned away %s: %s", address, refusal)
        return refusal

    def leave(self, address: str) -> None:
        """A connection that was let in is over."""
        self._inside[address] -= 1
        if self._inside[address] <= 0:
            del self._inside[address]

    def protocols(self) -> tuple[type[asyncio.Protocol], type[asyncio.Protocol]]:
        """What uvicorn is to speak HTTP and websockets with."""
        door = self
        logger = logging.getLogger("uvicorn.error")
        if not any(isinstance(one, _Quiet) for one in logger.filters):
            logger.addFilter(_Quiet())

        class Http(_Http):
            """HTTP behind this door."""

            def __init__(self, *args: Any, **kwargs: Any) -> None:
                super().__init__(*args, **kwargs)
                self.door = door

        class WebSocket(_WebSocket):
            """Websockets behind this door."""

            def __init__(self, *args: Any, **kwargs: Any) -> None:
                super().__init__(*args, **kwargs)
                self.door = door

        return Http, WebSocket


class _Http(H11Protocol):
    """Cuts a connection that does not come to the end of its request in time."""

    door: Door
    _address: str | None = None
    _timer: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        address = _address(transport)
        refusal = self.door.enter(address)
        if refusal is not None:
            body = b'{"detail": "%s"}' % refusal.encode()
            transport.write(_FULL % (len(body), body))
            transport.close()
            return
        self._address = address
        self._timer = self.loop.call_later(self.door.handshake_timeout_s, self._cut)

    def data_received(self, data: bytes) -> None:
        if self._address is not None:
            super().data_received(data)
            self._watch()

    def on_response_complete(self) -> None:
        super().on_response_complete()
        self._watch()

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        self._stop()
        super().handle_websocket_upgrade(event)

    def connection_lost(self, exc: Exception | None) -> None:
        self._stop()
        if self._address is not None:
            self.door.leave(self._address)
        super().connection_lost(exc)

    def _watch(self) -> None:
        """Let time run while a request has begun and is not whole."""
        state = self.conn.their_state
        is_partial = state is h11.SEND_BODY or (
            state is h11.IDLE and bool(self.conn.trailing_data[0])
        )
        is_upgraded = self.transport.get_protocol() is not self
        if not is_partial or is_upgraded:
            self._stop()
        elif self._timer is None:
            self._timer = self.loop.call_later(self.door.handshake_timeout_s, self._cut)

    def _stop(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _cut(self) -> None:
        self._timer = None
        self.door.too_slow += 1
        log.info("cut %s: no whole request came in time", self._address)
        self.transport.abort()


class _WebSocket(WebSocketsSansIOProtocol):
    """Leaves the door by which it came as HTTP."""

    door: Door
    _address: str

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        super().connection_made(transport)
        self._address = _address(transport)

    def send_receive_event_to_app(self) -> None:
        """Stop reading when some messages wait; uvicorn stops at each, by two system calls."""
        reads_on = not self.read_paused and self.queue.qsize() < READ_AHEAD
        # What is paused already, uvicorn does not pause.
        self.read_paused = self.read_paused or reads_on
        super().send_receive_event_to_app()
        if reads_on:
            self.read_paused = False

    def connection_lost(self, exc: Exception | None) -> None:
        self.door.leave(self._address)
        super().connection_lost(exc)

    def shutdown(self) -> None:
        # One that the client is closing at this moment can be sent nothing more.
        with suppress(InvalidState):
            super().shutdown()
            return
        self.transport.close()


def _address(transport: asyncio.BaseTransport) -> str:
    peer = transport.get_extra_info("peername")
    return str(peer[0]) if peer else "unknown"
