"""Labels of a recording over HTTP: who may read and save them, and what else of it changes."""

import os
import shutil
from collections import Counter
from itertools import pairwise
from pathlib import Path

import httpx
import msgspec
import pytest

from agent_server.config import Settings
from agent_server.domain.label import Label
from agent_server.domain.motion import FRAME_NS
from agent_server.domain.stamp import to_ns
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from agent_server.recording.items import Tagged, read_entries
from agent_server.recording.reader import open_recording
from agent_server.service.auth import RIGHTS, Access, issue
from tests.support.live import live

ROOT = Path(__file__).parents[2]
STREAMS = ROOT / "recorded_streams"

SECRET = "for tests alone, and long enough for it"  # noqa: S105
HEADINGS = "gesture,onset_s,offset_s,subject,expected,quiet\n"
TABLE = f"{HEADINGS}cold,3.04,6.2,anna,close_window,no\nidle,8,9.000000001,,,yes\n"
LABELS = (
    Label("cold", to_ns(3.04), to_ns(6.2), "anna", "close_window", False),
    Label("idle", to_ns(8), to_ns(9) + 1, "", None, True),
)


@pytest.fixture
def folder(tmp_path):
    """A folder of one's own with a recording."""
    shutil.copy(STREAMS / "cold.mcap", tmp_path / "mine.mcap")
    return tmp_path


def at(folder):
    settings = Settings()
    own = msgspec.structs.replace(settings.server, streams=str(folder))
    return msgspec.structs.replace(settings, server=own)


def asking(server, *roles, sessions=None):
    said = issue(SECRET, "tester", roles or RIGHTS, sessions, 60)
    return httpx.AsyncClient(
        base_url=f"{server.url}/v1/streams/", headers={"Authorization": f"Bearer {said}"}
    )


def asking_open(server):
    return httpx.AsyncClient(base_url=f"{server.url}/v1/streams/")


def others(path):
    """Everything in a recording but its labels."""
    records = open_recording(path).records()
    return [(one.topic, one.stamp_ns, one.message) for one in records if one.topic != "/label"]


def is_label(entry):
    return isinstance(entry.item, Tagged)


def tags(path):
    items = (entry.item for entry in read_entries(open_recording(path)) if is_label(entry))
    return {item.label: item.tag for item in items}


async def test_labels_are_saved_and_nothing_else_changes(folder):
    path = folder / "mine.mcap"
    before, metadata = others(path), open_recording(path).metadata
    os.utime(path, (1e9, 1e9))
    async with live(settings=at(folder)) as server, httpx.AsyncClient(base_url=server.url) as http:
        address = "/v1/streams/mine/labels"
        old = await http.get(address)
        assert old.text.startswith(
            f"{HEADINGS}idle,0,4,s01,,yes\ncold,4,7.977940438,s01,close_window,no\n"
        )
        saved = await http.put(address, content=TABLE, headers={"If-Match": old.headers["ETag"]})
        assert (saved.status_code, saved.text) == (200, TABLE)
        late = await http.put(address, content=TABLE, headers={"If-Match": old.headers["ETag"]})
        assert late.status_code == 412
        assert "somebody else" in late.json()["detail"]
        assert (await http.get(address)).headers["ETag"] == saved.headers["ETag"]
    assert open_recording(path).labels() == LABELS
    assert others(path) == before
    assert open_recording(path).metadata == metadata
    assert path.stat().st_mtime == 1e9
    assert [one.name for one in folder.iterdir()] == ["mine.mcap"]


async def test_a_label_that_stays_keeps_the_name_that_its_data_set_gave_it(folder):
    shutil.copy(ROOT / "tests" / "golden" / "recording_v1.mcap", folder / "a.mcap")
    before = tags(folder / "a.mcap")
    assert any(before.values())
    async with live(settings=at(folder)) as server, asking_open(server) as http:
        table = (await http.get("a/labels")).text
        assert (await http.put("a/labels", content=table)).text == table
    assert tags(folder / "a.mcap") == before


async def test_all_labels_may_go(folder):
    async with live(settings=at(folder)) as server, asking_open(server) as http:
        assert (await http.put("mine/labels", content=HEADINGS)).text == HEADINGS
    assert open_recording(folder / "mine.mcap").labels() == ()


async def test_only_an_operator_saves_and_only_in_a_folder_of_ones_own(folder):
    access = Access({}, SECRET)
    whole = (folder / "mine.mcap").read_bytes()
    async with live(settings=at(folder), access=access) as server:
        for roles, sessions in ((("monitor", "renderer", "sensor"), None), (("operator",), ["s"])):
            async with asking(server, *roles, sessions=sessions) as http:
                assert (await http.get("mine/labels")).status_code == 200
                assert "ask for another" in (await http.get("mine/about")).json()["refusal"]
                answer = await http.put("mine/labels", content=TABLE)
                assert (answer.status_code, answer.json()["code"]) == (403, "not_allowed")
        assert (folder / "mine.mcap").read_bytes() == whole
        async with asking(server, "operator") as http:
            assert (await http.get("mine/about")).json()["refusal"] is None
            assert (await http.put("mine/labels", content=TABLE)).status_code == 200
    async with live() as server, asking_open(server) as http:
        answer = await http.put("cold/labels", content=TABLE)
        assert answer.status_code == 409
        assert "streams in [server]" in answer.json()["detail"]
        assert (await http.get("cold/about")).json()["refusal"] == answer.json()["detail"]


@pytest.mark.parametrize(
    ("table", "status", "words"),
    [
        (f"{HEADINGS}cold,6,3,,,\n", 422, "labels, line 2: onset_s is 6 and offset_s 3"),
        (f"{HEADINGS}cold,3000,3001,,,\n", 422, "begins at 3000.000 s, outside the recording"),
        (f"{HEADINGS}cold,3,6,,close_window,yes\n", 422, "leave one of them out"),
        ("", 422, "lacks gesture"),
        (b"\xff\xfe", 422, "not UTF-8"),
        (b"x" * 1_048_577, 413, "1048576 bytes"),
    ],
)
async def test_a_wrong_table_is_named_and_changes_nothing(folder, table, status, words):
    whole = (folder / "mine.mcap").read_bytes()
    (folder / "broken.mcap").write_bytes(whole[:5000])
    async with live(settings=at(folder)) as server, asking_open(server) as http:
        answer = await http.put("mine/labels", content=table)
        assert answer.status_code == status
        assert words in answer.json()["detail"]
        for what in ("about", "motion", "labels"):
            assert (await http.get(f"nowhere/{what}")).status_code == 404
            assert (await http.get(f"broken/{what}")).status_code == 422
    assert (folder / "mine.mcap").read_bytes() == whole


async def test_the_page_gets_the_body_as_a_monitor_does(folder):
    async with live(settings=at(folder)) as server, asking_open(server) as http:
        about = (await http.get("mine/about")).json()
        motion = await http.get("mine/motion")
    summary = open_recording(folder / "mine.mcap").summary
    assert about["end_s"] == summary.end_ns / 1e9
    assert "cold" in about["gestures"]
    assert "close_window" in about["reactions"]
    assert "resume_work" not in about["reactions"]
    codec = CODECS[m.SUBPROTOCOL_JSON]
    poses = [codec.decode_server(line) for line in motion.text.splitlines()]
    stamps = [pose.originating_ns for pose in poses if isinstance(pose, m.PoseMessage)]
    steps = Counter(b - a for a, b in pairwise(stamps))
    assert steps.most_common(1)[0][0] == FRAME_NS
    assert all(step % FRAME_NS == 0 for step in steps)
    assert stamps[-1] - stamps[0] > 0.9 * (summary.end_ns - summary.start_ns)
    assert all(len(pose.joints) == 9 for pose in poses)
