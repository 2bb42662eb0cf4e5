"""The recorder: a thread that writes; a disk that fails or is slow; parts, and what is kept."""

import errno
import hashlib
import os
import threading
import time

import pytest

from agent_server.clock import ManualClock, SystemClock
from agent_server.config import DecideSettings, RecordingSettings, Settings
from agent_server.domain.affect import AffectSample
from agent_server.domain.stamp import NS_PER_S
from agent_server.recording import sink
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.parts import later_parts
from agent_server.recording.reader import open_recording
from agent_server.recording.records import SensorChanged, Tick
from agent_server.recording.recover import recover
from agent_server.recording.writer import RecordingWriter
from agent_server.service import recorder as module
from agent_server.service.recorder import Recorder, recorder, settings_hash
from tests.support.bodies import stream
from tests.support.models import fake_models
from tests.support.patience import PATIENCE_S

METADATA = RecordingMetadata("s", "test")


def settings(**recording):
    return Settings(recording=RecordingSettings(**recording))


def wait_until(holds):
    end_s = time.monotonic() + PATIENCE_S
    while not holds():
        assert time.monotonic() < end_s
        time.sleep(0.01)


def test_what_was_appended_is_in_the_file_in_its_order(tmp_path):
    clock = ManualClock(5_000_000_000)
    chosen = settings(participant="P07", consent=True)
    made = recorder(tmp_path, "lab", fake_models(), clock, chosen, b"rules")
    frames = stream(3)
    for frame in frames:
        made.append_input(frame, clock.now_ns() + 1)
        made.append_input(AffectSample(frame.originating_ns, -1.0, 2.0), clock.now_ns() + 2)
    made.append_core(Tick(4_000_000_000))
    made.close()
    recording = open_recording(tmp_path / "lab-1970-01-01T000005000.mcap")
    metadata = recording.metadata
    assert metadata.session == "lab"
    assert set(metadata.bundles) == set(fake_models().hashes)
    assert (metadata.participant, metadata.consent, metadata.part) == ("P07", True, 1)
    assert metadata.config == settings_hash(chosen)
    assert metadata.rules == hashlib.sha256(b"rules").hexdigest()
    kinds = [record.topic for record in recording if record.topic != "/times"]
    assert kinds == ["/skeleton", "/affect"] * len(frames) + ["/core"]
    assert made.lost == 0


def test_what_decisions_depend_on_is_told_apart_by_its_hash():
    assert settings_hash(settings(participant="P07")) == settings_hash(Settings())
    other = Settings(decide=DecideSettings(enter_windows=2))
    assert settings_hash(other) != settings_hash(Settings())


def test_when_inputs_came_and_were_dealt_with_is_recorded(tmp_path):
    clock = ManualClock(7 * NS_PER_S)
    made = Recorder(tmp_path / "a.mcap", METADATA, clock)
    arrivals = []
    for frame in stream(5):
        clock.advance(30_000_000)
        arrivals.append(clock.now_ns())
        clock.advance(2_000_000)
        made.append_input(frame, arrivals[-1])
    made.close()
    recording = open_recording(tmp_path / "a.mcap")
    skeletons = [record.sequence for record in recording.records(["/skeleton"])]
    assert list(recording.times()) == [
        (sequence, at - 7 * NS_PER_S, at - 7 * NS_PER_S + 2_000_000)
        for sequence, at in zip(skeletons, arrivals, strict=True)
    ]


def test_a_folder_that_is_not_there_is_reported_and_harmless(tmp_path, caplog):
    made = Recorder(tmp_path / "missing" / "a.mcap", METADATA, SystemClock())
    made._thread.join(5)
    made.append_input(stream(1)[0], 0)
    made.close()
    assert caplog.text.count("recording stopped") == 1
    assert "cannot be created" in made.take_failure()
    assert made.take_failure() is None
    assert made.lost == 1


def test_a_disk_that_is_too_slow_is_given_up_and_what_was_written_stays(
    tmp_path, caplog, monkeypatch
):
    monkeypatch.setattr(module, "MAX_WAITING_BYTES", 5 * module.RECORD_BYTES)
    may_write = threading.Event()
    write = sink._WholeWrites.write

    def hang(self, data):
        may_write.wait(5)
        return write(self, data)

    monkeypatch.setattr(sink._WholeWrites, "write", hang)
    made = Recorder(tmp_path / "slow.mcap", METADATA, SystemClock())
    began_s = time.monotonic()
    for frame in stream(1):
        made.append_input(frame, 0)
    assert time.monotonic() - began_s < 2.0
    assert "too slow" in caplog.text
    assert made.lost == len(stream(1)) - 5
    assert "too slow" in made.take_failure()
    may_write.set()
    made.close()
    assert open_recording(tmp_path / "slow.mcap").summary.topics["/skeleton"] == 5


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EIO, errno.EDQUOT])
def test_a_disk_that_fails_in_the_middle_leaves_what_was_written(
    tmp_path, caplog, monkeypatch, code
):
    fails = threading.Event()
    write = sink._WholeWrites.write

    def fail(self, data):
        if not fails.is_set():
            return write(self, data)
        self._raw.write(bytes(data)[: len(data) // 2])
        raise OSError(code, "the disk")

    monkeypatch.setattr(sink._WholeWrites, "write", fail)
    path = tmp_path / "a.mcap"
    made = Recorder(path, METADATA, SystemClock())
    frames = stream(6)
    for frame in frames[:90]:
        made.append_input(frame, 0)
    wait_until(lambda: path.exists() and path.read_bytes().count(b"\x04\0\0\0zstd") == 6)
    wait_until(lambda: made._taken == made._given)
    time.sleep(2 * module.FLUSH_NS / NS_PER_S)  # what waits is written when nothing comes
    size = path.stat().st_size
    fails.set()
    for frame in frames[90:]:
        made.append_input(frame, 0)
    made._thread.join(5)
    made.append_input(frames[-1], 0)
    made.close()
    assert caplog.text.count("recording stopped") == 1
    assert made.lost >= 1
    assert path.stat().st_size == size
    fails.clear()
    report = recover(path, tmp_path / "out.mcap")
    assert report.topics["/skeleton"] == 90
    assert report.damaged_records == report.lost_bytes == 0


def test_a_fault_of_the_recorder_itself_stops_recording_alone(tmp_path, caplog, monkeypatch):
    def broken(self, value, times):
        raise TypeError("a mistake")

    monkeypatch.setattr(RecordingWriter, "append_input", broken)
    made = Recorder(tmp_path / "a.mcap", METADATA, SystemClock())
    made.append_input(stream(1)[0], 0)
    made._thread.join(5)
    made.close()
    assert "should not" in caplog.text
    assert "the recorder failed" in made.take_failure()


def test_a_recording_goes_on_in_a_new_file_when_one_is_full_or_old(tmp_path):
    clock = ManualClock(0)
    made = Recorder(tmp_path / "a.mcap", METADATA, clock, RecordingSettings(rotate_minutes=0.05))
    made.append_core(SensorChanged(0, open=True, face="none"))
    frames = stream(9)
    for frame in frames:
        clock.advance(33_333_333)
        made.append_input(frame, clock.now_ns())
        wait_until(lambda: made._taken == made._given)
    made.close()
    paths = [tmp_path / "a.mcap", *later_parts(tmp_path / "a.mcap")]
    assert [path.name for path in paths] == ["a.mcap", "a.2.mcap", "a.3.mcap"]
    recordings = [open_recording(path) for path in paths]
    assert [one.metadata.part for one in recordings] == [1, 2, 3]
    assert [one.metadata.face for one in recordings] == [None, "none", "none"]
    stamps = [event.originating_ns for one in recordings for event in one.events()]
    assert stamps == [frame.originating_ns for frame in frames]
    small = Recorder(tmp_path / "b.mcap", METADATA, SystemClock(), RecordingSettings(rotate_mb=0.1))
    for _ in range(20):
        for frame in frames:
            small.append_input(frame, 0)
    small.close()
    sizes = [
        path.stat().st_size for path in [tmp_path / "b.mcap", *later_parts(tmp_path / "b.mcap")]
    ]
    assert len(sizes) >= 3
    assert all(100_000 <= size < 200_000 for size in sizes[:-1])


def test_the_oldest_are_deleted_and_never_the_one_that_is_written(tmp_path):
    old = [tmp_path / f"x-2020-01-0{day}T000000000.mcap" for day in (1, 2, 3)]
    for age_s, path in zip((300, 200, 100), old, strict=True):
        path.write_bytes(bytes(90_000))
        stamp = time.time() - age_s
        os.utime(path, (stamp, stamp))
    (tmp_path / "mine.mcap").write_bytes(bytes(500_000))
    chosen = settings(rotate_mb=0.1, keep_mb=0.2)
    made = recorder(tmp_path, "lab", fake_models(), SystemClock(), chosen, b"")
    made.append_input(stream(1)[0], 0)
    wait_until(lambda: not old[0].exists())
    made.close()
    assert [path.exists() for path in old] == [False, True, True]
    assert (tmp_path / "mine.mcap").exists()
    assert len(list(tmp_path.glob("lab-*.mcap"))) == 1
