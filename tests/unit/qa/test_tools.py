"""Recordings cut, joined, labelled and made anonymous: what stays, and what replays make of it."""

from pathlib import Path

import pytest

from agent_server.config import Settings
from agent_server.domain.command import Ack
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import NS_PER_S, to_ns
from agent_server.errors import InvalidInput, RecordingError
from agent_server.qa.setup import load_setup
from agent_server.qa.tools.annotate import annotate
from agent_server.qa.tools.anonymise import anonymise
from agent_server.qa.tools.cut import cut, decision_time
from agent_server.qa.tools.info import describe
from agent_server.qa.tools.merge import merge
from agent_server.recording.items import read_entries
from agent_server.recording.reader import open_recording
from agent_server.service.replay import replay
from tests.support.live_recordings import write_live

ROOT = Path(__file__).parents[3]
STREAMS = ROOT / "recorded_streams"
EVERY_KIND = ROOT / "tests" / "golden" / "recording_v1.mcap"


@pytest.fixture(scope="module")
def setup():
    return load_setup(Settings())


@pytest.fixture(scope="module")
def live(tmp_path_factory):
    path = tmp_path_factory.mktemp("live") / "live.mcap"
    write_live(STREAMS / "smell.mcap", path, skip={20, 21})
    return path


def decisions(path, setup):
    """What a replay decides, without the session's name."""
    recording = open_recording(path)
    found = replay(recording, setup.core(recording.metadata.session), setup.models)
    return [
        (d.window, d.end_ns, d.outcome, d.reason, tuple(d.probabilities.values())) for d in found
    ]


def contents(path, *, but=()):
    return [
        (r.topic, r.stamp_ns, r.message)
        for r in open_recording(path).records()
        if r.topic not in but
    ]


def labels_csv(tmp_path, *rows):
    path = tmp_path / "labels.csv"
    path.write_text("gesture,onset_s,offset_s,expected,quiet\n" + "\n".join(rows) + "\n", "utf-8")
    return path


class TestCut:
    def test_from_the_start_it_keeps_the_log_and_all_decisions(self, live, setup, tmp_path):
        report = cut(live, tmp_path / "o.mcap", 0, to_ns(8))
        whole = [d for d in decisions(live, setup) if d[1] <= to_ns(8)]
        assert report.exact
        assert decisions(tmp_path / "o.mcap", setup) == whole
        assert len(whole) > 25
        assert list(open_recording(tmp_path / "o.mcap").times())

    def test_from_the_middle_it_keeps_input_and_labels_and_begins_at_zero(self, live, tmp_path):
        report = cut(live, tmp_path / "o.mcap", to_ns(3), to_ns(12))
        recording = open_recording(tmp_path / "o.mcap")
        assert not report.exact
        assert set(recording.summary.topics) == {"/skeleton", "/face", "/label", "/scene_event"}
        assert recording.metadata.face == "expected"
        zero_ns = to_ns(report.start_s)
        assert 0 <= to_ns(3) - zero_ns <= to_ns(0.4)
        assert recording.summary.start_ns == 0
        frames = [e for e in open_recording(live).events() if isinstance(e, SkeletonFrame)]
        kept = [e.originating_ns for e in recording.events() if isinstance(e, SkeletonFrame)]
        assert kept[:2] == [0, to_ns(0.2)]
        within = [f for f in frames if zero_ns + to_ns(0.2) < f.originating_ns <= to_ns(12)]
        assert [at + zero_ns for at in kept[2:]] == [f.originating_ns for f in within]
        assert recording.labels()[0].onset_ns == 0

    @pytest.mark.parametrize("name", ["demo", "dropouts_and_passer_by", "hot"])
    def test_a_second_after_a_cut_windows_are_the_same_to_the_bit(self, name, setup, tmp_path):
        source = STREAMS / f"{name}.mcap"
        report = cut(source, tmp_path / "o.mcap", to_ns(14.1), to_ns(36))
        zero_ns = round(report.start_s * NS_PER_S)
        whole = {end_ns: seen for _, end_ns, _, _, seen in decisions(source, setup)}
        part = decisions(tmp_path / "o.mcap", setup)
        settled = [d for d in part if d[1] > to_ns(2.3)]
        assert len(settled) > 60
        for _, end_ns, _, _, probabilities in settled:
            assert probabilities == whole[end_ns + zero_ns]

    def test_quiet_is_clipped_and_a_gesture_that_is_cut_through_is_left_out(self, tmp_path):
        report = cut(STREAMS / "hello.mcap", tmp_path / "o.mcap", to_ns(2), to_ns(5))
        (label,) = open_recording(tmp_path / "o.mcap").labels()
        assert (label.gesture, label.onset_ns, label.offset_ns) == (
            "idle", 0, to_ns(4) - round(report.start_s * NS_PER_S),
        )  # fmt: skip
        assert (report.labels, report.split_labels) == (1, 1)

    def test_the_room_begins_as_it_stood(self, live, tmp_path):
        cut(live, tmp_path / "o.mcap", to_ns(3), to_ns(5))
        changes = [r for r in contents(tmp_path / "o.mcap") if r[0] == "/scene_event"]
        assert [(at, message.object, message.state) for _, at, message in changes] == [
            (0, "window", "open"),
            (0, "hifi", "high"),
        ]

    def test_a_cut_session_reacts_as_the_whole_one(self, setup, tmp_path):
        cut(STREAMS / "demo.mcap", tmp_path / "o.mcap", to_ns(20), to_ns(32))
        found = [d for d in decisions(tmp_path / "o.mcap", setup) if d[2] == "command"]
        (label,) = [x for x in open_recording(tmp_path / "o.mcap").labels() if x.expected]
        assert [reason.split(":")[0] for _, _, _, reason, _ in found] == ["loud"]
        assert label.onset_ns <= found[0][1] <= label.offset_ns

    @pytest.mark.parametrize(("start", "end"), [(5, 5), (30, 40), (6, 2)])
    def test_an_empty_part_is_refused(self, tmp_path, start, end):
        with pytest.raises(InvalidInput, match="is empty"):
            cut(STREAMS / "hello.mcap", tmp_path / "o.mcap", to_ns(start), to_ns(end))
        assert not list(tmp_path.iterdir())

    def test_a_file_that_is_there_is_not_written_over(self, tmp_path):
        (tmp_path / "o.mcap").write_text("mine")
        with pytest.raises(RecordingError, match="exists already"):
            cut(STREAMS / "hello.mcap", tmp_path / "o.mcap", 0, to_ns(5))

    def test_a_recorded_decision_is_found_by_id_or_index(self):
        (record,) = open_recording(EVERY_KIND).records(("/decision",))
        body = record.message.decision
        assert decision_time(EVERY_KIND, body.id) == body.end_ns
        assert decision_time(EVERY_KIND, str(body.index)) == body.end_ns
        with pytest.raises(InvalidInput, match="holds 1 decisions, and none is '99'"):
            decision_time(EVERY_KIND, "99")


class TestMerge:
    def test_one_comes_after_the_other_with_its_labels(self, tmp_path):
        sources = [STREAMS / "hello.mcap", STREAMS / "bright.mcap"]
        report = merge(sources, tmp_path / "o.mcap", to_ns(3))
        first, second = (open_recording(path) for path in sources)
        joined = open_recording(tmp_path / "o.mcap")
        shift = first.summary.end_ns + to_ns(3)
        assert report.starts_s == (0, shift / NS_PER_S)
        assert [label.onset_ns for label in joined.labels()] == [
            *(label.onset_ns for label in first.labels()),
            *(label.onset_ns + shift for label in second.labels()),
        ]
        assert joined.summary.records == first.summary.records + second.summary.records

    def test_both_parts_are_reacted_to(self, setup, tmp_path):
        merge([STREAMS / "hello.mcap", STREAMS / "bright.mcap"], tmp_path / "o.mcap", to_ns(3))
        commands = [d[3].split(":")[0] for d in decisions(tmp_path / "o.mcap", setup)
                    if d[2] == "command"]  # fmt: skip
        assert commands == ["hello", "hello", "bright"]

    def test_sensors_that_see_different_things_do_not_go_together(self, tmp_path):
        with pytest.raises(InvalidInput, match="says of the face 'expected'"):
            merge([STREAMS / "hello.mcap", STREAMS / "headset.mcap"], tmp_path / "o.mcap", 0)

    def test_a_live_recording_gives_its_input_alone(self, live, tmp_path):
        merge([live, live], tmp_path / "o.mcap", to_ns(3))
        assert set(open_recording(tmp_path / "o.mcap").summary.topics) == {
            "/skeleton", "/face", "/label",
        }  # fmt: skip


class TestAnnotate:
    def test_nothing_else_changes(self, tmp_path):
        labels = labels_csv(tmp_path, "hello,0.5,1.5,greet,")
        report = annotate(EVERY_KIND, tmp_path / "o.mcap", labels)
        assert contents(tmp_path / "o.mcap", but={"/label"}) == contents(EVERY_KIND, but={"/label"})
        assert dict(report.added) == {"hello": 1}
        assert [label.gesture for label in open_recording(tmp_path / "o.mcap").labels()] == [
            "idle", "cold", "hello",
        ]  # fmt: skip

    def test_decisions_of_a_live_recording_stay_as_they_are(self, live, setup, tmp_path):
        labels = labels_csv(tmp_path, "smell,4,7,put_out_cigarette,", ",9,12,,yes")
        annotate(live, tmp_path / "o.mcap", labels, replace_all=True)
        assert decisions(tmp_path / "o.mcap", setup) == decisions(live, setup)
        assert len(open_recording(tmp_path / "o.mcap").labels()) == 2

    def test_a_video_that_began_at_another_time_is_shifted(self, tmp_path):
        labels = labels_csv(tmp_path, "hello,100,101,greet,")
        source = STREAMS / "hello.mcap"
        annotate(source, tmp_path / "o.mcap", labels, shift_ns=-to_ns(96), replace_all=True)
        (label,) = open_recording(tmp_path / "o.mcap").labels()
        assert label.onset_ns == to_ns(4)

    def test_a_label_outside_the_recording_is_refused(self, tmp_path):
        labels = labels_csv(tmp_path, "hello,100,101,greet,")
        with pytest.raises(InvalidInput, match=r"begins at 100.000 s, outside the recording"):
            annotate(STREAMS / "hello.mcap", tmp_path / "o.mcap", labels)
        with pytest.raises(InvalidInput, match=r"neither a \.csv nor an \.eaf"):
            annotate(STREAMS / "hello.mcap", tmp_path / "o.mcap", tmp_path / "x.txt")


class TestAnonymise:
    def test_no_name_face_or_wall_time_is_left(self, live, setup, tmp_path):
        output = tmp_path / "o.mcap"
        face = Settings().face
        report = anonymise(live, output, "p07", setup.models.affect, face)
        recording = open_recording(output)
        assert recording.metadata.session == "p07"
        assert recording.metadata.created is None
        text = " ".join(map(str, [recording.metadata, *contents(output)]))
        for name in ("jane", "Jane", "lab-of", "2026-05", "s24"):
            assert name not in text
        assert not {"/face", "/image"} & recording.summary.topics.keys()
        assert report.faces == open_recording(live).summary.topics["/face"]
        assert {e.body_id for e in recording.events() if isinstance(e, SkeletonFrame)} == {1}

    def test_the_agent_decides_as_before(self, live, setup, tmp_path):
        anonymise(live, tmp_path / "o.mcap", "p07", setup.models.affect, Settings().face)
        assert decisions(tmp_path / "o.mcap", setup) == decisions(live, setup)

    def test_without_the_face_the_gate_is_off(self, live, setup, tmp_path):
        face = Settings().face
        anonymise(live, tmp_path / "o.mcap", "p", setup.models.affect, face, face="none")
        recording = open_recording(tmp_path / "o.mcap")
        assert not {"/face", "/affect"} & recording.summary.topics.keys()
        core = setup.core("p")
        modes = {d.gate.mode for d in replay(recording, core, setup.models)}
        assert modes == {"off"}

    def test_every_kind_of_record_is_dealt_with(self, setup, tmp_path):
        face = Settings().face
        anonymise(EVERY_KIND, tmp_path / "o.mcap", "p07", setup.models.affect, face)
        entries = list(read_entries(open_recording(tmp_path / "o.mcap")))
        acks = [entry.item for entry in entries if isinstance(entry.item, Ack)]
        assert {ack.command_id.split("/")[0] for ack in acks} == {"p07"}
        assert {ack.reason for ack in acks} == {None}
        assert not {"/decision", "/command", "/scene"} & {
            topic for topic, _, _ in contents(tmp_path / "o.mcap")
        }


def test_info_tells_what_is_there():
    found = describe(STREAMS / "dropouts_and_passer_by.mcap")
    assert [(b.body_id, b.format) for b in found.bodies] == [(3, "kinect_v2"), (5, "kinect_v2")]
    assert found.bodies[0].rate_hz == pytest.approx(30, abs=0.5)
    assert found.bodies[0].longest_gap_s == pytest.approx(1.0, abs=0.1)
    assert dict(found.faces) == {"dlib68": 440}
    assert dict(found.expected) == {"turn_down_hifi": 1, "close_curtain": 1, "greet": 1}
    assert not found.has_core_log
    assert describe(EVERY_KIND).has_core_log
