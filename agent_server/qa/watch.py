"""What goes by inside the core during a replay: windows, forecasts and what came of them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from agent_server.config import Settings
from agent_server.domain.affect import AffectSample, Calibrated
from agent_server.domain.arrays import Float32, Float64
from agent_server.domain.decision import Decision
from agent_server.domain.face import Face
from agent_server.domain.gesture import Classification
from agent_server.domain.motion import FRAME_NS, SEEN_FRAMES, Forecast, Window
from agent_server.domain.stamp import NS_PER_MS
from agent_server.qa.result import HORIZONS_MS, ForecastError, Moment
from agent_server.scene.rulebook import Rules
from agent_server.service.core import Core, PendingWindow, Result
from agent_server.service.models import Models

_HORIZONS = np.array(HORIZONS_MS) * NS_PER_MS // FRAME_NS
_SEEN_SHOWN = (0, 6, 12, 18, 24)
_AHEAD_SHOWN = (9, 19, 29, 39, 49)
"""Frames of a window and of its forecast that are drawn: 240 and 400 ms apart."""


@dataclass(frozen=True, slots=True)
class Sight:
    """A window with the forecast and the decision that it came to."""

    window: Window
    forecast: Forecast
    decision: Decision


class WatchedCore(Core):
    """A core that keeps what it has decided on. It decides as any other.

    Attributes:
        sights: Everything decided on so far, in order.
        affect: Valence and arousal that came, or were read from a face, in order.
    """

    def __init__(self, session: str, settings: Settings, rules: Rules, models: Models) -> None:
        super().__init__(session, settings, rules, models)
        self.sights: list[Sight] = []
        self.affect: list[AffectSample] = []

    def feel(self, sample: AffectSample) -> None:
        """Take an affect sample, and keep it."""
        super().feel(sample)
        self.affect.append(sample)

    def look(
        self, face: Face, estimate: Float64 | None = None
    ) -> tuple[AffectSample, Calibrated | None]:
        """Take a face, and keep what was read from it."""
        read = super().look(face, estimate)
        self.affect.append(read[0])
        return read

    def decide(
        self, pending: PendingWindow, forecast: Forecast, classification: Classification
    ) -> Result:
        """Come to a decision, and keep it with its window and forecast."""
        result = super().decide(pending, forecast, classification)
        self.sights.append(Sight(pending.window, forecast, result.decision))
        return result


class Track:
    """The body as it was seen, frame by frame, put together from overlapping windows.

    Args:
        sights: Of one recording.
    """

    def __init__(self, sights: list[Sight]) -> None:
        self._rows: dict[tuple[int, int], int] = {}
        frames: list[Float32] = []
        sure: list[Float32] = []
        for sight in sights:
            window = sight.window
            first_ns = window.end_ns - (SEEN_FRAMES - 1) * FRAME_NS
            for index in range(SEEN_FRAMES):
                key = (window.body_id, first_ns + index * FRAME_NS)
                if key not in self._rows:
                    self._rows[key] = len(frames)
                    frames.append(window.positions[index])
                    sure.append(window.confidence[index])
        self._positions = np.array(frames, np.float32).reshape(-1, 9, 3)
        self._confidence = np.array(sure, np.float32).reshape(-1, 9)

    def after(self, window: Window, frames: int) -> int | None:
        """Row of the pose ``frames`` after a window, if it was seen."""
        return self._rows.get((window.body_id, window.end_ns + frames * FRAME_NS))

    def pose(self, row: int) -> Float32:
        """A pose, shape (9, 3), metres in the camera frame."""
        pose: Float32 = self._positions[row]
        return pose

    def errors(self, sights: list[Sight]) -> ForecastError:
        """Errors of forecasts against what came, and of the last pose held, in mm."""
        windows, live, held = [], [], []
        for horizon in _HORIZONS.tolist():
            pairs = [
                (sight, row)
                for sight in sights
                if (row := self.after(sight.window, horizon)) is not None
            ]
            windows.append(len(pairs))
            if not pairs:
                live.append(0.0)
                held.append(0.0)
                continue
            rows = [row for _, row in pairs]
            truth, weight = self._positions[rows], self._confidence[rows] > 0  # (N, 9, 3), (N, 9)
            ahead = np.stack([sight.forecast.positions[horizon - 1] for sight, _ in pairs])
            last = np.stack([sight.window.positions[-1] for sight, _ in pairs])
            live.append(_total_mm(ahead, truth, weight))
            held.append(_total_mm(last, truth, weight))
        return ForecastError(windows, live, held)

    def moment(self, sight: Sight, title: str) -> Moment:
        """The poses around a decision."""
        window = sight.window
        origin = window.positions[-1, 2]  # the navel at the end of the window
        rows = [self.after(window, frame + 1) for frame in _AHEAD_SHOWN]
        return Moment(
            at_ms=window.end_ns // NS_PER_MS,
            title=title,
            seen=[_drawn(window.positions[frame], origin) for frame in _SEEN_SHOWN],
            predicted=[_drawn(sight.forecast.positions[f], origin) for f in _AHEAD_SHOWN],
            truth=[[] if row is None else _drawn(self.pose(row), origin) for row in rows],
        )


def _total_mm(guess: Float32, truth: Float32, weight: NDArray[np.bool_]) -> float:
    """Sum over windows of the mean distance of the joints that were measured, in mm."""
    distance = np.linalg.norm(guess - truth, axis=-1) * weight
    return round(float((distance.sum(1) / np.maximum(weight.sum(1), 1)).sum() * 1000), 1)


def _drawn(pose: Float32, origin: Float32) -> list[list[int]]:
    drawn: list[list[int]] = np.rint((pose - origin) * 1000).astype(int).tolist()
    return drawn
