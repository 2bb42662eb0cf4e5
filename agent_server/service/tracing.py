"""Traces of decisions, from the frame to the command, for those who collect them.

Nothing of OpenTelemetry is imported before somebody names an endpoint, and a decision's spans are
made after its command has left.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from agent_server import __version__
from agent_server.clock import Clock
from agent_server.domain.stamp import NS_PER_MS
from agent_server.errors import ConfigError
from agent_server.service.watching import Decided, Watcher

if TYPE_CHECKING:
    from opentelemetry.sdk.trace import TracerProvider

ENDPOINTS = ("OTEL_EXPORTER_OTLP_TRACES_ENDPOINT", "OTEL_EXPORTER_OTLP_ENDPOINT")
"""Environment variables that switch traces on; the others of OpenTelemetry hold as well."""


class Traces(Watcher):
    """One trace a decision: a span from the frame to the command, and one for each stage in it.

    Args:
        provider: Where spans go.
        clock: The clock of the decisions' times; its wall time dates the spans.
    """

    def __init__(self, provider: "TracerProvider", clock: Clock) -> None:
        from opentelemetry.trace import set_span_in_context  # noqa: PLC0415 - see above

        self._provider = provider
        self._tracer = provider.get_tracer("agent_server", __version__)
        self._below = set_span_in_context
        self._epoch_ns = clock.wall_ns() - clock.now_ns()

    def decided(self, seen: Decided) -> None:
        """Make the spans of a decision."""
        decision = seen.decision
        attributes: dict[str, str | int | float | bool] = {
            "session.id": seen.session,
            "decision.id": decision.id,
            "decision.outcome": decision.outcome.value,
            "decision.gesture": decision.gesture,
            "decision.reason": decision.reason,
            "gate.open": decision.gate.is_open,
            "window.index": decision.window,
            "window.end_ns": decision.end_ns,
            "forecast.source": decision.forecast,
        }
        if decision.command is not None:
            attributes["command.id"] = decision.command.id
            attributes["command.reaction"] = decision.command.reaction
        whole = self._tracer.start_span(
            "frame to command",
            start_time=self._epoch_ns + seen.arrival_ns,
            attributes=attributes,
        )
        context = self._below(whole)
        for name, begin_ns, end_ns in _stages(seen):
            stage = self._tracer.start_span(
                name, context=context, start_time=self._epoch_ns + begin_ns
            )
            stage.end(self._epoch_ns + end_ns)
        whole.end(self._epoch_ns + seen.decided_ns)

    def close(self) -> None:
        """Send what waits."""
        self._provider.shutdown()


def open_traces(environment: Mapping[str, str], clock: Clock) -> Traces | None:
    """Traces to the endpoint that the environment names; None where it names none.

    Raises:
        ConfigError: If OpenTelemetry is not installed.
    """
    named = next((name for name in ENDPOINTS if environment.get(name)), None)
    if named is None:
        return None
    try:
        from opentelemetry.exporter.otlp.proto.http.trace_exporter import (  # noqa: PLC0415
            OTLPSpanExporter,
        )
        from opentelemetry.sdk.resources import Resource  # noqa: PLC0415
        from opentelemetry.sdk.trace import TracerProvider  # noqa: PLC0415
        from opentelemetry.sdk.trace.export import BatchSpanProcessor  # noqa: PLC0415
    except ImportError as error:
        raise ConfigError(
            f"{named} asks for traces, and OpenTelemetry is not installed: "
            "`pip install 'agent-server[otel]'`, or unset it"
        ) from error
    name = environment.get("OTEL_SERVICE_NAME", "agent-server")
    resource = Resource.create({"service.name": name, "service.version": __version__})
    provider = TracerProvider(resource=resource)
    provider.add_span_processor(BatchSpanProcessor(OTLPSpanExporter()))
    return Traces(provider, clock)


def _stages(seen: Decided) -> list[tuple[str, int, int]]:
    """Name, begin and end of each stage; the models' times end where their answer came."""
    classify_ns = int(seen.classify_ms * NS_PER_MS)
    predict_ns = int(seen.predict_ms * NS_PER_MS)
    classify_from_ns = max(seen.asked_ns, seen.answered_ns - classify_ns)
    predict_from_ns = max(seen.asked_ns, classify_from_ns - predict_ns)
    return [
        ("wait", seen.arrival_ns, predict_from_ns),
        ("predict", predict_from_ns, classify_from_ns),
        ("classify", classify_from_ns, seen.answered_ns),
        ("decide", seen.answered_ns, seen.decided_ns),
    ]
