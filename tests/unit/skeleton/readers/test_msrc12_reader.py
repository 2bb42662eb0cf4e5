import gzip
import os
from pathlib import Path

import numpy as np
import pytest

from agent_server.errors import InvalidInput, RecordingError
from agent_server.skeleton.readers.msrc12 import GESTURES, read_msrc12

START = 5_000_000  # microseconds
PERIOD = 33_333


def write(folder: Path, rows: list[list[float]], tags: list[tuple[float, str]] = ()) -> Path:
    """A recording and its tags, each at a time in microseconds on the csv's clock."""
    path = folder / "P1_1_4_p22.csv"
    lines = [" ".join([str(int(row[0])), *(f"{v:g}" for v in row[1:])]) for row in rows]
    path.write_text("\n".join(lines) + "\n")
    if tags:
        text = [f"{round((tick * 49875 - 24937.5) / 1000) + 1};{label}" for tick, label in tags]
        (folder / "P1_1_4_p22.tagstream").write_text("\n".join(["XQPCTick;Tag", *text]) + "\n")
    return path


def row(index: int, fill: float = 1.25, state: int = 1) -> list[float]:
    joints = [value for joint in range(20) for value in (fill, joint / 10, -2.5, state)]
    return [START + index * PERIOD, *joints]


def untracked(index: int) -> list[float]:
    return [START + index * PERIOD, *[0.0] * 80]


def test_frames_start_at_zero_when_a_body_is_tracked(tmp_path: Path) -> None:
    rows = [untracked(0), untracked(1), *(row(i) for i in range(2, 6))]
    recording = read_msrc12(write(tmp_path, rows))
    assert [f.originating_ns for f in recording.frames] == [0, 33_333_000, 66_666_000, 99_999_000]
    assert recording.dropped == {"untracked": 2}
    assert recording.subject == "msrc12_p22"
    frame = recording.frames[0]
    assert (frame.format, frame.body_id) == ("kinect_v1", 0)
    np.testing.assert_array_equal(frame.joints[3], np.float32([1.25, 0.3, -2.5, 1.0]))
    assert not frame.joints.flags.writeable


def test_a_joint_that_is_not_tracked_has_no_confidence(tmp_path: Path) -> None:
    values = row(0)
    values[4::4] = [0.0, *[1.0] * 19]
    frame = read_msrc12(write(tmp_path, [values])).frames[0]
    assert frame.joints[0].tolist() == [1.25, 0.0, -2.5, 0.0]
    assert frame.joints[1:, 3].all()


def test_gzip_reads_the_same(tmp_path: Path) -> None:
    path = write(tmp_path, [row(i) for i in range(3)], [(START + PERIOD, "G4  Goggles")])
    packed = path.with_suffix(".csv.gz")
    packed.write_bytes(gzip.compress(path.read_bytes()))
    plain, zipped = read_msrc12(path), read_msrc12(packed)
    assert plain.marks == zipped.marks != ()
    for one, other in zip(plain.frames, zipped.frames, strict=True):
        assert one.joints.tobytes() == other.joints.tobytes()


def test_marks_are_on_the_time_line_of_the_frames(tmp_path: Path) -> None:
    rows = [untracked(0), *(row(i) for i in range(1, 40))]
    tags = [
        (START + 20 * PERIOD, "G4  Goggles"),
        (START + 10 * PERIOD, "G9  Had enough"),
        (START, "G4  Goggles"),
        (START + 99 * PERIOD, "G4  Goggles"),
        (START + 12 * PERIOD, "G13 Dance"),
    ]
    recording = read_msrc12(write(tmp_path, rows, tags))
    assert [(m.tag, m.stamp_ns) for m in recording.marks] == [
        ("G9", 9 * PERIOD * 1000),
        ("G4", 19 * PERIOD * 1000),
    ]
    assert recording.dropped == {"untracked": 1, "mark_outside": 2, "unknown_tag": 1}


def test_the_published_conversion_of_ticks(tmp_path: Path) -> None:
    path = write(tmp_path, [row(i) for i in range(3)])
    counter = 250_312_345  # (counter * 1000 + 24937.5) / 49875 = 5018794.4...
    path.with_suffix(".tagstream").write_text(f"XQPCTick;Tag\n{counter};G1  lift\n")
    (mark,) = read_msrc12(path).marks
    assert mark.stamp_ns == (int((counter * 1000 + 24937.5) // 49875) - START) * 1000


def test_a_file_without_a_body_gives_no_frames(tmp_path: Path) -> None:
    recording = read_msrc12(write(tmp_path, [untracked(0)], [(START, "G4  Goggles")]))
    assert (recording.frames, recording.marks, recording.end_ns) == ((), (), 0)


@pytest.mark.parametrize(
    ("rows", "what"),
    [
        ([row(0), row(1)[:-1]], r"P1_1_4_p22\.csv.*row 2"),
        ([row(0)[:-1]], r"P1_1_4_p22\.csv: expected 81 numbers a line.*got 80"),
        ([row(1), row(0)], r"P1_1_4_p22\.csv: its ticks do not increase"),
        ([row(0), row(1, fill=float("nan"))], r"P1_1_4_p22\.csv, line 2: a number is not finite"),
    ],
    ids=["short row", "short rows", "order", "nan"],
)
def test_wrong_content_is_named(tmp_path: Path, rows: list[list[float]], what: str) -> None:
    with pytest.raises(InvalidInput, match=what):
        read_msrc12(write(tmp_path, rows))


def test_wrong_files_are_named(tmp_path: Path) -> None:
    path = write(tmp_path, [row(0)])
    path.with_suffix(".tagstream").write_text("XQPCTick;Tag\nsoon;G4\n")
    with pytest.raises(InvalidInput, match=r"P1_1_4_p22\.tagstream, line 2: expected XQPCTick;Tag"):
        read_msrc12(path)
    path.write_text("1 2 three\n")
    with pytest.raises(InvalidInput, match=r"P1_1_4_p22\.csv: .*three"):
        read_msrc12(path)
    packed = path.with_suffix(".csv.gz")
    packed.write_bytes(b"no gzip")
    with pytest.raises(InvalidInput, match=r"csv\.gz"):
        read_msrc12(packed)
    with pytest.raises(InvalidInput, match="subject is unknown"):
        read_msrc12(tmp_path / "walk.csv")
    with pytest.raises(RecordingError, match="cannot be read"):
        read_msrc12(tmp_path / "P1_1_5_p01.csv")


def test_real_recordings() -> None:
    data = os.environ.get("AGENT_SERVER_DATA")
    folder = Path(data or "", "msrc12")
    if data is None or not folder.is_dir():
        pytest.skip("AGENT_SERVER_DATA has no msrc12")
    recording = read_msrc12(folder / "P1_1_4_p22.csv.gz")
    assert len(recording.frames) == 1005 - recording.dropped["untracked"]
    assert len(recording.marks) >= 9
    assert {mark.tag for mark in recording.marks} == {"G4"}
    assert GESTURES["G4"] == "goggles"
    heights = np.array([frame.joints[3, 1] - frame.joints[0, 1] for frame in recording.frames])
    assert 0.4 < np.median(heights) < 0.9  # from the hips up to the head, metres
