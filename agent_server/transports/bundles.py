"""Bundles over HTTP: the face networks that browsers run, and changing the server's models."""

from fastapi import APIRouter, Request
from fastapi.responses import FileResponse, JSONResponse, Response

from agent_server import assets
from agent_server.errors import BundleError
from agent_server.inference.manifest import MANIFEST_FILE, MODEL_FILE
from agent_server.service.loading import Swappable
from agent_server.service.swap import Swapper
from agent_server.transports.guard import require

PAGE_NETWORKS = ("face_detector", "face_mesh")
"""Bundles that the page runs."""
PAGE_FILES = tuple(
    f"/v1/models/{name}/{file}" for name in PAGE_NETWORKS for file in (MANIFEST_FILE, MODEL_FILE)
)
"""Where they are; like the page's other files they need no token."""
FOR_GOOD = "public, max-age=31536000, immutable"


def bundle_router(swapper: Swapper | None) -> APIRouter:
    """Routes under ``/v1/models``.

    Args:
        swapper: What changes the models, or None where they are not changed.
    """
    router = APIRouter(prefix="/v1/models")

    @router.get("/{name}/{file}")
    async def face_network(name: str, file: str, sha256: str = "") -> Response:
        """A face network, for browsers that read faces themselves."""
        if name not in PAGE_NETWORKS or file not in (MANIFEST_FILE, MODEL_FILE):
            return JSONResponse({"detail": "there is no such file of a face network"}, 404)
        # What is asked for by its hash never changes.
        cache = FOR_GOOD if sha256 else "no-cache"
        return FileResponse(assets.bundles() / name / file, headers={"Cache-Control": cache})

    @router.post("/{which}")
    async def swap(request: Request, which: Swappable, path: str) -> JSONResponse:
        """Take another bundle into use, from a folder within the one that is allowed."""
        require(request.scope, None, "operator")
        if swapper is None:
            return JSONResponse({"detail": "this server changes no models"}, 404)
        try:
            return JSONResponse({"models": await swapper.take(which, path)})
        except BundleError as error:
            return JSONResponse({"detail": str(error)}, 422)

    return router
