import json
import os
import re
from pathlib import Path

import numpy as np
import pytest

from agent_server.domain.affect import AffectSample
from agent_server.domain.label import Label
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import InvalidInput, RecordingError
from agent_server.recording.convert import ConstantAffect, convert
from agent_server.recording.reader import Recording, open_recording
from agent_server.recording.records import LabelRecord
from agent_server.skeleton.readers.msrc12 import read_msrc12

DOCS = Path(__file__).parents[3] / "docs"
PERIOD_US = 33_333


def write_msrc12(folder: Path, tags: dict[int, str], frames: int = 200) -> Path:
    """A body that stands for some seconds, with a tag at some frames."""
    start = 7_000_000
    joints = " ".join(f"0.5 {joint / 10} 2.5 1" for joint in range(20))
    csv = folder / "P3_2_4_p02.csv"
    csv.write_text("".join(f"{start + i * PERIOD_US} {joints}\n" for i in range(frames)))
    rows = [
        f"{((start + frame * PERIOD_US) * 49875 - 24937) // 1000 + 1};{label}"
        for frame, label in tags.items()
    ]
    csv.with_suffix(".tagstream").write_text("\n".join(["XQPCTick;Tag", *rows]))
    return csv


def tags_of(recording: Recording) -> list[str]:
    messages = [record.message for record in recording.records(["/label"])]
    return [message.tag for message in messages if isinstance(message, LabelRecord)]


def test_msrc12_marks_become_labels(tmp_path: Path) -> None:
    tags = {20: "G4  Goggles", 90: "G9  Had enough", 120: "G2  Duck", 190: "G1  lift arms"}
    output = tmp_path / "out.mcap"
    report = convert("msrc12", write_msrc12(tmp_path, tags), output)
    recording = open_recording(output)
    second = 1_000_000_000
    at = {frame: frame * PERIOD_US * 1000 for frame in (20, 90, 120, 190)}
    end = 199 * PERIOD_US * 1000
    half = 3 * second // 2

    def label(gesture: str, onset: int, offset: int, *, quiet: bool) -> Label:
        return Label(gesture, onset, offset, "msrc12_p02", None, quiet)

    assert recording.labels() == (
        label("bright", 0, at[20] + half, quiet=False),
        label("loud", at[90] - half, at[90] + half, quiet=False),
        label("idle", at[120] - half, at[120] + half, quiet=True),
        label("idle", at[190] - half, end, quiet=False),
    )
    assert tags_of(recording) == ["G4", "G9", "G2", "G1"]
    assert report.labels == {"bright": 1, "loud": 1, "idle": 2}
    assert (report.frames, report.bodies, report.format) == (200, 1, "kinect_v1")
    assert report.duration_s == end / second
    assert recording.metadata.face == "none"
    assert recording.metadata.joint_format == "kinect_v1"
    assert recording.metadata.created is None
    assert recording.metadata.licence == "non-commercial research only"
    assert recording.metadata.origin == "MSRC-12, P3_2_4_p02.csv"
    assert recording.metadata.session == "P3_2_4_p02"


def test_records_stand_in_the_order_of_time(tmp_path: Path) -> None:
    output = tmp_path / "out.mcap"
    source = write_msrc12(tmp_path, {100: "G4  Goggles"})
    convert("msrc12", source, output, affect=ConstantAffect(-5, 4.5, rate_hz=10))
    recording = open_recording(output)
    stamps = [record.stamp_ns for record in recording]
    assert stamps == sorted(stamps)
    faces = [event for event in recording.events() if isinstance(event, AffectSample)]
    assert len(faces) == 67
    assert faces[:2] == [AffectSample(0, -5, 4.5), AffectSample(100_000_000, -5, 4.5)]
    assert faces[-1].originating_ns <= recording.summary.end_ns
    assert recording.metadata.face == "expected"
    assert "invented" in (recording.metadata.description or "")


def test_the_same_input_gives_the_same_bytes(tmp_path: Path) -> None:
    source = write_msrc12(tmp_path, {100: "G4  Goggles"})
    for name in ("a.mcap", "b.mcap"):
        convert("msrc12", source, tmp_path / name)
    assert (tmp_path / "a.mcap").read_bytes() == (tmp_path / "b.mcap").read_bytes()


@pytest.mark.parametrize(
    ("name", "value"), [("valence", 11.0), ("arousal", float("nan")), ("rate_hz", 0.0)]
)
def test_an_affect_out_of_range_is_refused(name: str, value: float) -> None:
    values = {"valence": 0.0, "arousal": 0.0, "rate_hz": 10.0, name: value}
    with pytest.raises(InvalidInput, match=name):
        ConstantAffect(**values)


def test_the_example_of_the_documentation(tmp_path: Path) -> None:
    (example,) = re.findall(
        r"```json lines\n(.*?)```", (DOCS / "kinect-json.md").read_text(), re.DOTALL
    )
    source = tmp_path / "walk.jsonl"
    source.write_text(example)
    report = convert("kinect-json", source, tmp_path / "out.mcap")
    assert report.format == "kinect_v2"
    assert report.frames == 4
    assert report.bodies == 2
    assert report.labels == {}
    assert open_recording(tmp_path / "out.mcap").summary.topics == {"/skeleton": 4}


def test_coordinates_in_the_wrong_unit_are_refused(tmp_path: Path) -> None:
    source = tmp_path / "millimetres.jsonl"
    line = {"time_s": 0, "joints": {"Head": [120, 800, 2400]}}
    source.write_text(json.dumps({"format": "kinect_v2"}) + "\n" + json.dumps(line))
    with pytest.raises(InvalidInput, match=r"millimetres\.jsonl, skeleton 0: .*unit"):
        convert("kinect-json", source, tmp_path / "out.mcap")
    assert not (tmp_path / "out.mcap").exists()


def test_a_source_without_a_body_is_refused(tmp_path: Path) -> None:
    source = tmp_path / "empty.jsonl"
    source.write_text(json.dumps({"format": "kinect_v2"}))
    with pytest.raises(InvalidInput, match="no tracked body"):
        convert("kinect-json", source, tmp_path / "out.mcap")


def test_an_unknown_source_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="source is 'bvh': it is one of msrc12, ntu,"):
        convert("bvh", tmp_path / "a", tmp_path / "b")  # type: ignore[arg-type]


def test_an_existing_file_is_not_overwritten(tmp_path: Path) -> None:
    source = write_msrc12(tmp_path, {})
    output = tmp_path / "out.mcap"
    output.write_text("precious")
    with pytest.raises(RecordingError, match="exists already"):
        convert("msrc12", source, output)
    assert output.read_text() == "precious"


def data_folder(name: str) -> Path:
    data = os.environ.get("AGENT_SERVER_DATA")
    if data is None or not Path(data, name).is_dir():
        pytest.skip(f"AGENT_SERVER_DATA has no {name}")
    return Path(data, name)


@pytest.mark.parametrize(
    ("name", "gesture"), [("P1_1_4_p22", "bright"), ("P3_2_9_p02", "loud"), ("P2_2_10_p05", "idle")]
)
def test_real_msrc12_recordings(tmp_path: Path, name: str, gesture: str) -> None:
    source = data_folder("msrc12") / f"{name}.csv.gz"
    report = convert("msrc12", source, tmp_path / "out.mcap")
    original = read_msrc12(source)
    recording = open_recording(tmp_path / "out.mcap")
    assert report.labels == {gesture: len(original.marks)}
    assert {label.gesture for label in recording.labels()} == {gesture}
    frames = [event for event in recording.events() if isinstance(event, SkeletonFrame)]
    assert len(frames) == report.frames == len(original.frames)
    # The set is rounded to 0.1 mm, as recordings are: nothing is lost.
    for ours, theirs in zip(frames, original.frames, strict=True):
        assert ours.originating_ns == theirs.originating_ns
        assert ours.joints.tobytes() == theirs.joints.tobytes()


@pytest.mark.parametrize(
    ("name", "gesture", "quiet"),
    [
        ("a3_s1_t1", "hello", False),
        ("a13_s2_t1", "idle", True),
        ("a16_s1_t2", "idle", False),
        ("a4_s3_t1", "idle", False),
    ],
)
def test_real_utd_mhad_recordings(tmp_path: Path, name: str, gesture: str, quiet: bool) -> None:
    source = data_folder("utd_mhad") / f"{name}_skeleton.mat"
    report = convert("utd-mhad", source, tmp_path / "out.mcap")
    recording = open_recording(tmp_path / "out.mcap")
    (label,) = recording.labels()
    assert (label.gesture, label.quiet) == (gesture, quiet)
    assert (label.onset_ns, label.offset_ns) == (0, recording.summary.end_ns)
    assert tags_of(recording) == [name.partition("_")[0]]
    frames = np.stack(
        [event.joints for event in recording.events() if isinstance(event, SkeletonFrame)]
    )
    assert frames.shape == (report.frames, 20, 4)
