"""The server behind a plain ``websockets`` listener, to be measured beside the one on uvicorn.

It knows the clients' websockets and ``/metrics``, and nothing else. ``python -m
agent_server.bench.plain FILE`` prints its address, as ``agent-server serve --json`` does.
"""

import asyncio
import json
import sys
from http import HTTPStatus
from pathlib import Path
from typing import Any

import uvloop
from fastapi import WebSocketDisconnect
from starlette.routing import WebSocketRoute
from websockets.asyncio.server import ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response
from websockets.typing import Subprotocol

from agent_server.config import Settings, load_settings
from agent_server.protocol.codec import CODECS
from agent_server.service.auth import OPEN
from agent_server.service.hub import Hub
from agent_server.service.loading import load_models
from agent_server.transports.server import address, bind, build_hub
from agent_server.transports.websocket import websocket_router


class _Socket:
    """A connection of ``websockets`` with the methods of Starlette's that the server calls."""

    def __init__(self, connection: ServerConnection) -> None:
        self._connection = connection
        offered = connection.subprotocol
        self.scope: dict[str, Any] = {
            "type": "websocket",
            "subprotocols": [] if offered is None else [offered],
            "agent_server.shown": None,
        }
        self.send_text = self.send_bytes = self._send

    async def accept(self, subprotocol: str | None) -> None:
        """The handshake is over already."""

    async def receive(self) -> dict[str, Any]:
        try:
            data = await self._connection.recv()
        except ConnectionClosed as closed:
            code = 1006 if closed.rcvd is None else closed.rcvd.code
            return {"type": "websocket.disconnect", "code": code}
        kind = "text" if isinstance(data, str) else "bytes"
        return {"type": "websocket.receive", kind: data}

    async def _send(self, data: str | bytes) -> None:
        try:
            await self._connection.send(data)
        except ConnectionClosed:
            raise WebSocketDisconnect(1006) from None

    async def close(self, code: int, reason: str) -> None:
        await self._connection.close(code, reason)


async def _serve(settings: Settings) -> None:
    hub = build_hub(settings, load_models(settings))
    (route,) = websocket_router(hub, OPEN).routes
    assert isinstance(route, WebSocketRoute)  # noqa: S101 - the router has no other
    listener = bind(settings)

    async def attend(connection: ServerConnection) -> None:
        assert connection.request is not None  # noqa: S101 - the handshake is over
        _, _, _, session, role = connection.request.path.split("/")
        await route.endpoint(_Socket(connection), session, role)

    async with (
        hub.run(),
        serve(
            attend,
            sock=listener,
            subprotocols=[Subprotocol(name) for name in CODECS],
            compression=None,
            max_size=2 * settings.server.max_image_bytes,
            process_request=lambda _, request: _figures(hub, request),
        ),
    ):
        await hub.warm.wait()
        print(json.dumps({"address": address(listener)}), flush=True)  # noqa: T201
        await asyncio.Event().wait()


def _figures(hub: Hub, request: Request) -> Response | None:
    if request.path != "/metrics":
        return None
    body = hub.metrics.text()
    headers = Headers({"Content-Type": "text/plain", "Content-Length": str(len(body))})
    return Response(HTTPStatus.OK.value, HTTPStatus.OK.phrase, headers, body)


if __name__ == "__main__":
    uvloop.run(_serve(load_settings(Path(sys.argv[1]))))
