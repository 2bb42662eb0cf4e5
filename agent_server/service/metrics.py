"""What the server does, as figures that Prometheus collects.

Durations are put into histograms as they happen, some 35 observations a second and session. All
else is counted by the sessions anyway and only read when somebody asks.
"""

from collections import deque
from collections.abc import Mapping

from prometheus_client import CollectorRegistry, Counter, Histogram, ProcessCollector
from prometheus_client.exposition import generate_latest

from agent_server.domain.decision import FacePairing, Outcome
from agent_server.service.live_metrics import LiveMetrics
from agent_server.service.session import Session
from agent_server.service.watchdog import Watchdog
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


class Metrics(Watcher):
    """All figures of one server.

    Args:
        sessions: Open sessions by id, as they are when somebody asks.
        worker: What runs the models.
        watchdog: What looks whether they get on.
    """

    def __init__(
        self, sessions: Mapping[str, Session], worker: InferenceWorker, watchdog: Watchdog
    ) -> None:
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
        self._live = LiveMetrics(sessions, worker, watchdog)
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
