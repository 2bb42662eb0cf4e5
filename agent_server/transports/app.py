"""The web application: websockets, health, sessions and the browser page."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from fastapi import FastAPI
from fastapi.responses import HTMLResponse, JSONResponse, Response
from fastapi.staticfiles import StaticFiles

from agent_server import __version__
from agent_server.service.hub import Hub
from agent_server.transports.websocket import websocket_router

_NO_PAGE = """<!doctype html><meta charset="utf-8"><title>agent-server</title>
<p>The server is running. Its page has not been built: run <code>make page</code>.</p>"""


class _Page(StaticFiles):
    """The browser page: checked for changes at each visit, and confined to this server."""

    def file_response(self, *args: Any, **kwargs: Any) -> Response:
        """A file, with what a browser may do with it."""
        response = super().file_response(*args, **kwargs)
        response.headers["Cache-Control"] = "no-cache"
        response.headers["Content-Security-Policy"] = "default-src 'self'"
        response.headers["X-Content-Type-Options"] = "nosniff"
        return response


def create_app(hub: Hub, page: Path) -> FastAPI:
    """Put the application together.

    Args:
        hub: The sessions; it runs as long as the application does.
        page: Folder of the built browser page.
    """

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        async with hub.run():
            yield

    app = FastAPI(
        title="agent-server", version=__version__, lifespan=lifespan, docs_url=None, redoc_url=None
    )
    app.include_router(websocket_router(hub))

    @app.get("/healthz")
    async def healthz() -> dict[str, str]:
        """Whether the process answers."""
        return {"status": "ok", "version": __version__}

    @app.get("/readyz")
    async def readyz() -> JSONResponse:
        """Whether sessions are admitted; models were checked before the server listened."""
        status = 200 if hub.is_running else 503
        return JSONResponse({"ready": hub.is_running, "models": hub.models.hashes}, status)

    @app.get("/v1/sessions")
    async def sessions() -> dict[str, list[dict[str, object]]]:
        """Open sessions."""
        return {
            "sessions": [
                {
                    "id": session.id,
                    "sensor": any(session.audience.having("sensor")),
                    "clients": len(session.audience.clients),
                    "decisions": session.counters["decisions"],
                }
                for session in hub.sessions.values()
            ]
        }

    if (page / "index.html").exists():
        app.mount("/", _Page(directory=page, html=True), name="page")
    else:

        @app.get("/")
        async def no_page() -> HTMLResponse:
            return HTMLResponse(_NO_PAGE, 503)

    return app
