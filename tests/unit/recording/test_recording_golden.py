from collections.abc import Callable
from pathlib import Path
from types import ModuleType

from mcap.records import Channel, Message
from mcap.stream_reader import StreamReader

from agent_server.domain.skeleton import SkeletonFrame
from agent_server.recording.reader import open_recording


def raw_messages(path: Path) -> list[tuple[str, int, int, int, bytes]]:
    """Topic, times, sequence and bytes of every message, by the library's own reader."""
    topics: dict[int, str] = {}
    found = []
    with path.open("rb") as file:
        for record in StreamReader(file, validate_crcs=True).records:
            if isinstance(record, Channel):
                topics[record.id] = record.topic
            elif isinstance(record, Message):
                found.append(
                    (
                        topics[record.channel_id],
                        record.log_time,
                        record.publish_time,
                        record.sequence,
                        record.data,
                    )
                )
    return found


def test_a_recording_of_version_1_stays_readable(session: ModuleType) -> None:
    recording = open_recording(session.GOLDEN)
    assert recording.metadata == session.METADATA
    assert recording.summary.topics == {
        "/ack": 2,
        "/affect": 20,
        "/command": 1,
        "/core": 8,
        "/decision": 1,
        "/label": 2,
        "/scene": 1,
        "/scene_event": 1,
        "/skeleton": 66,
    }
    assert recording.summary.records == 102
    assert recording.summary.duration_s == 60 * session.PERIOD_NS / 1e9
    frames = [event for event in recording.events() if isinstance(event, SkeletonFrame)]
    assert len(frames) == 66
    expected = [session.body(index, 1) for index in range(60)]
    got = [frame for frame in frames if frame.body_id == 1]
    assert [frame.joints.tobytes() for frame in got] == [f.joints.tobytes() for f in expected]


def test_the_layout_of_version_1_is_still_what_is_written(
    session: ModuleType, write: Callable[[str], Path]
) -> None:
    """Fails when a record's bytes change: that needs a new version, and its own golden file."""
    assert raw_messages(write("now.mcap")) == raw_messages(session.GOLDEN)


def test_the_bytes_of_a_skeleton_are_these(session: ModuleType) -> None:
    topic, log_time, publish_time, sequence, data = raw_messages(session.GOLDEN)[2]
    assert (topic, log_time, publish_time, sequence) == ("/skeleton", 0, 0, 2)
    assert data.startswith(
        b'{"type":"skeleton","originating_ns":0,"body_id":1,"format":"core9",'
        b'"joints":[[0.5403,0.8415,2.0,1.0],[-0.4161,0.9093,2.1,1.0],'
    )
