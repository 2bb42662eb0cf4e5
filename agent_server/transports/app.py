"""The web application: websockets, health, sessions and the browser page."""

from collections.abc import AsyncIterator, Iterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from fastapi import FastAPI, Request
from fastapi.middleware.cors import CORSMiddleware
from fastapi.responses import HTMLResponse, JSONResponse, Response
from fastapi.staticfiles import StaticFiles
from prometheus_client.exposition import CONTENT_TYPE_LATEST
from starlette.types import Scope

from agent_server import __version__, assets
from agent_server.errors import InvalidInput
from agent_server.protocol.schema import reference
from agent_server.protocol.schema.json_schema import asyncapi
from agent_server.service.auth import OPEN, Access, NotAdmitted
from agent_server.service.hub import Hub
from agent_server.service.swap import Swapper
from agent_server.transports.admin import ADMIN_PATHS, admin_router
from agent_server.transports.bundles import PAGE_FILES, bundle_router
from agent_server.transports.guard import Guard, admitted, refused, require
from agent_server.transports.labelling import labelling_router
from agent_server.transports.people import people_router
from agent_server.transports.websocket import websocket_router

_NO_PAGE = """<!doctype html><meta charset="utf-8"><title>agent-server</title>
<p>The server is running. Its page has not been built: run <code>make page</code>.</p>"""


PAGE_POLICY = (
    "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; connect-src 'self' blob:; "
    "img-src 'self' blob:"
)
"""Nothing from elsewhere; WebAssembly may run, which the face networks need, and the pictures
inside the agent's body are read, which the page makes blobs of."""
DOCS_POLICY = "default-src 'none'; style-src 'unsafe-inline'"
"""The reference runs nothing and asks for nothing."""
CLIENT = "client.js"
"""The JavaScript client; pages of other servers may import it."""


async def _refuse(_: Request, error: Exception) -> Response:
    """The answer to who lacks a right."""
    assert isinstance(error, NotAdmitted)  # noqa: S101 - it is registered for no other
    return refused(error)


class _Page(StaticFiles):
    """The browser page: checked for changes at each visit, and confined to this server."""

    def file_response(self, *args: Any, **kwargs: Any) -> Response:
        """A file, with what a browser may do with it."""
        response = super().file_response(*args, **kwargs)
        response.headers["Cache-Control"] = "no-cache"
        response.headers["Content-Security-Policy"] = PAGE_POLICY
        return response

    async def get_response(self, path: str, scope: Scope) -> Response:
        """A file; WebAssembly is built compressed, and goes out as it is."""
        if path == CLIENT:
            response = await super().get_response(path, scope)
            response.headers["Access-Control-Allow-Origin"] = "*"
            response.headers["Cross-Origin-Resource-Policy"] = "cross-origin"
            return response
        if not path.endswith(".wasm"):
            return await super().get_response(path, scope)
        response = await super().get_response(f"{path}.gz", scope)
        response.headers["Content-Type"] = "application/wasm"
        response.headers["Content-Encoding"] = "gzip"
        return response


OPEN_PATHS = ("/", "/healthz", "/readyz")
"""What needs no token, beside the page's files."""


def _page_files(page: Path) -> Iterator[str]:
    """The paths of the page's files; WebAssembly is built compressed, and asked for as it is."""
    for file in page.rglob("*"):
        yield f"/{file.relative_to(page).as_posix().removesuffix('.gz')}"


def create_app(
    hub: Hub, page: Path, access: Access = OPEN, swapper: Swapper | None = None
) -> FastAPI:
    """Put the application together.

    Args:
        hub: The sessions; it runs as long as the application does.
        page: Folder of the built browser page.
        access: Who is admitted.
        swapper: What changes the models, or None where they are not changed.
    """

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        async with hub.run():
            yield

    app = FastAPI(
        title="agent-server", version=__version__, lifespan=lifespan, docs_url=None, redoc_url=None
    )
    open_paths = (*OPEN_PATHS, *PAGE_FILES, *ADMIN_PATHS, *_page_files(page))
    app.add_middleware(Guard, access=access, settings=hub.settings, open_paths=open_paths)
    if origins := hub.settings.access.origins:
        app.add_middleware(
            CORSMiddleware,
            allow_origins=origins,
            allow_methods=["GET", "PUT", "POST"],
            allow_headers=["authorization"],
        )
    app.add_exception_handler(NotAdmitted, _refuse)
    app.include_router(websocket_router(hub, access))
    app.include_router(admin_router(hub))

    @app.get("/healthz")
    async def healthz() -> dict[str, str]:
        """Whether the process answers."""
        return {"status": "ok", "version": __version__}

    @app.get("/readyz")
    async def readyz() -> JSONResponse:
        """Whether sessions may be sent here: the models are warm, the server does not stop."""
        status = 200 if hub.is_ready else 503
        watchdog = hub.watchdog
        stalls = {"loop": watchdog.loop_stalls, "inference": watchdog.inference_stalls}
        body = {
            "ready": hub.is_ready,
            "load": hub.gauge.load.name.lower(),
            "stalls": stalls,
            "models": hub.models.hashes,
        }
        return JSONResponse(body, status)

    @app.get("/metrics")
    async def metrics() -> Response:
        """Figures for Prometheus."""
        return Response(hub.metrics.text(), media_type=CONTENT_TYPE_LATEST)

    @app.get("/asyncapi.json")
    async def asyncapi_document() -> JSONResponse:
        """The protocol as an AsyncAPI 3 document."""
        return JSONResponse(asyncapi())

    @app.get("/protocol")
    async def protocol_page() -> HTMLResponse:
        """The reference of all messages and codes, for a browser."""
        return HTMLResponse(reference.page(), headers={"Content-Security-Policy": DOCS_POLICY})

    @app.get("/v1/sessions")
    async def sessions(request: Request) -> dict[str, list[dict[str, object]]]:
        """Open sessions, as far as the token goes."""
        bearer = admitted(request.scope)
        return {
            "sessions": [
                {
                    "id": session.id,
                    "sensor": any(session.audience.having("sensor")),
                    "clients": len(session.audience.clients),
                    "decisions": session.counters["decisions"],
                }
                for session in hub.sessions.values()
                if bearer.sees(session.id)
            ]
        }

    @app.put("/v1/sessions/{session_id}/objects/{name}")
    async def set_object(request: Request, session_id: str, name: str, state: str) -> JSONResponse:
        """Set an object of a session's room by hand; renderers are told."""
        require(request.scope, session_id, "renderer", "operator")
        session = hub.sessions.get(session_id)
        if session is None:
            return JSONResponse({"detail": f"there is no open session {session_id!r}"}, 404)
        try:
            session.change_object(name, state)
        except InvalidInput as error:
            return JSONResponse({"detail": str(error)}, 422)
        return JSONResponse({"objects": session.delivery.scene().objects})

    own = hub.settings.server.streams
    streams = assets.streams() if own is None else Path(own)
    app.include_router(people_router(streams))
    app.include_router(labelling_router(hub, streams, is_own=own is not None))
    app.include_router(bundle_router(swapper))

    if (page / "index.html").exists():
        app.mount("/", _Page(directory=page, html=True), name="page")
    else:

        @app.get("/")
        async def no_page() -> HTMLResponse:
            return HTMLResponse(_NO_PAGE, 503)

    return app
