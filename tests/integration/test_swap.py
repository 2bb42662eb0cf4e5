"""Models are changed while sessions go on; what is not good changes nothing."""

import asyncio
import logging
import os
import shutil
import signal
from functools import partial
from pathlib import Path

import httpx
import msgspec
import numpy as np
import pytest

from agent_server import assets
from agent_server.clock import SystemClock
from agent_server.config import GateSettings, ModelSettings, Settings
from agent_server.errors import RecordingError
from agent_server.inference.manifest import (
    MANIFEST_FILE,
    MotionManifest,
    ReactionManifest,
    read_manifest,
    write_manifest,
)
from agent_server.protocol import messages as m
from agent_server.protocol.convert import skeleton_to_message
from agent_server.recording.reader import open_recording
from agent_server.recording.records import ModelsChanged
from agent_server.recording.topics import CORE
from agent_server.scene.rules import default_rules
from agent_server.service.auth import Access, issue
from agent_server.service.core import Core
from agent_server.service.loading import PREDICTOR, SAMPLER, load_models
from agent_server.service.recorder import recorder
from agent_server.service.replay import replay
from tests.support.bodies import stream
from tests.support.live import live, next_of
from tests.support.patience import patience, until

REACTOR = Path(__file__).parents[2] / "models" / "benchmarks" / "interformer_sbu"
SECRET = "for tests alone, and long enough for it"  # noqa: S105


@pytest.fixture(scope="module")
def shipped():
    return load_models()


def copied(folder, name, source=None, kind=MotionManifest):
    """A bundle of another name, made from the shipped predictor or another one."""
    source = source or assets.bundles() / PREDICTOR
    shutil.copytree(source, folder / name)
    manifest = read_manifest(source, kind)
    write_manifest(folder / name, msgspec.structs.replace(manifest, name=name))
    return folder / name


def swapping(folder, **more):
    return Settings(gate=GateSettings(mode="off"), models=ModelSettings(folder=str(folder), **more))


async def send(sensor, seconds, start=0):
    for frame in stream(seconds, start=start):
        await sensor.send(skeleton_to_message(frame))
        await asyncio.sleep(0.005)


async def logged(caplog, words):
    await until(lambda: words in caplog.text)


async def names_of_next(monitor):
    return set((await next_of(monitor, m.DecisionMessage)).decision.models)


async def test_a_good_bundle_takes_over_and_no_session_notices(shipped, tmp_path):
    copied(tmp_path, "newer")
    settings, models = swapping(tmp_path), shipped
    recordings = tmp_path / "recordings"
    recordings.mkdir()
    journal = partial(
        recorder, recordings, models=models, clock=SystemClock(), settings=settings, rules=b""
    )
    async with (
        live(models, settings, journal) as server,
        server.join("monitor") as monitor,
        server.join("sensor") as sensor,
        httpx.AsyncClient(base_url=server.url) as http,
    ):
        await send(sensor, 2)
        assert "ma_wgan_server" in await names_of_next(monitor)
        answer = await http.post("/v1/models/predictor", params={"path": "newer"})
        assert answer.status_code == 200, answer.text
        assert "newer" in answer.json()["models"]
        await send(sensor, 2, start=60)
        async with patience():
            while "newer" not in await names_of_next(monitor):
                pass
        assert (await http.get("/readyz")).json()["models"] == answer.json()["models"]
        assert len(server.hub.sessions["s"].audience.clients) == 2
    (path,) = recordings.glob("*.mcap")
    recording = open_recording(path)
    assert "ma_wgan_server" in recording.metadata.bundles
    changes = [
        one.message
        for one in recording.records((CORE.name,))
        if isinstance(one.message, ModelsChanged)
    ]
    assert [set(one.models) - {"newer"} for one in changes] == [
        set(models.hashes) - {"ma_wgan_server"}
    ]
    core = Core("s", settings, default_rules(models.classifier.labels), models)
    with pytest.raises(RecordingError, match="other models decided"):
        list(replay(recording, core, models))


@pytest.mark.parametrize(
    ("which", "source", "kind"),
    [
        ("sampler", assets.bundles() / SAMPLER, MotionManifest),
        ("reactions", REACTOR, ReactionManifest),
    ],
)
async def test_what_draws_and_what_reacts_is_changed_where_it_is_in_use(
    tmp_path, caplog, which, source, kind
):
    copied(tmp_path, "newer", source, kind)
    settings = swapping(tmp_path, futures=3, reactions=str(REACTOR))
    models = load_models(settings)
    async with (
        live(models, settings) as server,
        httpx.AsyncClient(base_url=server.url) as http,
    ):
        answer = await http.post(f"/v1/models/{which}", params={"path": "newer"})
        assert answer.status_code == 200, answer.text
        assert set(answer.json()["models"]) == (set(models.hashes) - {source.name}) | {"newer"}
        assert server.hub.models.hashes == answer.json()["models"]
        with caplog.at_level(logging.INFO):
            os.kill(os.getpid(), signal.SIGHUP)
            await logged(caplog, "the models are the same")
        assert server.hub.models.hashes == answer.json()["models"]


@pytest.mark.parametrize(
    ("which", "said"), [("sampler", "draws no futures"), ("reactions", "makes no reactions")]
)
async def test_what_is_not_in_use_is_not_changed(shipped, tmp_path, which, said):
    copied(tmp_path, "newer")
    async with (
        live(shipped, swapping(tmp_path)) as server,
        httpx.AsyncClient(base_url=server.url) as http,
    ):
        answer = await http.post(f"/v1/models/{which}", params={"path": "newer"})
        assert answer.status_code == 422
        assert said in answer.json()["detail"]
        assert server.hub.models is shipped


@pytest.mark.parametrize(
    ("path", "status", "said"),
    [
        ("nowhere", 422, "manifest.json"),
        ("../outside", 422, "lies outside"),
        ("/etc", 422, "lies outside"),
        ("with\0zero", 422, "is no folder"),
        ("x" * 300, 422, "manifest.json"),
        ("altered", 422, "was altered"),
        ("wrong_golden", 422, "golden output"),
        ("classifier", 422, "can classify"),
    ],
)
async def test_a_bundle_that_is_not_good_changes_nothing(shipped, tmp_path, path, status, said):
    folder = tmp_path / "bundles"
    if path == "altered":
        model = copied(folder, path) / "model.onnx"
        model.write_bytes(model.read_bytes()[:-1] + b"\0")
    elif path == "wrong_golden":
        copied(folder, path)
        other = assets.bundles() / "ma_wgan_server" / "golden.npz"
        spoil_golden(other, folder / path)
    elif path == "classifier":
        shutil.copytree(assets.bundles() / "interformer_server", folder / path)
    models = shipped
    async with (
        live(models, swapping(folder)) as server,
        httpx.AsyncClient(base_url=server.url) as http,
    ):
        answer = await http.post("/v1/models/predictor", params={"path": path})
        assert answer.status_code == status
        assert said in answer.json()["detail"]
        assert server.hub.models is models


def spoil_golden(source, bundle):
    """Give a bundle a golden output that its model does not give, with the right hash."""
    with np.load(source) as golden:
        arrays = {name: golden[name] for name in golden}
    last = list(arrays)[-1]
    arrays[last] = arrays[last] + 0.5
    np.savez(bundle / "golden.npz", **arrays)
    write_manifest(bundle, read_manifest_unchecked(bundle))


def read_manifest_unchecked(bundle):
    return msgspec.json.decode((bundle / MANIFEST_FILE).read_bytes(), type=MotionManifest)


async def test_only_an_operator_of_all_sessions_may_swap_and_only_where_it_is_meant(tmp_path):
    access = Access({}, SECRET)
    async with (
        live(settings=swapping(tmp_path), access=access) as server,
        httpx.AsyncClient(base_url=server.url) as http,
    ):
        for roles, sessions in ((["renderer", "monitor"], None), (["operator"], ["s"])):
            said = issue(SECRET, "x", roles, sessions, 60)
            answer = await http.post(
                "/v1/models/predictor",
                params={"path": "x"},
                headers={"Authorization": f"Bearer {said}"},
            )
            assert (answer.status_code, answer.json()["code"]) == (403, "not_allowed")
    async with live() as server, httpx.AsyncClient(base_url=server.url) as http:
        answer = await http.post("/v1/models/predictor", params={"path": "x"})
        assert (answer.status_code, "folder in [models]" in answer.text) == (422, True)


async def test_hup_reads_the_bundles_again_all_or_none(tmp_path, caplog):
    folder = copied(tmp_path, "mine")
    settings = swapping(tmp_path, predictor=str(folder))
    models = load_models(settings)
    async with live(models, settings) as server:
        (folder / "CARD.md").write_text("spoilt")
        os.kill(os.getpid(), signal.SIGHUP)
        await logged(caplog, "stay as they are")
        assert server.hub.models is models
