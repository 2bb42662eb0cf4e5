"""The journal of a recorded gesture: what is in the file, and when there is none."""

from contextlib import ExitStack

import pytest

from agent_server.clock import ManualClock
from agent_server.domain.affect import AffectSample
from agent_server.errors import RecordingError
from agent_server.recording.reader import open_recording
from agent_server.recording.records import SensorChanged, Tick
from agent_server.recording.recover import recover
from agent_server.recording.takes import Again, Done, Go, Spoilt, Taken, TakePlan
from agent_server.recording.writer import RecordingWriter
from agent_server.service import take_recorder as module
from agent_server.service.journal import NoJournal
from agent_server.service.take_recorder import OtherSession, SensorMoved, TakeRecorder
from tests.support.takes import NS, Person


class Sensor(Person):
    """A person whose frames go through a journal, as a session's do."""

    def __init__(self, folder, repetitions=2):
        plan = TakePlan("wave", "anna", repetitions, 3 * NS, NS)
        self.told = []
        self.recorder = TakeRecorder(folder, plan, "lab", ManualClock(5 * NS), self.told.append)
        super().__init__(self)

    def push(self, frame):
        """Stand in for the director: the journal is given the frame."""
        before = len(self.told)
        self.recorder.append_input(frame, 0)
        return self.told[before:]


@pytest.fixture
def sensor():
    """Makes sensors, and closes their recorders in the end."""
    with ExitStack() as stack:

        def make(folder, **options):
            made = Sensor(folder, **options)
            stack.callback(made.recorder.close)
            return made

        yield make


def open_after_crash(path, saved):
    """What a recording holds whose writer is killed now."""
    killed = path.with_suffix(".killed")
    killed.write_bytes(path.read_bytes())
    recover(killed, saved)
    return open_recording(saved)


def test_the_file_holds_every_frame_as_it_came_and_a_label_a_repetition(sensor, tmp_path):
    anna = sensor(tmp_path / "gestures")
    anna.recorder.append_core(SensorChanged(0, open=True, face="none"))
    sent = []
    while not anna.recorder.ended.is_set():
        sent.append(anna.frame())
        anna.stay(1 / 30)
    anna.stay(1)  # what comes later is nobody's
    assert anna.recorder.path == tmp_path / "gestures" / "wave-anna-1970-01-01T000005.mcap"
    recording = open_recording(anna.recorder.path)
    assert set(recording.summary.topics) == {"/skeleton", "/label"}
    frames = list(recording.events())
    assert [f.originating_ns for f in frames] == [f.originating_ns for f in sent]
    assert frames[100].joints.tolist() == sent[100].joints.round(4).tolist()
    assert anna.recorder.frames == len(sent)
    assert list(recording.labels()) == [cue.label for cue in anna.said(Taken)]
    assert len(recording.labels()) == 2
    metadata = recording.metadata
    assert (metadata.session, metadata.face, metadata.joint_format) == ("lab", "none", "core9")
    assert "anna shows wave" in metadata.description
    assert anna.told[0] == SensorMoved(is_here=True)
    assert anna.told[-1] == Done()


def test_the_face_is_recorded_while_there_is_a_body(sensor, tmp_path):
    anna = sensor(tmp_path, repetitions=1)
    anna.recorder.append_input(AffectSample(0, 1.0, 1.0), 0)
    anna.stay(1)
    anna.recorder.append_input(AffectSample(NS, -6.0, 5.0), 0)
    anna.until(Done)
    recording = open_recording(anna.recorder.path)
    assert [e for e in recording.events() if isinstance(e, AffectSample)] == [
        AffectSample(NS, -6.0, 5.0)
    ]
    assert recording.metadata.face == "expected"


def test_the_clock_of_the_session_tells_that_the_frames_have_stopped(sensor, tmp_path):
    anna = sensor(tmp_path)
    anna.until(Go)
    anna.recorder.append_core(SensorChanged(anna.now_ns, open=False))
    anna.recorder.append_core(Tick(anna.now_ns + NS))
    assert SensorMoved(is_here=False) in anna.told
    assert Again(1, Spoilt.LOST) in anna.told


def test_what_was_finished_is_kept_when_it_ends_early(sensor, tmp_path):
    anna = sensor(tmp_path)
    anna.until(Taken)
    anna.until(Go)
    anna.stay(1)
    anna.recorder.close()
    anna.recorder.close()
    assert len(open_recording(anna.recorder.path).labels()) == 1
    assert anna.recorder.ended.is_set()


def test_what_was_finished_is_on_the_disk_before_the_end(sensor, tmp_path):
    anna = sensor(tmp_path)
    anna.until(Taken)
    whole = open_after_crash(anna.recorder.path, tmp_path / "saved.mcap")
    assert list(whole.labels()) == anna.recorder.labels


def test_without_a_finished_repetition_no_file_is_left(sensor, tmp_path):
    anna = sensor(tmp_path)
    anna.stay(3)
    assert anna.recorder.path.exists()
    anna.recorder.close()
    assert list(tmp_path.iterdir()) == []


def test_a_disk_that_fails_ends_the_recording_and_not_the_session(sensor, tmp_path, monkeypatch):
    class FullDisk(RecordingWriter):
        def append_label(self, label, tag=""):
            raise RecordingError("the disk is full")

    monkeypatch.setattr(module, "RecordingWriter", FullDisk)
    anna = sensor(tmp_path)
    anna.stay(10)
    assert "full" in str(anna.recorder.failure)
    assert anna.recorder.ended.is_set()
    assert anna.said(Taken) == []


def test_only_the_session_that_is_waited_for_is_recorded(sensor, tmp_path):
    anna = sensor(tmp_path)
    assert anna.recorder.open("lab") is anna.recorder
    other = anna.recorder.open("hall")
    assert isinstance(other, NoJournal)
    assert not isinstance(other, TakeRecorder)
    assert anna.told == [OtherSession("hall")]


def test_a_file_that_exists_and_a_folder_that_cannot_be_are_refused(sensor, tmp_path):
    (tmp_path / "wave-anna-1970-01-01T000005.mcap").touch()
    with pytest.raises(RecordingError, match="exists already"):
        sensor(tmp_path)
    with pytest.raises(RecordingError, match="cannot be made"):
        sensor(tmp_path / "wave-anna-1970-01-01T000005.mcap" / "below")
