import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from agent_server.errors import InvalidInput, RecordingError
from agent_server.skeleton.formats import get_format
from agent_server.skeleton.readers.kinect_json import read_kinect_json

TABLE = [[0.1 * joint, 0.5, 2.0, 1.0] for joint in range(25)]


def write(folder: Path, *lines: Any) -> Path:
    path = folder / "export.jsonl"
    path.write_text(
        "\n".join(line if isinstance(line, str) else json.dumps(line) for line in lines)
    )
    return path


def test_joints_in_table_order(tmp_path: Path) -> None:
    path = write(
        tmp_path,
        {"format": "kinect_v2", "subject": "ann"},
        {"originating_ns": 5_000, "body_id": 3, "joints": TABLE},
        "",
        {"originating_ns": 9_000, "body_id": 3, "joints": TABLE},
    )
    recording = read_kinect_json(path)
    assert (recording.format, recording.subject) == ("kinect_v2", "ann")
    assert [(f.originating_ns, f.body_id) for f in recording.frames] == [(0, 3), (4_000, 3)]
    np.testing.assert_array_equal(recording.frames[0].joints, np.float32(TABLE))


@pytest.mark.parametrize("name", ["HandTipLeft", "hand_tip_left", "hand tip left"])
def test_joints_by_name_in_any_spelling(tmp_path: Path, name: str) -> None:
    joints = {"Head": [0.25, 0.5, 2.0], name: [1.0, 2.0, 3.0, 0.5]}
    path = write(tmp_path, {"format": "kinect_v2"}, {"time_s": 0.5, "joints": joints})
    (frame,) = read_kinect_json(path).frames
    names = get_format("kinect_v2").names
    assert frame.joints[names.index("head")].tolist() == [0.25, 0.5, 2.0, 1.0]
    assert frame.joints[names.index("hand_tip_left")].tolist() == [1.0, 2.0, 3.0, 0.5]
    assert (frame.joints[:, 3] > 0).sum() == 2


def test_three_ways_to_tell_the_time(tmp_path: Path) -> None:
    header = {"format": "kinect_v2", "rate_hz": 30}
    for lines, stamps in (
        ([{"frame": 4}, {"frame": 7}], [0, 100_000_000]),
        ([{"time_s": 1.5}, {"time_s": 1.75}], [0, 250_000_000]),
        ([{"originating_ns": 20}, {"originating_ns": 10}], [0, 10]),
    ):
        path = write(tmp_path, header, *({**line, "joints": TABLE} for line in lines))
        assert [f.originating_ns for f in read_kinect_json(path).frames] == stamps


def test_ids_of_a_kinect_fit_a_json_number(tmp_path: Path) -> None:
    line = {"time_s": 0, "body_id": 72057594037931101, "joints": TABLE}
    (frame,) = read_kinect_json(write(tmp_path, {"format": "kinect_v2"}, line)).frames
    assert frame.body_id == 72057594037931101 - 2**56


def test_a_line_without_a_tracked_joint_is_left_out(tmp_path: Path) -> None:
    path = write(
        tmp_path,
        {"format": "kinect_v2"},
        {"time_s": 0, "joints": {}},
        {"time_s": 1, "joints": {"Head": [1, 2, 3, 0]}},
        {"time_s": 2, "joints": TABLE},
    )
    recording = read_kinect_json(path)
    assert recording.dropped == {"untracked": 2}
    assert [frame.originating_ns for frame in recording.frames] == [0]


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ('{"time_s": 0', "line 2: this is no JSON object"),
        ({"time_s": 0}, "line 2.*`joints`"),
        ({"joints": TABLE}, "line 2, time_s: give exactly one of"),
        ({"time_s": 0, "frame": 0, "joints": TABLE}, "line 2, frame: give exactly one of"),
        ({"time_s": -1, "joints": TABLE}, "line 2, time_s: Expected `float` >= 0"),
        ({"frame": 0, "joints": TABLE}, "line 2, frame: the header must give rate_hz"),
        ({"time_s": 0, "joints": TABLE[:-1]}, "line 2, joints: kinect_v2 has 25 joints, got 24"),
        (
            {"time_s": 0, "joints": {"Tail": [0, 0, 0]}},
            r"line 2, joints\.Tail: kinect_v2 has no such joint, it has spine_base, ",
        ),
        ({"time_s": 0, "joints": {"Head": [0, 0]}}, r"line 2, joints.*length >= 3"),
        ({"time_s": 0, "joints": {"Head": ["a", 0, 0]}}, r"line 2, joints.*Expected `float`"),
        ({"time_s": 0, "joints": {"Head": [1e39, 0, 0]}}, r"joints\.Head: .* is far too large"),
        ({"time_s": 0, "joints": {"Head": [0, 0, 0, 2]}}, r"joints\.Head: confidence 2"),
        ({"time_s": 0, "joints": [*TABLE[:-1], [0, 0, 0, -1]]}, r"joints\[24\]: confidence -1"),
        ({"time_s": 0, "body_id": -1, "joints": TABLE}, "line 2, body_id"),
    ],
)
def test_wrong_lines_are_named(tmp_path: Path, line: Any, what: str) -> None:
    path = write(tmp_path, {"format": "kinect_v2"}, line)
    with pytest.raises(InvalidInput, match=what) as caught:
        read_kinect_json(path)
    assert "export.jsonl" in str(caught.value)


def test_a_body_twice_at_one_time_is_refused(tmp_path: Path) -> None:
    line = {"time_s": 0.5, "body_id": 1, "joints": TABLE}
    path = write(tmp_path, {"format": "kinect_v2"}, line, {**line, "body_id": 2}, line)
    with pytest.raises(InvalidInput, match="line 4, body_id: body 1 is at this time in line 2 too"):
        read_kinect_json(path)


def test_a_frame_beyond_all_time_is_refused(tmp_path: Path) -> None:
    header = {"format": "kinect_v2", "rate_hz": 1}
    path = write(tmp_path, header, {"frame": 10**8, "joints": TABLE})
    with pytest.raises(InvalidInput, match="line 2, frame: 100000000 is too large"):
        read_kinect_json(path)


@pytest.mark.parametrize(
    ("header", "what"),
    [
        ({"format": "kinect_v9"}, "line 1, format: format 'kinect_v9' is not known.*kinect_v2"),
        ({"rate_hz": 30}, "line 1.*`format`"),
        ({"format": "kinect_v2", "rate_hz": 0}, "line 1, rate_hz"),
        ("[]", "line 1"),
    ],
)
def test_a_wrong_header_is_named(tmp_path: Path, header: Any, what: str) -> None:
    with pytest.raises(InvalidInput, match=what):
        read_kinect_json(write(tmp_path, header))


def test_an_empty_or_missing_file(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="is empty"):
        read_kinect_json(write(tmp_path, ""))
    with pytest.raises(RecordingError, match="cannot be read"):
        read_kinect_json(tmp_path / "none.jsonl")
    assert read_kinect_json(write(tmp_path, {"format": "kinect_v2"})).frames == ()
