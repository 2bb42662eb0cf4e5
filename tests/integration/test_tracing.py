"""Traces from the frame to the command."""

import sys

import pytest

from agent_server.clock import SystemClock
from agent_server.config import GateSettings, Settings
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import ConfigError
from agent_server.scene.rules import default_rules
from agent_server.service.hub import Hub
from agent_server.service.tracing import Traces, open_traces
from tests.integration.test_sight import perform
from tests.support.live import live
from tests.support.models import fake_models

ENDPOINT = {"OTEL_EXPORTER_OTLP_ENDPOINT": "http://127.0.0.1:9"}


async def test_a_decision_is_a_trace_whose_stages_follow_each_other():
    trace = pytest.importorskip("opentelemetry.sdk.trace")
    export = pytest.importorskip("opentelemetry.sdk.trace.export")
    memory = pytest.importorskip("opentelemetry.sdk.trace.export.in_memory_span_exporter")
    exporter = memory.InMemorySpanExporter()
    provider = trace.TracerProvider()
    provider.add_span_processor(export.SimpleSpanProcessor(exporter))
    clock, models = SystemClock(), fake_models()
    hub = Hub(
        Settings(gate=GateSettings(mode="off")),
        default_rules(models.classifier.labels),
        models,
        clock,
        watchers=(Traces(provider, clock),),
    )
    began_ns = clock.wall_ns()
    async with live(models, hub.settings, hub=hub) as server:
        decisions = await perform(server, "ann")
    spans = exporter.get_finished_spans()
    by_decision = {
        span.attributes["decision.id"]: span for span in spans if span.name == "frame to command"
    }
    assert {one.id for one in decisions} <= set(by_decision)
    whole = by_decision[decisions[-1].id]
    assert whole.attributes["session.id"] == "ann"
    assert whole.attributes["decision.outcome"] == "command"
    assert whole.attributes["command.id"] == decisions[-1].command.id
    assert began_ns <= whole.start_time < whole.end_time <= clock.wall_ns() + NS_PER_S // 10
    stages = [
        span for span in spans if span.parent and span.parent.span_id == whole.context.span_id
    ]
    assert [stage.name for stage in stages] == ["wait", "predict", "classify", "decide"]
    times = [time for stage in stages for time in (stage.start_time, stage.end_time)]
    assert times == sorted(times)
    assert (times[0], times[-1]) == (whole.start_time, whole.end_time)


def test_traces_are_off_without_an_endpoint():
    assert open_traces({}, SystemClock()) is None
    assert open_traces({"OTEL_EXPORTER_OTLP_ENDPOINT": ""}, SystemClock()) is None


def test_an_endpoint_without_opentelemetry_is_told(monkeypatch):
    monkeypatch.setitem(sys.modules, "opentelemetry.exporter.otlp.proto.http.trace_exporter", None)
    with pytest.raises(ConfigError, match=r"pip install 'agent-server\[otel\]'"):
        open_traces(ENDPOINT, SystemClock())
