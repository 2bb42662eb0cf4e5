"""The recorder: a thread that writes, and a disk that fails or is slow."""

import threading

from agent_server.clock import ManualClock
from agent_server.domain.affect import AffectSample
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.reader import open_recording
from agent_server.recording.records import Tick
from agent_server.recording.writer import RecordingWriter
from agent_server.service import recorder as module
from agent_server.service.recorder import Recorder, recorder
from tests.support.bodies import stream
from tests.support.models import fake_models

METADATA = RecordingMetadata("s", "test")


def test_what_was_appended_is_in_the_file_in_its_order(tmp_path):
    clock = ManualClock(5_000_000_000)
    made = recorder(tmp_path, "lab", fake_models(), clock)
    frames = stream(3)
    for frame in frames:
        made.append_input(frame)
        made.append_input(AffectSample(frame.originating_ns, -1.0, 2.0))
    made.append_core(Tick(4_000_000_000))
    made.close()
    recording = open_recording(tmp_path / "lab-1970-01-01T000005000.mcap")
    assert recording.metadata.session == "lab"
    assert set(recording.metadata.bundles) == set(fake_models().hashes)
    kinds = [record.topic for record in recording]
    assert kinds == ["/skeleton", "/affect"] * len(frames) + ["/core"]


def test_a_folder_that_is_not_there_is_reported_and_harmless(tmp_path, caplog):
    made = Recorder(tmp_path / "missing" / "a.mcap", METADATA)
    made._thread.join(5)
    made.append_input(stream(1)[0])
    made.close()
    assert caplog.text.count("recording stopped") == 1


def test_a_disk_that_is_too_slow_is_given_up_and_what_was_written_stays(
    tmp_path, caplog, monkeypatch
):
    monkeypatch.setattr(module, "MAX_WAITING", 5)
    may_write = threading.Event()

    class SlowWriter(RecordingWriter):
        def append_input(self, frame):
            may_write.wait(5)
            super().append_input(frame)

    monkeypatch.setattr(module, "RecordingWriter", SlowWriter)
    made = Recorder(tmp_path / "slow.mcap", METADATA)
    for frame in stream(1):
        made.append_input(frame)
    assert "too slow" in caplog.text
    may_write.set()
    made.close()
    assert 1 <= open_recording(tmp_path / "slow.mcap").summary.records <= 7
