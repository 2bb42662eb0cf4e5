"""Exports, read back with the libraries that read them."""

import csv
import json
import sys
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from agent_server.config import Settings
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import ConfigError
from agent_server.qa.export.content import gather
from agent_server.qa.export.csv_files import write_csv
from agent_server.qa.export.foxglove import write_foxglove
from agent_server.qa.export.npz import write_npz
from agent_server.qa.export.rerun import write_rerun
from agent_server.qa.setup import load_setup
from agent_server.recording.label_table import read_label_table
from agent_server.recording.reader import open_recording

HELLO = Path(__file__).parents[3] / "recorded_streams" / "hello.mcap"


@pytest.fixture(scope="module")
def content():
    return gather(HELLO, load_setup(Settings()))


def test_tables_hold_everything_and_labels_can_be_read_again(content, tmp_path):
    write_csv(content, tmp_path)
    with (tmp_path / "skeleton.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == sum(len(frame.joints) for frame in content.frames)
    head = next(row for row in rows if row["joint"] == "head")
    assert 0.5 < float(head["z"]) < 4
    with (tmp_path / "decisions.csv").open(newline="") as file:
        decisions = list(csv.DictReader(file))
    assert [row["reaction"] for row in decisions if row["reaction"]] == ["greet", "greet"]
    assert sum(float(v) for k, v in decisions[0].items() if k.startswith("p_")) == pytest.approx(
        1, abs=0.001
    )
    again = read_label_table(tmp_path / "labels.csv")
    assert [(x.gesture, x.expected, x.quiet) for x in again] == [
        (x.gesture, x.expected, x.quiet) for x in open_recording(HELLO).labels()
    ]
    assert [x.onset_ns for x in again] == pytest.approx(
        [x.onset_ns for x in open_recording(HELLO).labels()], abs=1000
    )


def test_arrays_have_their_shapes(content, tmp_path):
    write_npz(content, tmp_path / "o.npz")
    with np.load(tmp_path / "o.npz", allow_pickle=False) as arrays:
        frames, decisions = len(content.frames), len(content.sights)
        assert arrays["skeleton_joints"].shape == (frames, 20, 4)
        assert arrays["joint_names"].shape == (20,)
        assert arrays["seen"].shape == (decisions, 25, 9, 3)
        assert arrays["predicted"].shape == (decisions, 50, 9, 3)
        assert arrays["probabilities"].sum(1) == pytest.approx(np.ones(decisions), abs=0.001)
        assert list(arrays["decision_reaction"]).count("greet") == 2
        assert arrays["affect"].shape[1] == 2
        assert list(arrays["label_expected"]).count("greet") == 2


def test_a_copy_for_foxglove_holds_all_records_and_the_scenes(content, tmp_path):
    output = tmp_path / "o.mcap"
    write_foxglove(content, output)
    assert [(r.topic, r.stamp_ns, r.message) for r in open_recording(output)] == [
        (r.topic, r.stamp_ns, r.message) for r in open_recording(HELLO)
    ]
    with output.open("rb") as file:
        scenes = [
            (schema.name, json.loads(message.data), message.log_time)
            for schema, channel, message in make_reader(file, validate_crcs=True).iter_messages()
            if channel.topic in ("/scene3d", "/tf")
        ]
    assert {name for name, _, _ in scenes} == {"foxglove.SceneUpdate", "foxglove.FrameTransform"}
    updates = [(data, at) for name, data, at in scenes if name == "foxglove.SceneUpdate"]
    assert len(updates) == len(content.frames) + len(content.sights)
    for data, at in updates:
        (entity,) = data["entities"]
        stamp = entity["timestamp"]
        assert stamp["sec"] * NS_PER_S + stamp["nsec"] == at
        assert all(len(line["points"]) % 2 == 0 and line["points"] for line in entity["lines"])


def test_a_file_for_rerun_is_written(content, tmp_path):
    pytest.importorskip("rerun", reason="the extra rerun is not installed")
    write_rerun(content, tmp_path / "o.rrd")
    data = (tmp_path / "o.rrd").read_bytes()
    assert data[:3] == b"RRF"
    assert len(data) > 100_000


def test_without_rerun_the_way_out_is_told(content, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "rerun", None)
    with pytest.raises(ConfigError, match="pip install"):
        write_rerun(content, tmp_path / "o.rrd")
