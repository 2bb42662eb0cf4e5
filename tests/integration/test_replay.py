"""A live session and its replay come to the same decisions, byte for byte."""

import asyncio
import random
from functools import partial

import msgspec
import pytest

from agent_server.client.once import send_paced
from agent_server.clock import SystemClock
from agent_server.config import GateSettings, Settings
from agent_server.domain.affect import AffectSample
from agent_server.errors import RecordingError
from agent_server.protocol import messages as m
from agent_server.protocol.inputs import input_to_message
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.reader import open_recording
from agent_server.recording.records import WindowDone
from agent_server.recording.writer import RecordingWriter
from agent_server.scene.rules import default_rules
from agent_server.service.core import Core
from agent_server.service.recorder import Recorder, recorder
from agent_server.service.replay import log_line, replay
from tests.support.bodies import frame, stream
from tests.support.live import all_decisions, live
from tests.support.models import fake_models
from tests.support.patience import until

SETTINGS = Settings(gate=GateSettings(mode="optional"))


def replayed(path, models=None):
    models = models or fake_models()
    recording = open_recording(path)
    rules = default_rules(models.classifier.labels)
    core = Core(recording.metadata.session, SETTINGS, rules, models)
    return [log_line(decision) for decision in replay(recording, core, models)]


def lines(decisions):
    return [msgspec.json.encode(message.decision) for message in decisions]


def write(path, events, session="s"):
    metadata = RecordingMetadata(session=session, server_version="test", face="expected")
    with RecordingWriter(path, metadata) as writer:
        for event in sorted(events, key=lambda event: event.originating_ns):
            if isinstance(event, AffectSample):
                writer.append_input(event)
            else:
                writer.append_input(event)


def eventful():
    """12 s with jitter, a gap, a second body, and a face that changes its mind."""
    rng = random.Random(4)
    body = [
        frame(
            index, hands_up=30 < index < 90 or 250 < index < 310, shift=(rng.gauss(0, 0.003),) * 3
        )
        for index in range(360)
        if not 150 <= index < 170 and rng.random() > 0.03
    ]
    other = stream(4, start=100, body_id=7, shift=(1.0, 0.0, 1.0))
    face = [
        AffectSample(index * 100_000_003, -6.0 if index % 40 < 30 else 3.0, 5.0)
        for index in range(118)
    ]
    return [*body, *other, *face]


async def test_live_over_a_websocket_equals_the_replay_of_the_same_recording(tmp_path):
    path = tmp_path / "eventful.mcap"
    write(path, eventful())
    offline = replayed(path)
    assert len(offline) > 40
    assert any(b'"outcome":"command"' in line for line in offline)
    async with (
        live(settings=SETTINGS) as server,
        server.join("monitor", hello=m.Hello("1.0", "t", topics=["decision"])) as monitor,
        server.join("sensor") as sensor,
    ):
        decisions = []
        listening = asyncio.create_task(all_decisions(monitor, decisions))
        await send_in_step(server, sensor, open_recording(path).events())
        await until(lambda: len(decisions) >= len(offline))
        listening.cancel()
    assert lines(decisions) == offline


async def send_in_step(server, sensor, events):
    """Send each input when the one before has had its decision: no window is left out."""
    for sent, event in enumerate(events, start=1):
        await sensor.send(input_to_message(event))
        await until(lambda sent=sent: has_dealt_with(server.hub.sessions["s"].counters, sent))


def has_dealt_with(counters, sent):
    taken = counters["frames"] + counters["affect_samples"]
    return taken == sent and counters["windows"] == counters["decisions"]


async def test_a_recorded_session_with_a_renderer_replays_to_the_same_decisions(tmp_path):
    models = fake_models(fail_on=frozenset({3, 17}))
    open_journal = partial(
        recorder, tmp_path, models=models, clock=SystemClock(), settings=SETTINGS, rules=b""
    )
    async with (
        live(models, SETTINGS, open_journal) as server,
        server.join("monitor", hello=m.Hello("1.0", "t", topics=["decision"])) as monitor,
        server.join("renderer") as renderer,
        server.join("sensor") as sensor,
    ):
        decisions = []
        tasks = [
            asyncio.create_task(all_decisions(monitor, decisions)),
            asyncio.create_task(obey(renderer)),
        ]
        events = sorted(eventful(), key=lambda event: event.originating_ns)
        await send_paced(sensor, events, 4.0)
        await asyncio.sleep(2.0)  # long enough for ticks
        for task in tasks:
            task.cancel()
    (path,) = tmp_path.glob("s-*.mcap")
    recording = open_recording(path)
    assert recording.summary.topics["/ack"] >= 2
    assert recording.summary.topics["/core"] > len(decisions)
    log = lines(decisions)
    assert any(b"as it was told to" in line for line in log)
    assert replayed(path) == log
    recorded = [
        record.message.decision
        for record in recording.records(("/decision",))
        if isinstance(record.message, m.DecisionMessage)
    ]
    assert recorded == [message.decision for message in decisions]


async def obey(renderer):
    """A renderer that takes half a second for everything."""
    async for message in renderer:
        if isinstance(message, m.CommandMessage):
            await renderer.send(m.AckMessage(message.id, "started"))
            await asyncio.sleep(0.5)
            await renderer.send(m.AckMessage(message.id, "done"))


def test_a_replay_repeats_itself(tmp_path):
    path = tmp_path / "eventful.mcap"
    write(path, eventful())
    assert replayed(path) == replayed(path)


async def test_a_log_that_does_not_fit_its_frames_is_refused(tmp_path):
    path = tmp_path / "odd.mcap"
    with RecordingWriter(path, RecordingMetadata("s", "test")) as writer:
        for one in stream(2):
            writer.append_input(one)
        writer.append_core(WindowDone(0, 99))
    with pytest.raises(RecordingError, match="window 99"):
        replayed(path)


async def test_a_disk_that_fails_does_not_stop_the_session(tmp_path, caplog):
    def to_nowhere(session):
        path = tmp_path / "missing" / session
        return Recorder(path, RecordingMetadata(session, "test"), SystemClock())

    async with (
        live(settings=SETTINGS, open_journal=to_nowhere) as server,
        server.join("monitor") as monitor,
        server.join("sensor") as sensor,
    ):
        decisions = []
        listening = asyncio.create_task(all_decisions(monitor, decisions))
        await send_paced(sensor, stream(2), 10.0)
        await asyncio.sleep(0.3)
        listening.cancel()
    assert decisions
    assert "recording stopped" in caplog.text
