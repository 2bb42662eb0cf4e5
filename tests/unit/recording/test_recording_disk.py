"""A disk that fails while a session is written."""

import resource
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import RecordingError
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.reader import open_recording
from agent_server.recording.recover import recover
from agent_server.recording.whole import whole_file
from agent_server.recording.writer import RecordingWriter

METADATA = RecordingMetadata(session="s", server_version="0")


@contextmanager
def full_disk(size: int) -> Iterator[None]:
    """No file can grow beyond ``size`` bytes: a write is cut short there, the next one fails."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_full_disk_is_loud_and_what_was_written_is_saved(
    tmp_path: Path, session_frames: list[SkeletonFrame]
) -> None:
    path = tmp_path / "a.mcap"
    writer = RecordingWriter(path, METADATA)
    for frame in session_frames[:20]:
        writer.append_input(frame)
    writer.flush()
    whole = path.stat().st_size
    with full_disk(whole + 200):
        writer.append_input(session_frames[20])
        with pytest.raises(RecordingError, match=r"a\.mcap cannot be written.*recover it"):
            writer.flush()
    assert path.stat().st_size == whole
    with pytest.raises(RecordingError, match="has failed before"):
        writer.append_input(session_frames[21])
    writer.close()
    with pytest.raises(RecordingError, match="truncated"):
        open_recording(path)
    recover(path, tmp_path / "out.mcap")
    saved = [frame.originating_ns for frame in open_recording(tmp_path / "out.mcap").events()]
    assert saved == [frame.originating_ns for frame in session_frames[:20]]


def test_a_disk_that_is_full_at_the_end_is_loud_too(
    tmp_path: Path, session_frames: list[SkeletonFrame]
) -> None:
    path = tmp_path / "a.mcap"
    writer = RecordingWriter(path, METADATA)
    writer.append_input(session_frames[0])
    writer.flush()
    with (
        full_disk(path.stat().st_size + 100),
        pytest.raises(RecordingError, match="cannot be written"),
    ):
        writer.close()
    assert recover(path, tmp_path / "out.mcap").records == 1


def test_a_failure_within_the_block_comes_through(
    tmp_path: Path, session_frames: list[SkeletonFrame]
) -> None:
    path = tmp_path / "a.mcap"
    with (
        full_disk(1000),
        pytest.raises(RecordingError, match="cannot be written"),
        RecordingWriter(path, METADATA) as writer,
    ):
        for frame in session_frames:
            writer.append_input(frame)


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"none/a\.mcap cannot be created"):
        RecordingWriter(tmp_path / "none" / "a.mcap", METADATA)


def test_an_error_in_the_block_still_finishes_the_file(
    tmp_path: Path, session_frames: list[SkeletonFrame]
) -> None:
    path = tmp_path / "a.mcap"
    with (
        pytest.raises(KeyError),
        RecordingWriter(path, METADATA) as writer,
    ):
        writer.append_input(session_frames[0])
        raise KeyError
    assert open_recording(path).summary.records == 1


def test_a_whole_file_appears_only_when_it_is_whole(tmp_path: Path) -> None:
    path = tmp_path / "a"
    with pytest.raises(KeyError), whole_file(path) as part:
        part.write_text("half")
        raise KeyError
    assert list(tmp_path.iterdir()) == []
    with whole_file(path) as part:
        part.write_text("whole")
        assert not path.exists()
    assert path.read_text() == "whole"
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(RecordingError, match="exists already"), whole_file(path):
        pass
    with (
        pytest.raises(RecordingError, match="cannot be written"),
        whole_file(tmp_path / "none" / "a") as part,
    ):
        part.write_text("x")
