"""What Prometheus collects that sessions count anyway: read off them only when somebody asks."""

import asyncio
import math
from collections import Counter as Tally
from collections.abc import Iterator, Mapping
from typing import get_args

from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, InfoMetricFamily
from prometheus_client.metrics_core import Metric
from prometheus_client.registry import Collector

from agent_server import __version__
from agent_server.domain.command import CommandEnd
from agent_server.domain.stamp import NS_PER_S
from agent_server.protocol import messages as m
from agent_server.service.session import Session
from agent_server.service.watchdog import Watchdog
from agent_server.service.worker import InferenceWorker

MM_PER_M = 1000.0
RECEIVED = {
    "frame": "frames",
    "face": "faces",
    "image": "images",
    "affect": "affect_samples",
    "gaze": "gazes",
    "ack": "acks",
    "scene_event": "scene_events",
}
"""What came -> the session's counter of it."""
DROPPED = {
    "window_overtaken": "skipped_windows",
    "image_overtaken": "skipped_images",
    "face_overtaken": "skipped_faces",
    "message_rejected": "rejected_messages",
    "ack_stale": "stale_acks",
}
FAILURES = {
    "predictor": "predictor_failures",
    "classifier": "classifier_failures",
    "affect": "affect_failures",
}


class LiveMetrics(Collector):
    """Figures of the sessions, open and closed.

    Args:
        sessions: Open sessions by id, as they are when somebody asks.
        worker: What runs the models.
        watchdog: What looks whether they get on.
    """

    def __init__(
        self, sessions: Mapping[str, Session], worker: InferenceWorker, watchdog: Watchdog
    ) -> None:
        self._sessions = sessions
        self._worker = worker
        self._watchdog = watchdog
        self._closed: Tally[str] = Tally()
        self._opened = 0

    def add(self, session: Session) -> None:
        """Count a session that is over among the closed ones."""
        self._closed.update(_counted(session))
        self._opened += 1

    def collect(self) -> Iterator[Metric]:
        """All of them."""
        sessions = list(self._sessions.values())
        total = Tally(self._closed)
        for session in sessions:
            total.update(_counted(session))
        yield from self._counts(total, len(sessions))
        yield from self._states(sessions)
        yield _forecast_error(sessions)
        yield GaugeMetricFamily(
            "agent_server_tasks", "Tasks of the event loop.", len(asyncio.all_tasks())
        )
        yield from self._versions()

    def _counts(self, total: Tally[str], open_now: int) -> Iterator[Metric]:
        yield CounterMetricFamily(
            "agent_server_sessions_opened", "Sessions that were opened.", self._opened + open_now
        )
        yield CounterMetricFamily(
            "agent_server_resumes",
            "Renderers that came back after a lost connection and resumed.",
            total["resumes"],
        )
        yield CounterMetricFamily(
            "agent_server_commands", "Commands that were issued.", total["commands"]
        )
        yield CounterMetricFamily(
            "agent_server_clock_jumps", "Jumps of clients' clocks.", total["clock_jumps"]
        )
        yield CounterMetricFamily(
            "agent_server_forecast_drifts",
            "How often a session's forecasts began to be worse than a body that stands still.",
            total["forecast_drifts"],
        )
        stalls = CounterMetricFamily(
            "agent_server_stalls", "How often something was stuck.", labels=["what"]
        )
        stalls.add_metric(["event_loop"], self._watchdog.loop_stalls)
        stalls.add_metric(["models"], self._watchdog.inference_stalls)
        yield stalls
        by_name = {one.value: f"commands_{one}" for one in CommandEnd}
        yield _counters("received", "What clients sent and was taken.", "kind", RECEIVED, total)
        dropped = {**DROPPED, "telemetry_overtaken": "missed_telemetry"}
        yield _counters("dropped", "What was not used, by its reason.", "reason", dropped, total)
        yield _counters("failures", "Results that a model owed.", "model", FAILURES, total)
        yield _counters("command_ends", "How commands ended.", "end", by_name, total)

    def _states(self, sessions: list[Session]) -> Iterator[Metric]:
        clients = [client for session in sessions for client in session.audience.clients]
        yield GaugeMetricFamily("agent_server_sessions", "Open sessions.", len(sessions))
        connected = _gauges("clients", "Connected clients.", "role")
        round_trip = _gauges(
            "round_trip_seconds", "Longest round trip of a ping to a client.", "role"
        )
        drift = _gauges(
            "clock_offset_change_seconds",
            "By how much a client's clock has moved against the server's since its first pong: "
            "the largest.",
            "role",
        )
        for role in get_args(m.Role):
            those = [client for client in clients if client.role == role]
            trips = [client.clock.round_trip_ns or 0 for client in those]
            drifts = [abs(client.clock.drift_ns) for client in those]
            connected.add_metric([role], len(those))
            round_trip.add_metric([role], max(trips, default=0) / NS_PER_S)
            drift.add_metric([role], max(drifts, default=0) / NS_PER_S)
        yield from (connected, round_trip, drift)
        depth = _gauges(
            "queue_depth", "What waits: windows, faces, or messages to clients.", "queue"
        )
        depth.add_metric(["models"], self._worker.windows.waiting)
        depth.add_metric(["faces"], self._worker.faces.waiting)
        waiting = [client.outbox.waiting for client in clients]
        depth.add_metric(["clients"], sum(waiting))
        depth.add_metric(["slowest_client"], max(waiting, default=0))
        yield depth

    def _versions(self) -> Iterator[Metric]:
        yield InfoMetricFamily("agent_server", "The server.", {"version": __version__})
        models = GaugeMetricFamily(
            "agent_server_model_info", "Models in use.", labels=["task", "name", "sha256"]
        )
        for task, model in self._worker.models.by_task:
            models.add_metric([task, model.name, model.sha256[:12]], 1)
        yield models


def _forecast_error(sessions: list[Session]) -> Metric:
    family = _gauges(
        "forecast_error_meters",
        "Mean distance of the joints over the last minute, of the forecasts and of a body that "
        "stands still; NaN where no truth has come.",
        "of",
    )
    scored = [one for one in (session.forecast_figures for session in sessions) if one is not None]
    count = sum(one.forecasts for one in scored)
    error_mm = sum(one.error_mm * one.forecasts for one in scored)
    still_mm = sum(one.zero_velocity_mm * one.forecasts for one in scored)
    for of, sum_mm in (("forecast", error_mm), ("zero_velocity", still_mm)):
        family.add_metric([of], sum_mm / count / MM_PER_M if count else math.nan)
    return family


def _counted(session: Session) -> Tally[str]:
    counted = Tally(session.counters)
    counted["missed_telemetry"] += session.audience.missed
    return counted


def _counters(
    name: str, words: str, label: str, counters: Mapping[str, str], total: Tally[str]
) -> Metric:
    family = CounterMetricFamily(f"agent_server_{name}", words, labels=[label])
    for value, counter in counters.items():
        family.add_metric([value], total[counter])
    return family


def _gauges(name: str, words: str, label: str) -> GaugeMetricFamily:
    return GaugeMetricFamily(f"agent_server_{name}", words, labels=[label])
