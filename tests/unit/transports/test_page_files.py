"""What the browser page gets from the server beside its sessions."""

import hashlib

import httpx
import pytest

from agent_server import assets
from tests.support.live import live

needs_page = pytest.mark.skipif(
    not (assets.page() / "index.html").exists(), reason="the page is not built: make page"
)
NETWORKS = ("face_detector", "face_mesh")
FOR_GOOD = "public, max-age=31536000, immutable"


async def test_face_networks_are_served_and_kept_by_their_hash():
    async with live() as server, httpx.AsyncClient(base_url=server.url) as http:
        for name in NETWORKS:
            manifest = await http.get(f"/v1/models/{name}/manifest.json")
            assert manifest.headers["cache-control"] == "no-cache"
            digest = manifest.json()["files"]["model.onnx"]
            address = f"/v1/models/{name}/model.onnx"
            model = await http.get(address, params={"sha256": digest})
            assert hashlib.sha256(model.content).hexdigest() == digest
            assert model.headers["cache-control"] == FOR_GOOD
            assert (await http.get(address)).headers["cache-control"] == "no-cache"


@pytest.mark.parametrize(
    "path",
    [
        "interformer_server/model.onnx",
        "face_mesh/golden.npz",
        "face_mesh/..%2Fface_mesh%2Fmodel.onnx",
        "nothing/manifest.json",
    ],
)
async def test_nothing_else_of_the_bundles_is_served(path):
    async with live() as server, httpx.AsyncClient(base_url=server.url) as http:
        assert (await http.get(f"/v1/models/{path}")).status_code == 404


@needs_page
async def test_the_runtime_of_the_networks_comes_compressed_and_the_page_may_run_it():
    (runtime,) = (assets.page() / "assets").glob("*.wasm.gz")
    async with live() as server, httpx.AsyncClient(base_url=server.url) as http:
        answer = await http.get(f"/assets/{runtime.stem}")
        assert answer.headers["content-type"] == "application/wasm"
        assert answer.headers["content-encoding"] == "gzip"
        assert answer.content.startswith(b"\0asm")
        policy = (await http.get("/")).headers["content-security-policy"]
        assert policy == (
            "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; connect-src 'self' blob:; "
            "img-src 'self' blob:"
        )


@needs_page
def test_reading_faces_adds_at_most_eight_megabytes_and_nothing_to_the_page_itself():
    built = assets.page() / "assets"
    (worker,) = built.glob("worker-*.js")
    (runtime,) = built.glob("*.wasm.gz")
    (page,) = built.glob("index-*.js")
    models = [assets.bundles() / name / "model.onnx" for name in NETWORKS]
    assert sum(path.stat().st_size for path in (worker, runtime, *models)) < 8e6
    assert "onnxruntime" not in page.read_text("utf-8")
    assert "onnxruntime" in (assets.page() / "onnxruntime.md").read_text("utf-8")


@needs_page
async def test_pages_of_other_servers_may_import_the_client_and_nothing_else():
    async with live() as server, httpx.AsyncClient(base_url=server.url) as http:
        client = await http.get("/client.js")
        assert "RendererClient" in client.text
        assert client.headers["access-control-allow-origin"] == "*"
        assert "access-control-allow-origin" not in (await http.get("/")).headers


async def test_a_made_up_person_does_what_the_page_asks_for():
    async with live() as server, httpx.AsyncClient(base_url=server.url) as http:
        clip = (await http.get("/v1/stand-in", params={"gesture": "hello", "seed": 2})).json()
        assert clip["gesture"] == "hello"
        assert len(clip["frames"][0]["joints"]) == 25
        assert clip["frames"][0]["type"] == "skeleton"
        wrong = await http.get("/v1/stand-in", params={"gesture": "juggle"})
        assert wrong.status_code == 422
        assert "juggle" in wrong.json()["detail"]
