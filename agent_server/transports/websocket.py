"""Where websockets of clients come in."""

import re
from typing import TypeGuard, get_args

from fastapi import APIRouter, WebSocket

from agent_server.logs import current_session
from agent_server.protocol import codes
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS, Codec
from agent_server.service.auth import Access
from agent_server.service.hub import Hub
from agent_server.transports.guard import shown_token
from agent_server.transports.link import Link
from agent_server.transports.visit import Entrance, Visit

SESSION_ID = re.compile(r"[A-Za-z0-9_.-]{1,64}")
SESSION_ID_RULE = "a session id has 1 to 64 letters, digits, '.', '_' and '-'"


def websocket_router(hub: Hub, access: Access) -> APIRouter:
    """Routes of the three roles: ``/v1/sessions/{id}/sensor``, ``renderer`` and ``monitor``."""
    router = APIRouter()

    @router.websocket("/v1/sessions/{session_id}/{role}")
    async def endpoint(websocket: WebSocket, session_id: str, role: str) -> None:
        codec = _agree(websocket)
        await websocket.accept(subprotocol=None if codec is None else codec.subprotocol)
        link = Link(websocket, codec or CODECS[m.SUBPROTOCOL_JSON])
        offered = websocket.scope.get("subprotocols", [])
        if codec is None and offered:
            await link.dismiss(
                codes.CLOSE_WRONG_VERSION,
                "wrong_version",
                f"the client offers the subprotocols {', '.join(offered)}, this server speaks "
                f"protocol {m.PROTOCOL}: {', '.join(CODECS)}",
            )
        elif not SESSION_ID.fullmatch(session_id):
            await link.dismiss(
                codes.CLOSE_BAD_HELLO,
                "bad_session_id",
                SESSION_ID_RULE,
            )
        elif not _is_role(role):
            await link.dismiss(
                codes.CLOSE_BAD_HELLO,
                "unknown_role",
                f"there is no role {role!r}: connect as {', '.join(get_args(m.Role))}",
            )
        else:
            door = Entrance(access, shown_token(websocket.scope))
            current_session.set(session_id)
            await Visit(hub, link, session_id, role, door).run()

    return router


def _is_role(name: str) -> TypeGuard[m.Role]:
    return name in get_args(m.Role)


def _agree(websocket: WebSocket) -> Codec | None:
    """The first coding that the client offers and the server speaks; JSON if it offers none."""
    offered = websocket.scope.get("subprotocols", [])
    if not offered:
        return None
    return next((CODECS[name] for name in offered if name in CODECS), None)
