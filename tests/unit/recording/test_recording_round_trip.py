from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.records import Chunk, Header
from mcap.stream_reader import StreamReader

from agent_server.domain.affect import AffectSample
from agent_server.domain.command import Ack, AckStatus
from agent_server.domain.face import FaceBlendshapes, FaceLandmarks
from agent_server.domain.label import Label
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import MAX_STAMP_NS, NS_PER_MS
from agent_server.errors import RecordingError
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.reader import open_recording
from agent_server.recording.records import (
    BodyGone,
    CompressedImage,
    CoreRecord,
    LabelRecord,
    Tick,
    WindowDone,
)
from agent_server.recording.sink import AT_ONCE, CHUNK_BYTES, CHUNK_NS, LIVE
from agent_server.recording.writer import RecordingWriter
from tests.support.faces import FACES

METADATA = RecordingMetadata(session="s", server_version="0")
coordinate = st.floats(-50, 50, width=32).map(lambda x: float(np.float32(round(x, 4))))
joint = st.tuples(coordinate, coordinate, coordinate, st.sampled_from([0.0, 0.5, 1.0, 0.1234]))


def frame_at(stamp_ns: int, joints: int = 9) -> SkeletonFrame:
    return SkeletonFrame(stamp_ns, 0, "core9", np.zeros((joints, 4), dtype=np.float32))


def chunks(path: Path) -> list[Chunk]:
    with path.open("rb") as file:
        records = StreamReader(file, emit_chunks=True, validate_crcs=True).records
        return [record for record in records if isinstance(record, Chunk)]


@settings(derandomize=True, deadline=None, max_examples=60)
@given(
    st.lists(joint, min_size=9, max_size=9),
    st.integers(0, MAX_STAMP_NS),
    st.integers(0, MAX_STAMP_NS),
)
def test_a_frame_comes_back_to_the_bit(
    tmp_path_factory: pytest.TempPathFactory,
    joints: list[tuple[float, float, float, float]],
    stamp_ns: int,
    body_id: int,
) -> None:
    path = tmp_path_factory.mktemp("bits") / "a.mcap"
    frame = SkeletonFrame(stamp_ns, body_id, "core9", np.array(joints, dtype=np.float32))
    with RecordingWriter(path, METADATA) as writer:
        writer.append_input(frame)
    (back,) = open_recording(path).events()
    assert isinstance(back, SkeletonFrame)
    assert (back.originating_ns, back.body_id, back.format) == (stamp_ns, body_id, "core9")
    assert back.joints.tobytes() == frame.joints.tobytes()
    assert not back.joints.flags.writeable


def test_raw_inputs_come_back_as_they_entered(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    affect = AffectSample(7, -3.25, 1 / 3)
    ack = Ack(9, "s-1", AckStatus.FAILED, step=2, reason="no such window")
    event = ObjectChanged(5, "window", "open")
    with RecordingWriter(path, METADATA) as writer:
        writer.append_input(affect)
        writer.append_input(ack)
        writer.append_core(Tick(8))
        writer.append_input(event)
    recording = open_recording(path)
    assert list(recording.events()) == [affect, ack, event]
    assert list(recording.entries()) == [affect, ack, Tick(8), event]
    assert [record.sequence for record in recording] == [0, 1, 2, 3]
    assert [record.stamp_ns for record in recording] == [7, 9, 8, 5]


def test_faces_gaze_and_calibrations_come_back_as_they_entered(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    with RecordingWriter(path, METADATA) as writer:
        for value in FACES:
            writer.append_input(value)
        writer.append_image(b"\xff\xd8 jpeg", 3_000_000_007)
    recording = open_recording(path)
    points, shapes, *rest = recording.events()
    assert isinstance(points, FaceLandmarks)
    assert np.array_equal(points.points, FACES[0].points)
    assert (points.width, points.height, points.layout) == (640, 480, "dlib68")
    assert isinstance(shapes, FaceBlendshapes)
    assert np.array_equal(shapes.values, FACES[1].values)
    assert rest == list(FACES[2:])
    image = next(recording.records(("/image",))).message
    assert isinstance(image, CompressedImage)
    assert (image.data, image.timestamp.sec, image.timestamp.nsec) == (b"\xff\xd8 jpeg", 3, 7)


def test_labels_come_sorted_and_keep_their_tags(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    late = Label("cold", 5, 9, "p1", "close_window", quiet=False)
    early = Label("idle", 0, 4, "p1", None, quiet=True)
    with RecordingWriter(path, METADATA) as writer:
        writer.append_label(late, tag="G4")
        writer.append_label(early)
    recording = open_recording(path)
    assert recording.labels() == (early, late)
    records = [record.message for record in recording]
    assert [r.tag for r in records if isinstance(r, LabelRecord)] == ["G4", ""]


def test_the_core_log_comes_back(session: ModuleType, write: Callable[[str], Path]) -> None:
    entries = list(open_recording(write("a.mcap")).entries())
    core = [entry for entry in entries if isinstance(entry, CoreRecord)]
    end = session.FRAMES * session.PERIOD_NS
    assert len(core) == 8
    assert core[-3] == WindowDone(end, index=2, failure="InferenceError: out of memory")
    assert core[-2] == BodyGone(end, body_id=1)
    # The order in which things entered is kept among frames, affect and the log itself.
    tick = next(i for i, entry in enumerate(entries) if isinstance(entry, Tick))
    before = [entry for entry in entries[:tick] if isinstance(entry, SkeletonFrame)]
    assert before[-1].originating_ns == 30 * session.PERIOD_NS


def test_two_writes_give_the_same_bytes(write: Callable[[str], Path]) -> None:
    assert write("a.mcap").read_bytes() == write("b.mcap").read_bytes()


def test_an_empty_recording_is_one(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    RecordingWriter(path, METADATA).close()
    recording = open_recording(path)
    assert recording.metadata == METADATA
    assert list(recording) == []
    assert recording.summary.duration_s == 0
    assert recording.labels() == ()


def test_metadata_keep_what_is_given_and_leave_out_the_rest() -> None:
    strings = METADATA.to_strings()
    assert strings.pop("checksum") == "51ed8cab"
    assert strings == {"format_version": "1", "session": "s", "server_version": "0"}
    full = RecordingMetadata("s", "1.2", bundles={"b": "2", "a": "1"}, created="2025-01-01")
    assert full.to_strings()["bundle.a"] == "1"
    assert RecordingMetadata.from_strings(full.to_strings(), Path("x"), 0) == full


def test_a_topic_is_read_alone(write: Callable[[str], Path]) -> None:
    recording = open_recording(write("a.mcap"))
    assert {record.topic for record in recording.records(["/ack"])} == {"/ack"}
    assert len(list(recording.records(["/ack"]))) == 2
    assert list(recording.records([])) == []


def test_a_chunk_closes_after_half_a_second_of_stamps(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    with RecordingWriter(path, METADATA) as writer:
        for index in range(60):
            writer.append_input(frame_at(index * 40 * NS_PER_MS))
    spans = [chunk.message_end_time - chunk.message_start_time for chunk in chunks(path)]
    assert len(spans) == 5
    assert all(span < CHUNK_NS + 40 * NS_PER_MS for span in spans)
    assert all(chunk.compression == "zstd" and chunk.uncompressed_crc for chunk in chunks(path))


def test_a_chunk_closes_when_it_is_full(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    with RecordingWriter(path, METADATA) as writer:
        for _ in range(3000):
            writer.append_input(frame_at(0))
    sizes = [chunk.uncompressed_size for chunk in chunks(path)]
    assert len(sizes) > 2
    assert all(CHUNK_BYTES <= size < CHUNK_BYTES + 2048 for size in sizes[:-1])


def test_a_file_that_is_written_at_once_has_large_chunks(tmp_path: Path) -> None:
    live, at_once = tmp_path / "live.mcap", tmp_path / "at_once.mcap"
    stamps = [index * 40 * NS_PER_MS for index in range(5000)]
    for path, limits in ((live, LIVE), (at_once, AT_ONCE)):
        with RecordingWriter(path, METADATA, limits) as writer:
            for stamp in stamps:
                writer.append_input(frame_at(stamp))
    sizes = [chunk.uncompressed_size for chunk in chunks(at_once)]
    assert len(sizes) > 1
    assert all(AT_ONCE.size <= size < AT_ONCE.size + 2048 for size in sizes[:-1])
    assert at_once.stat().st_size < 0.9 * live.stat().st_size
    assert [event.originating_ns for event in open_recording(at_once).events()] == stamps


def test_the_file_says_nothing_that_changes_between_machines(write: Callable[[str], Path]) -> None:
    with write("a.mcap").open("rb") as file:
        header = next(iter(StreamReader(file).records))
    assert header == Header(profile="", library="agent-server")


def test_an_existing_recording_is_not_overwritten(write: Callable[[str], Path]) -> None:
    path = write("a.mcap")
    before = path.read_bytes()
    with pytest.raises(RecordingError, match=r"a\.mcap exists already"):
        RecordingWriter(path, METADATA)
    assert path.read_bytes() == before


def test_a_stamp_outside_the_session_is_refused(tmp_path: Path) -> None:
    with RecordingWriter(tmp_path / "a.mcap", METADATA) as writer:
        with pytest.raises(RecordingError, match="stamp_ns is -1"):
            writer.append_input(frame_at(-1))
        writer.append_input(frame_at(0))
    assert open_recording(tmp_path / "a.mcap").summary.records == 1


def test_a_closed_recording_takes_nothing(tmp_path: Path) -> None:
    writer = RecordingWriter(tmp_path / "a.mcap", METADATA)
    writer.close()
    writer.close()
    with pytest.raises(RecordingError, match="is closed"):
        writer.append_core(Tick(0))
    with pytest.raises(RecordingError, match="is closed"):
        writer.flush()
