"""What a session tells those who look after it, beside its decisions."""

import logging

from agent_server.domain.decision import FacePairing, GateVerdict
from agent_server.domain.motion import Forecast, ForecastFigures, Window
from agent_server.protocol import convert
from agent_server.protocol import messages as m
from agent_server.service.context import Context
from agent_server.stages.forecast_score import ForecastScore

log = logging.getLogger(__name__)


class Telling:
    """Warns a session's monitors, each time that something begins, and sums the session up.

    Args:
        context: The session.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._forecasts = ForecastScore()
        self._is_skewed = False

    @property
    def forecast_figures(self) -> ForecastFigures | None:
        """How good the last minute's forecasts were, or None where no truth has come."""
        return self._forecasts.figures()

    def score(self, window: Window, forecast: Forecast) -> None:
        """Score earlier forecasts by a window; warn when they begin to be worse than none."""
        begins = self._forecasts.push(window, forecast)
        figures = self._forecasts.figures() if begins else None
        if figures is None:
            return
        self._context.counters["forecast_drifts"] += 1
        said = (
            f"over the last minute forecasts were {figures.error_mm:g} mm off, and a body that "
            f"stands still {figures.zero_velocity_mm:g} mm: is the sensor where it was, and its "
            "rate and unit what it says?"
        )
        log.warning("session %s: %s", self._context.id, said)
        self._warn("forecast_drift", said)

    def look_at(self, gate: GateVerdict) -> None:
        """Warn when body and face begin to be captured too far apart."""
        was_skewed, self._is_skewed = self._is_skewed, gate.face is FacePairing.SKEWED
        if self._is_skewed and not was_skewed:
            self._context.counters["face_skews"] += 1
            self._warn(
                "face_skew",
                f"the face was captured {gate.age_ms:g} ms before the end of the window: send "
                "faces more often, or let body and face be stamped by one clock",
            )

    def look_at_recording(self) -> None:
        """Warn, once, when nothing is recorded any more."""
        journal, counters = self._context.journal, self._context.counters
        if (failure := journal.take_failure()) is not None:
            counters["recording_failures"] += 1
            self._warn("recording_failed", failure)
        if journal.lost:
            counters["unrecorded"] = journal.lost

    def stats(self) -> m.StatsMessage:
        """The session in figures."""
        context = self._context
        counters = context.counters
        return m.StatsMessage(
            frames=counters["frames"],
            windows=counters["windows"],
            decisions=counters["decisions"],
            commands=counters["commands"],
            skipped_windows=counters["skipped_windows"],
            predictor_failures=counters["predictor_failures"],
            rejected_messages=counters["rejected_messages"],
            missed_telemetry=context.audience.missed,
            counters={**counters, **context.core.perception.counters},
            clients=[client.stats() for client in context.audience.clients],
            forecast_score=convert.forecast_score_body(self.forecast_figures),
        )

    def _warn(self, code: str, words: str) -> None:
        self._context.audience.show("error", m.ErrorMessage(code, words))
