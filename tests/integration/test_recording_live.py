"""Live sessions that are recorded: in parts, by a monitor, on a disk that fails; their scores."""

import asyncio
from functools import partial

import msgspec
import pytest

from agent_server.cli.record import _record, _Watch
from agent_server.client.once import send_paced
from agent_server.clock import SystemClock
from agent_server.config import GateSettings, RecordingSettings, Settings
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.protocol import messages as m
from agent_server.recording.parts import later_parts
from agent_server.recording.reader import open_recording
from agent_server.scene.rules import default_rules
from agent_server.service.core import Core
from agent_server.service.recorder import recorder
from agent_server.service.replay import log_line, replay
from tests.support.bodies import frame, stream
from tests.support.live import live
from tests.support.models import fake_models

SETTINGS = Settings(
    gate=GateSettings(mode="optional"), recording=RecordingSettings(rotate_minutes=0.01)
)
WAVING = [frame(index, hands_up=60 < index < 150) for index in range(300)]


def replayed(path):
    models = fake_models()
    recording = open_recording(path)
    core = Core(
        recording.metadata.session, SETTINGS, default_rules(models.classifier.labels), models
    )
    return [log_line(decision) for decision in replay(recording, core, models)]


def journal(folder):
    return partial(
        recorder, folder, models=fake_models(), clock=SystemClock(), settings=SETTINGS, rules=b""
    )


async def run_session(server, frames, speed, until=None):
    """Send frames and collect what a monitor is told."""
    heard = []

    async def listen():
        async for message in monitor:
            heard.append(message)  # noqa: PERF401 - what came before the end stays

    async with server.join("monitor") as monitor, server.join("sensor") as sensor:
        listening = asyncio.create_task(listen())
        await send_paced(sensor, frames, speed)
        for _ in range(100):
            if until is None or until(heard):
                break
            await asyncio.sleep(0.05)
        await asyncio.sleep(0.5)
        listening.cancel()
    return heard


async def test_a_recording_in_parts_replays_as_one(tmp_path):
    async with live(settings=SETTINGS, open_journal=journal(tmp_path)) as server:
        heard = await run_session(server, WAVING, 4.0)
    first = min(tmp_path.glob("s-*.mcap"), key=lambda path: len(path.name))
    assert len(later_parts(first)) >= 2
    decided = [
        msgspec.json.encode(one.decision) for one in heard if isinstance(one, m.DecisionMessage)
    ]
    log = replayed(first)
    assert [line for line in log if line in decided] == decided
    assert any(b'"outcome":"command"' in line for line in log)
    # A later part alone begins anew, with another window 0.
    assert replayed(later_parts(first)[0])


async def test_a_monitor_records_what_it_is_told(tmp_path):
    async with live(settings=SETTINGS) as server:
        watch = _Watch(tmp_path, "s", SystemClock(), RecordingSettings(participant="P07"))
        recording = asyncio.create_task(_record(server.url, "s", watch, None))
        while watch.path is None:  # noqa: ASYNC110 - it has no event
            await asyncio.sleep(0.01)
        await run_session(server, WAVING, 2.0)
        recording.cancel()
        await asyncio.gather(recording, return_exceptions=True)
        watch.close()
    found = open_recording(watch.path)
    assert found.metadata.participant == "P07"
    assert found.metadata.bundles == {
        model.name: model.sha256 for _, model in fake_models().by_task
    }
    topics = found.summary.topics
    assert topics["/decision"] == watch.counts["decision"] > 30
    assert topics["/command"] == watch.counts["command"] >= 1
    assert topics["/scene"] >= 2
    assert all(
        event.format == "core9" for event in found.events() if isinstance(event, SkeletonFrame)
    )
    assert {sequence for sequence, _, _ in found.times()}
    said = [r.message.decision.gesture for r in found.records(["/decision"])]
    again = [line for line in replayed(watch.path) if b'"gesture":"hello"' in line]
    assert abs(len(again) - said.count("hello")) <= 2


async def test_monitors_are_told_once_that_recording_has_stopped(tmp_path, caplog):
    async with live(settings=SETTINGS, open_journal=journal(tmp_path / "missing")) as server:

        def is_told(heard):
            return any(
                isinstance(one, m.StatsMessage) and "unrecorded" in one.counters for one in heard
            )

        heard = await run_session(server, stream(6), 2.0, is_told)
    errors = [one for one in heard if isinstance(one, m.ErrorMessage)]
    assert [one.code for one in errors] == ["recording_failed"]
    assert "cannot be created" in errors[0].message
    stats = [one for one in heard if isinstance(one, m.StatsMessage)][-1]
    assert stats.counters["recording_failures"] == 1
    assert stats.counters["unrecorded"] > 0
    assert [one for one in heard if isinstance(one, m.DecisionMessage)]


async def test_monitors_are_told_how_good_forecasts_were():
    async with live(settings=SETTINGS) as server:
        heard = await run_session(server, stream(6), 3.0)
    scores = [one.forecast_score for one in heard if isinstance(one, m.StatsMessage)]
    assert scores[0] is None
    assert scores[-1].forecasts >= 2
    # The fake predictor holds the last frame, which is what zero velocity means.
    assert scores[-1].error_mm == pytest.approx(scores[-1].zero_velocity_mm, abs=0.2)
