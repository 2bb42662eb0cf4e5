"""What the server does, as figures that Prometheus collects.

Durations are put into histograms as they happen, some 35 observations a second and session. All
else is counted by the sessions anyway and only read when somebody asks.
"""

import asyncio
from collections import Counter as Tally
from collections import deque
from collections.abc import Iterator, Mapping
from typing import get_args

from prometheus_client import CollectorRegistry, Counter, Histogram, ProcessCollector
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, InfoMetricFamily
from prometheus_client.exposition import generate_latest
from prometheus_client.metrics_core import Metric
from prometheus_client.registry import Collector

from agent_server import __version__
from agent_server.domain.command import CommandEnd
from agent_server.domain.decision import FacePairing, Outcome
from agent_server.domain.stamp import NS_PER_S
from agent_server.protocol import messages as m
from agent_server.service.session import Session
from agent_server.service.watching import Decided, Watcher
from agent_server.service.worker import InferenceWorker

SECONDS = (
    *(0.0005, 0.001, 0.002, 0.003, 0.005, 0.008, 0.012, 0.02),
    *(0.03, 0.05, 0.08, 0.12, 0.2, 0.5, 1.0),
)
"""Upper bounds of the histograms' buckets; 8, 20 and 50 ms are what is promised of commands."""
LAGS = 100
"""Measurements of the event loop's lag that are kept, ten seconds of them."""
STAGES = ("wait", "predict", "classify", "decide", "affect")
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


class Metrics(Watcher):
    """All figures of one server.

    Args:
        sessions: Open sessions by id, as they are when somebody asks.
        worker: What runs the models.
    """

    def __init__(self, sessions: Mapping[str, Session], worker: InferenceWorker) -> None:
        self._registry = registry = CollectorRegistry()
        self._end_to_end = Histogram(
            "agent_server_decision_seconds",
            "From the arrival of the last frame that a decision needs to its command.",
            buckets=SECONDS,
            registry=registry,
        )
        stages = Histogram(
            "agent_server_stage_seconds",
            "Time of one stage: wait, predict, classify and decide of a decision; affect of a "
            "face, with its wait.",
            ["stage"],
            buckets=SECONDS,
            registry=registry,
        )
        self._stages = {stage: stages.labels(stage) for stage in STAGES}
        self._lag = Histogram(
            "agent_server_event_loop_lag_seconds",
            "How much later than asked the event loop wakes a task.",
            buckets=SECONDS,
            registry=registry,
        )
        self._lags: deque[float] = deque(maxlen=LAGS)
        outcomes = Counter(
            "agent_server_decisions",
            "Decisions by what they came to.",
            ["outcome"],
            registry=registry,
        )
        self._outcomes = {one: outcomes.labels(one.value) for one in Outcome}
        gate = Counter(
            "agent_server_gate",
            "What the gate said of a decision, and how the face went with its window.",
            ["verdict", "face"],
            registry=registry,
        )
        self._gate = {
            (is_open, face): gate.labels("open" if is_open else "closed", face.value)
            for is_open in (True, False)
            for face in FacePairing
        }
        self._live = _Live(sessions, worker)
        registry.register(self._live)
        ProcessCollector(registry=registry)

    def decided(self, seen: Decided) -> None:
        """Take the times of a decision, and what it came to."""
        self._end_to_end.observe(seen.total_s)
        for stage, seconds in seen.stages_s.items():
            self._stages[stage].observe(seconds)
        gate = seen.decision.gate
        self._outcomes[seen.decision.outcome].inc()
        self._gate[gate.is_open, gate.face].inc()

    def read_affect(self, seconds: float) -> None:
        """Take the time of one face."""
        self._stages["affect"].observe(seconds)

    def lagged(self, seconds: float) -> None:
        """Take how late the event loop was."""
        self._lag.observe(seconds)
        self._lags.append(seconds)

    @property
    def worst_lag_s(self) -> float:
        """How late the event loop was at worst in the last ten seconds."""
        return max(self._lags, default=0.0)

    def resident_mb(self) -> float | None:
        """Resident memory of the process in MB; None where the system does not tell."""
        memory = self._registry.get_sample_value("process_resident_memory_bytes")
        return None if memory is None else memory / 2**20

    def closed(self, session: Session) -> None:
        """Keep what a session has counted, which is over."""
        self._live.add(session)

    def text(self) -> bytes:
        """Everything, in the text format of Prometheus."""
        return generate_latest(self._registry)


class _Live(Collector):
    """What is read off the sessions when somebody asks."""

    def __init__(self, sessions: Mapping[str, Session], worker: InferenceWorker) -> None:
        self._sessions = sessions
        self._worker = worker
        self._closed: Tally[str] = Tally()
        self._opened = 0

    def add(self, session: Session) -> None:
        """Count a session that is over among the closed ones."""
        self._closed.update(_counted(session))
        self._opened += 1

    def collect(self) -> Iterator[Metric]:
        sessions = list(self._sessions.values())
        total = Tally(self._closed)
        for session in sessions:
            total.update(_counted(session))
        yield from self._counts(total, len(sessions))
        yield from self._states(sessions)
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
