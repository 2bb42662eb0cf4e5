"""What an operator sees of a running server: readiness, figures, logs."""

import asyncio
import json
import logging
from dataclasses import replace
from threading import Event

import httpx
import msgspec
import pytest
from prometheus_client.parser import text_string_to_metric_families

from agent_server import assets
from agent_server.clock import SystemClock
from agent_server.config import GateSettings, Settings
from agent_server.inference.fake import LastFramePredictor
from agent_server.logs import JsonFormatter
from agent_server.protocol import messages as m
from agent_server.protocol.convert import skeleton_to_message
from agent_server.scene.rules import default_rules
from agent_server.service.hub import Hub
from agent_server.transports.app import create_app
from tests.support.bodies import stream
from tests.support.live import live, next_of
from tests.support.models import fake_models
from tests.support.patience import patience, until

UNGATED = Settings(gate=GateSettings(mode="off"))
GESTURE = stream(4, hands_up=lambda t: t >= 1.5)


async def figures(server):
    """Name and labels -> value, of everything at /metrics."""
    async with httpx.AsyncClient(base_url=server.url) as http:
        answer = await http.get("/metrics")
    assert answer.headers["content-type"].startswith("text/plain")
    return {
        (sample.name, *sorted(sample.labels.values())): sample.value
        for family in text_string_to_metric_families(answer.text)
        for sample in family.samples
    }


async def perform(server, session="s"):
    """Send a gesture, and give the decisions up to the one with the command."""
    decisions = []
    async with server.join("monitor", session) as monitor, server.join("sensor", session) as sensor:
        for frame in GESTURE:
            await sensor.send(skeleton_to_message(frame))
            await asyncio.sleep(0.001)
        while not decisions or decisions[-1].outcome != "command":
            decisions.append((await next_of(monitor, m.DecisionMessage)).decision)
    return decisions


class Held(LastFramePredictor):
    """Predicts nothing before it is let go on."""

    def __init__(self):
        super().__init__()
        self.go_on = Event()

    def predict(self, seen):
        assert self.go_on.wait(10)
        return super().predict(seen)


async def test_the_server_is_not_ready_before_it_is_warm():
    predictor = Held()
    models = replace(fake_models(), predictor=predictor)
    hub = Hub(Settings(), default_rules(models.classifier.labels), models, SystemClock())
    app = create_app(hub, assets.page())
    transport = httpx.ASGITransport(app)
    async with (
        app.router.lifespan_context(app),
        httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as http,
    ):
        assert (await http.get("/healthz")).status_code == 200
        answer = await http.get("/readyz")
        assert (answer.status_code, answer.json()["ready"]) == (503, False)
        predictor.go_on.set()
        async with patience():
            await hub.warm.wait()
        assert (await http.get("/readyz")).status_code == 200
        assert predictor.calls >= 1
        hub.stop()
        assert (await http.get("/readyz")).status_code == 503


async def test_figures_tell_what_happened():
    async with live(settings=UNGATED) as server:
        async with server.join("renderer"):
            decisions = await perform(server)
            seen = await figures(server)
        counted = {
            outcome: sum(one.outcome == outcome for one in decisions)
            for outcome in {one.outcome for one in decisions}
        }
        for outcome, count in counted.items():
            assert seen["agent_server_decisions_total", outcome] >= count
        made = sum(
            value for name, value in seen.items() if name[0] == "agent_server_decisions_total"
        )
        assert seen[("agent_server_decision_seconds_count",)] == made
        for stage in ("wait", "predict", "classify", "decide"):
            assert seen["agent_server_stage_seconds_count", stage] == made
        assert seen["agent_server_received_total", "frame"] == len(GESTURE)
        assert seen[("agent_server_commands_total",)] >= 1
        assert seen["agent_server_clients", "renderer"] == 1
        assert seen[("agent_server_sessions",)] == 1
        assert seen[("agent_server_event_loop_lag_seconds_count",)] > 0
        assert seen["agent_server_gate_total", "not_needed", "open"] == made


async def test_stages_add_up_to_the_whole():
    async with live(settings=UNGATED) as server:
        await perform(server)
        seen = await figures(server)
        stages = sum(
            value
            for name, value in seen.items()
            if name[0] == "agent_server_stage_seconds_sum" and name[1] != "affect"
        )
        assert stages == pytest.approx(seen[("agent_server_decision_seconds_sum",)], rel=0.05)


async def test_what_a_session_counted_outlives_it():
    brief = msgspec.structs.replace(UNGATED.server, session_linger_s=0.0)
    settings = msgspec.structs.replace(UNGATED, server=brief)
    async with live(settings=settings) as server:
        await perform(server)
        await until(lambda: not server.hub.sessions)
        seen = await figures(server)
        assert seen[("agent_server_sessions",)] == 0
        assert seen[("agent_server_sessions_opened_total",)] == 1
        assert seen["agent_server_received_total", "frame"] == len(GESTURE)
        await perform(server)
        assert (await figures(server))["agent_server_received_total", "frame"] == 2 * len(GESTURE)


async def test_a_decision_is_logged_with_its_ids(caplog):
    with caplog.at_level(logging.INFO, "agent_server"):
        async with live(settings=UNGATED) as server:
            decisions = await perform(server, "ann")
    lines = [json.loads(JsonFormatter().format(record)) for record in caplog.records]
    (decided,) = (line for line in lines if "decision" in line)
    assert decided["decision"] == decisions[-1].id
    assert decided["session"] == "ann"
    assert decided["message"].startswith("command after ")
    assert set(decided) == {"time", "level", "logger", "message", "session", "decision"}
    opened = next(line for line in lines if "opened" in line["message"])
    assert opened["level"] == "info"


def test_json_logs_carry_the_traceback(caplog):
    try:
        raise ValueError("no such thing")
    except ValueError:
        logging.getLogger("agent_server.x").exception("it failed")
    line = json.loads(JsonFormatter().format(caplog.records[-1]))
    assert line["message"] == "it failed"
    assert "ValueError: no such thing" in line["error"]
