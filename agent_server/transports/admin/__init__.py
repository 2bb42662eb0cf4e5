"""The page for those who look after the server: sessions and how they fare."""

import time
from pathlib import Path

import msgspec
from fastapi import APIRouter, Request
from fastapi.responses import FileResponse, Response

from agent_server import __version__
from agent_server.service.health import health_of
from agent_server.service.hub import Hub
from agent_server.transports.guard import require

ADMIN_PATHS = ("/admin", "/admin.css", "/admin.js")
"""The page's files; they hold no secret. What it shows it asks for with the operator's token."""
POLICY = "default-src 'self'; img-src data:; frame-ancestors 'none'"
_FOLDER = Path(__file__).parent
_FILES = dict(zip(ADMIN_PATHS, ("page.html", "admin.css", "admin.js"), strict=True))


def admin_router(hub: Hub) -> APIRouter:
    """Routes of the page, and ``/v1/health``, which it asks every second."""
    router = APIRouter()
    began_s = time.monotonic()

    async def file(request: Request) -> Response:
        """One of the page's files."""
        headers = {"Content-Security-Policy": POLICY, "Cache-Control": "no-cache"}
        return FileResponse(_FOLDER / _FILES[request.scope["route"].path], headers=headers)

    for path in ADMIN_PATHS:
        router.get(path, include_in_schema=False)(file)

    @router.get("/v1/health")
    async def health(request: Request) -> Response:
        """How the server and all its sessions fare; for operators."""
        require(request.scope, None, "operator")
        now_ns = hub.clock.now_ns()
        body = {
            "version": __version__,
            "ready": hub.is_ready,
            "up_s": round(time.monotonic() - began_s),
            "load": hub.gauge.load.name.lower(),
            "lag_ms": round(hub.metrics.worst_lag_s * 1000, 1),
            "rss_mb": hub.metrics.resident_mb(),
            "max_sessions": hub.settings.server.max_sessions,
            "models": hub.models.hashes,
            "sessions": [health_of(session, now_ns) for session in hub.sessions.values()],
        }
        return Response(msgspec.json.encode(body), media_type="application/json")

    return router
