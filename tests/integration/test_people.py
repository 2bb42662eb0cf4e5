"""The people that the page can put before the agent."""

import shutil

import httpx
import msgspec

from agent_server import assets
from agent_server.config import Settings
from agent_server.domain.gesture import GESTURES
from agent_server.protocol.codec import CODECS
from agent_server.protocol.messages import SUBPROTOCOL_JSON
from agent_server.recording.reader import open_recording
from tests.support.live import live


async def test_a_recording_is_given_as_the_messages_that_its_sensors_sent():
    async with live() as server, httpx.AsyncClient(base_url=server.url) as http:
        names = (await http.get("/v1/streams")).json()["streams"]
        assert "demo" in names
        answer = await http.get("/v1/streams/demo", timeout=60)
    lines = [msgspec.json.decode(line) for line in answer.content.splitlines()]
    recorded = list(open_recording(assets.demo_recording()).events())
    assert [line["at_ms"] for line in lines] == sorted(line["at_ms"] for line in lines)
    codec = CODECS[SUBPROTOCOL_JSON]
    for line, event in zip(lines, recorded, strict=True):
        read = codec.decode_client(msgspec.json.encode(line["message"]).decode())
        assert read.originating_ns == event.originating_ns


async def test_only_the_recordings_of_the_folder_are_given(tmp_path):
    shutil.copy(assets.demo_recording(), tmp_path / "mine.mcap")
    (tmp_path / "broken.mcap").write_bytes(b"no recording")
    settings = Settings()
    own = msgspec.structs.replace(settings.server, streams=str(tmp_path))
    settings = msgspec.structs.replace(settings, server=own)
    async with live(settings=settings) as server, httpx.AsyncClient(base_url=server.url) as http:
        assert (await http.get("/v1/streams")).json() == {"streams": ["broken", "mine"]}
        assert (await http.get("/v1/streams/mine", timeout=60)).status_code == 200
        assert (await http.get("/v1/streams/demo")).status_code == 404
        assert (await http.get("/v1/streams/..%2Fdemo")).status_code == 404
        broken = await http.get("/v1/streams/broken")
        assert broken.status_code == 422
        assert "broken.mcap" in broken.json()["detail"]


async def test_a_made_up_person_does_the_same_for_the_same_question():
    async with live() as server, httpx.AsyncClient(base_url=server.url) as http:
        first = await http.get("/v1/stand-in?gesture=cold&seed=1&take=2")
        again = await http.get("/v1/stand-in?gesture=cold&seed=1&take=2")
        assert first.content == again.content
        assert first.json()["frames"]
        wrong = await http.get("/v1/stand-in?gesture=juggle")
        assert wrong.status_code == 422
        assert all(name in wrong.json()["detail"] for name in GESTURES)
