"""Truncated, corrupt and foreign files: what is whole is saved, the rest is named."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from mcap.records import ChunkIndex
from mcap.stream_reader import StreamReader
from mcap.writer import IndexType, Writer

from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import RecordingError
from agent_server.protocol.messages import Affect
from agent_server.recording.metadata import METADATA_NAME, RecordingMetadata
from agent_server.recording.reader import Record, open_recording
from agent_server.recording.recover import recover
from agent_server.recording.scan import DamagedError
from agent_server.recording.sink import McapSink
from agent_server.recording.writer import RecordingWriter

METADATA = RecordingMetadata(session="s", server_version="0")


STEP = 59
"""Every 59th byte is tried; it is prime, so that all fields of the records have their turn."""


def chunk_ends(path: Path) -> list[int]:
    """The byte after each chunk, and before it the one at which the first chunk begins."""
    with path.open("rb") as file:
        found = [r for r in StreamReader(file).records if isinstance(r, ChunkIndex)]
    return [
        found[0].chunk_start_offset,
        *(index.chunk_start_offset + index.chunk_length for index in found),
    ]


def cut(path: Path, size: int) -> Path:
    """A copy of the first ``size`` bytes."""
    part = path.with_name(f"cut_{size}.mcap")
    part.write_bytes(path.read_bytes()[:size])
    return part


def flipped(path: Path, at: int) -> Path:
    """A copy in which one byte is wrong."""
    data = bytearray(path.read_bytes())
    data[at] ^= 0xFF
    copy = path.with_name(f"flipped_{at}.mcap")
    copy.write_bytes(data)
    return copy


def saved(damaged: Path) -> list[Record]:
    output = damaged.with_name(f"recovered_{damaged.name}")
    report = recover(damaged, output)
    records = list(open_recording(output))
    assert report.records == len(records)
    return records


def test_every_chunk_boundary_recovers_to_the_chunks_before_it(
    write: Callable[[str], Path],
) -> None:
    path = write("a.mcap")
    records = list(open_recording(path))
    ends = chunk_ends(path)
    assert len(ends) >= 5
    counts = []
    for end in ends:
        part = cut(path, end)
        with pytest.raises(RecordingError, match=r"truncated.*recover"):
            open_recording(part)
        back = saved(part)
        assert back == records[: len(back)]
        counts.append(len(back))
    assert counts[0] == 0
    assert counts == sorted(set(counts))
    assert counts[-1] == len(records)


def test_a_cut_anywhere_loses_only_what_was_in_the_last_chunk(write: Callable[[str], Path]) -> None:
    path = write("a.mcap")
    records = list(open_recording(path))
    ends = chunk_ends(path)
    whole = [len(saved(cut(path, end))) for end in ends]
    for size in range(ends[0], path.stat().st_size - 1, 211):
        if size in ends:
            continue
        part = cut(path, size)
        with pytest.raises(RecordingError):
            open_recording(part)
        back = saved(part)
        assert len(back) == max(n for n, end in zip(whole, ends, strict=True) if end <= size)
        assert back == records[: len(back)]


def test_the_report_says_what_was_lost(write: Callable[[str], Path], tmp_path: Path) -> None:
    path = write("a.mcap")
    ends = chunk_ends(path)
    report = recover(cut(path, ends[2] - 10), tmp_path / "out.mcap")
    assert report.chunks == 1
    assert not report.finished
    assert not report.complete
    assert report.lost_bytes > 0
    assert report.topics["/skeleton"] > 0
    assert report.end_ns > 0
    whole = recover(path, tmp_path / "whole.mcap")
    assert whole.complete
    assert whole.records == 102


def test_a_recovered_file_keeps_metadata_and_sequence(
    write: Callable[[str], Path], tmp_path: Path
) -> None:
    path = write("a.mcap")
    recover(cut(path, chunk_ends(path)[3]), tmp_path / "out.mcap")
    recording = open_recording(tmp_path / "out.mcap")
    assert recording.metadata == open_recording(path).metadata
    assert [r.sequence for r in recording] == list(range(recording.summary.records))


def test_a_corrupt_chunk_is_named_and_the_others_are_saved(
    write: Callable[[str], Path], tmp_path: Path
) -> None:
    path = write("a.mcap")
    records = list(open_recording(path))
    ends = chunk_ends(path)
    damaged = flipped(path, ends[2] - 20)
    recording = open_recording(damaged)
    with pytest.raises(DamagedError, match=r"flipped_\d+\.mcap is damaged at byte \d+"):
        list(recording)
    report = recover(damaged, tmp_path / "out.mcap")
    back = list(open_recording(tmp_path / "out.mcap"))
    assert report.damaged_records == 1
    assert report.missing_records == len(records) - len(back) > 0
    assert report.finished
    assert not report.complete
    kept = {record.sequence for record in back}
    assert back == [record for record in records if record.sequence in kept]


def test_a_corrupt_first_chunk_does_not_take_the_names_of_the_topics_along(
    write: Callable[[str], Path], tmp_path: Path
) -> None:
    path = write("a.mcap")
    damaged = flipped(path, chunk_ends(path)[1] - 20)
    report = recover(damaged, tmp_path / "out.mcap")
    assert report.topics["/skeleton"] > 20


def test_a_flipped_byte_is_reported_or_harmless(write: Callable[[str], Path]) -> None:
    """No byte of the file makes a library's error come through, or a wrong record."""
    path = write("a.mcap")
    records = list(open_recording(path))
    reported = 0
    for at in range(0, path.stat().st_size, STEP):
        damaged = flipped(path, at)
        try:
            assert list(open_recording(damaged)) == records
        except RecordingError as error:
            reported += 1
            assert damaged.name in str(error)
        output = damaged.with_name(f"out_{at}.mcap")
        try:
            recover(damaged, output)
        except RecordingError as error:
            assert damaged.name in str(error) or output.name in str(error)
            assert not output.exists()
        else:
            back = list(open_recording(output))
            kept = {record.sequence for record in back}
            assert back == [record for record in records if record.sequence in kept]
        assert not output.with_name(output.name + ".part").exists()
    assert reported > 4000 // STEP


@pytest.mark.parametrize("lost", [METADATA_NAME, "format_version", "session"])
def test_lost_metadata_do_not_take_the_records_along(
    write: Callable[[str], Path], tmp_path: Path, lost: str
) -> None:
    path = write("a.mcap")
    at = path.read_bytes().index(lost.encode())
    damaged = flipped(path, at)
    with pytest.raises(RecordingError, match=r"metadata|format version none"):
        open_recording(damaged)
    report = recover(damaged, tmp_path / "out.mcap")
    recording = open_recording(tmp_path / "out.mcap")
    assert report.records == recording.summary.records == 102
    assert recording.metadata.session == damaged.stem
    assert recording.metadata.server_version == "unknown"


def test_nothing_to_save_leaves_no_file(write: Callable[[str], Path], tmp_path: Path) -> None:
    part = cut(write("a.mcap"), 20)
    with pytest.raises(RecordingError, match="nothing can be saved"):
        recover(part, tmp_path / "out.mcap")
    assert not (tmp_path / "out.mcap").exists()


def test_recover_does_not_overwrite(write: Callable[[str], Path]) -> None:
    path = write("a.mcap")
    with pytest.raises(RecordingError, match="exists already"):
        recover(path, path)
    assert open_recording(path).summary.records == 102


@pytest.mark.parametrize("content", [b"", b"x", b"not a recording at all, but long enough" * 3])
def test_a_foreign_file_is_no_recording(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "foreign.mcap"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=r"foreign\.mcap is no MCAP file"):
        open_recording(path)
    with pytest.raises(RecordingError, match=r"foreign\.mcap is no MCAP file"):
        recover(path, tmp_path / "out.mcap")


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"none\.mcap cannot be read: No such file"):
        open_recording(tmp_path / "none.mcap")
    with pytest.raises(RecordingError, match="cannot be read"):
        open_recording(tmp_path)


@contextmanager
def sink(path: Path, metadata: dict[str, str] | None) -> Iterator[McapSink]:
    """A file written below the level of records, to make what the writer never makes."""
    opened = McapSink(path)
    if metadata is not None:
        opened.metadata(METADATA_NAME, metadata)
    yield opened
    opened.close()


@pytest.mark.parametrize(
    ("options", "what"),
    [
        ({"index_types": IndexType.METADATA}, "has no index of its chunks"),
        ({"use_statistics": False}, "has no index of its chunks"),
        (
            {
                "index_types": IndexType.NONE,
                "use_statistics": False,
                "repeat_channels": False,
                "repeat_schemas": False,
                "use_summary_offsets": False,
            },
            "there is no summary",
        ),
    ],
    ids=["no index", "no statistics", "no summary"],
)
def test_a_file_without_an_index_gets_one_by_recovering(
    tmp_path: Path, options: dict[str, Any], what: str
) -> None:
    """As some other tools write it."""
    path = tmp_path / "bare.mcap"
    affect = b'{"type":"affect","originating_ns":4,"valence":1.0,"arousal":0.0}'
    with path.open("wb") as file:
        writer = Writer(file, **options)
        writer.start()
        writer.add_metadata(METADATA_NAME, METADATA.to_strings())
        schema = writer.register_schema("A", "jsonschema", b"{}")
        channel = writer.register_channel("/affect", "json", schema)
        writer.add_message(channel, 4, affect, 4)
        writer.finish()
    with pytest.raises(RecordingError, match=rf"bare\.mcap.*{what}.*recover"):
        open_recording(path)
    (record,) = saved(path)
    assert record.message == Affect(4, 1.0, 0.0)


def test_an_mcap_file_of_somebody_else_is_refused(tmp_path: Path) -> None:
    with sink(tmp_path / "a.mcap", None):
        pass
    with pytest.raises(RecordingError, match="no recording of this server"):
        open_recording(tmp_path / "a.mcap")


@pytest.mark.parametrize("version", ["2", "0", "one"])
def test_another_format_version_is_refused(tmp_path: Path, version: str) -> None:
    with sink(tmp_path / "a.mcap", {**METADATA.to_strings(), "format_version": version}):
        pass
    with pytest.raises(RecordingError, match=f"format version {version}.*1 to 1"):
        open_recording(tmp_path / "a.mcap")
    if version == "2":
        with pytest.raises(RecordingError, match="use a newer server"):
            recover(tmp_path / "a.mcap", tmp_path / "out.mcap")


def test_metadata_without_a_session_are_refused(tmp_path: Path) -> None:
    with sink(tmp_path / "a.mcap", {"format_version": "1"}):
        pass
    with pytest.raises(RecordingError, match="lack session and server_version"):
        open_recording(tmp_path / "a.mcap")


def test_a_topic_of_a_later_server_is_passed_over(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    with sink(path, METADATA.to_strings()) as out:
        face = out.channel("/later", "json", ("Later", "jsonschema", b"{}"))
        out.message(face, 0, 0, b"{}")
    recording = open_recording(path)
    assert recording.summary.topics == {"/later": 1}
    assert list(recording) == []
    assert recover(path, tmp_path / "out.mcap").topics == {"/later": 1}


@pytest.mark.parametrize(
    "data", [b"{", b'{"type":"affect","originating_ns":0,"valence":11,"arousal":0}', b"\xff"]
)
def test_a_record_that_does_not_fit_its_topic_is_named(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "a.mcap"
    with sink(path, METADATA.to_strings()) as out:
        out.message(out.channel("/affect", "json", ("A", "jsonschema", b"{}")), 0, 7, data)
    with pytest.raises(RecordingError, match=r"a\.mcap, record 7 on /affect, in the chunk at"):
        list(open_recording(path))


def test_a_skeleton_that_makes_no_sense_is_named(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    data = b'{"type":"skeleton","originating_ns":0,"body_id":0,"format":"core9","joints":[]}'
    with sink(path, METADATA.to_strings()) as out:
        out.message(out.channel("/skeleton", "json", ("S", "jsonschema", b"{}")), 0, 3, data)
    assert len(list(open_recording(path))) == 1
    with pytest.raises(RecordingError, match=r"a\.mcap, record 3 on /skeleton: .*9 joints, got 0"):
        list(open_recording(path).events())


def test_what_was_flushed_survives_a_crash(
    tmp_path: Path, session_frames: list[SkeletonFrame]
) -> None:
    path = tmp_path / "a.mcap"
    writer = RecordingWriter(path, METADATA)
    for frame in session_frames[:3]:
        writer.append_input(frame)
    before = path.stat().st_size
    writer.flush()
    assert path.stat().st_size > before
    writer.append_input(session_frames[3])
    crashed = cut(path, path.stat().st_size)
    assert len(saved(crashed)) == 3
    writer.close()
    assert open_recording(path).summary.records == 4
