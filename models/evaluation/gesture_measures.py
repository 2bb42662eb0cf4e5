"""Everything that the gesture report shows, measured once."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32, Float64
from agent_server.domain.gesture import IDLE
from agent_server.domain.motion import RATE_HZ, SEEN_FRAMES
from agent_server.errors import InvalidInput
from models.data.windows import Recording, cut
from models.evaluation.calibration_curves import reliability, risk_coverage
from models.evaluation.decision_times import Answers, Setting, answers, live_streams, sweep
from models.evaluation.gestures import Classify, Predict, hold_last, scores
from models.evaluation.prediction_gain import (
    HORIZONS_MS,
    Gain,
    gain_of,
    hand_distances,
    p_over_time,
)
from models.evaluation.readings import HELD, PREDICTED, READINGS, read_all
from models.evaluation.time_seen import SECONDS, TimeSeen, time_seen

STRIDE = 5


@dataclass(frozen=True, slots=True)
class GestureMeasures:
    """How a classifier does on labelled recordings.

    Attributes:
        classes: Names of its columns.
        recordings: How many recordings.
        people: How many people.
        minutes: How long all recordings are together.
        labels: Shape (N,), of the windows that can be judged.
        probabilities: Reading -> shape (N, C).
        hands_mm: Predicted and held reading -> shape (N, horizons), see ``hand_distances``.
        seen: Windows by the time after the onset.
        live: Predicted and held reading -> what is decided on the streams.
        others: What other thresholds would decide, with predicted futures.
    """

    classes: tuple[str, ...]
    recordings: int
    people: int
    minutes: float
    labels: NDArray[np.int64]
    probabilities: dict[str, Float32]
    hands_mm: dict[str, Float32]
    seen: TimeSeen
    live: dict[str, Answers]
    others: tuple[Setting, ...]

    @property
    def shown(self) -> list[str]:
        """The classes that have a window."""
        return [name for at, name in enumerate(self.classes) if (self.labels == at).any()]

    def of(self, name: str) -> NDArray[np.bool_]:
        """Which windows (N,) are of a class."""
        chosen: NDArray[np.bool_] = self.labels == self.classes.index(name)
        return chosen

    @property
    def right(self) -> dict[str, NDArray[np.bool_]]:
        """Reading -> shape (N,), which windows are named right."""
        return {name: rows.argmax(1) == self.labels for name, rows in self.probabilities.items()}

    @property
    def gains(self) -> dict[str, Gain]:
        """Class -> what a predicted future adds."""
        right = self.right
        return {name: gain_of(right, self.of(name)) for name in self.shown}

    @property
    def gain(self) -> Gain:
        """What a predicted future adds over all windows."""
        return gain_of(self.right, np.ones(len(self.labels), np.bool_))

    @property
    def gesture_gain(self) -> Gain | None:
        """What it adds over the windows of all gestures; None where there is none."""
        shows = ~self.of(IDLE)
        return gain_of(self.right, shows) if shows.any() else None


def measure(
    classify: Classify,
    predict: Predict,
    recordings: Sequence[Recording],
    classes: tuple[str, ...],
) -> GestureMeasures:
    """Measure a classifier and a predictor on recordings of people that neither has seen.

    Args:
        classify: motion (B, 75, 9, 3) -> probabilities (B, C).
        predict: seen (B, 25, 9, 3) -> future (B, 50, 9, 3).
        recordings: With labelled gestures.
        classes: Names of the classifier's columns; ``idle`` is one of them.

    Raises:
        InvalidInput: If no gesture is shown, or no window can be judged.
    """
    if not any(recording.stretches for recording in recordings):
        raise InvalidInput("no recording shows a gesture: give some that do, with labels")
    windows = cut(recordings, STRIDE, classes)
    judged = windows.judged()
    if not len(judged):
        raise InvalidInput(
            "no window shows one class for long enough: give recordings of longer gestures"
        )
    observed, clean = (part.numpy() for part in judged.frames(torch.arange(len(judged))))
    seen, true = observed[:, :SEEN_FRAMES], clean[:, SEEN_FRAMES:]
    expected = predict(seen)
    streams = live_streams(classify, predict, recordings)
    held = live_streams(classify, hold_last, recordings)
    return GestureMeasures(
        classes=classes,
        recordings=len(recordings),
        people=len({recording.subject for recording in recordings}),
        minutes=sum(len(recording.observed) for recording in recordings) / RATE_HZ / 60,
        labels=judged.labels.numpy(),
        probabilities=read_all(classify, observed, expected),
        hands_mm={
            PREDICTED: hand_distances(expected, true),
            HELD: hand_distances(hold_last(seen), true),
        },
        seen=time_seen(classify, predict, recordings, classes),
        live={PREDICTED: answers(streams, classes), HELD: answers(held, classes)},
        others=tuple(sweep(streams, classes)),
    )


def figures_of(measured: GestureMeasures) -> dict[str, Any]:
    """All figures of the page, for programs."""
    return {
        "recordings": measured.recordings,
        "people": measured.people,
        "minutes": round(measured.minutes, 1),
        **{reading: _reading(measured, reading) for reading in READINGS},
        "decisions": {name: _decided(found) for name, found in measured.live.items()},
        "settings": [_setting(other) for other in measured.others],
        "time_seen": _over_time(measured.seen),
        "reliability": _reliability(measured),
        "prediction": _prediction(measured),
    }


def _reading(measured: GestureMeasures, reading: str) -> dict[str, Any]:
    rows = measured.probabilities[reading]
    area = risk_coverage(rows, measured.labels).area
    return {**scores(rows, measured.labels, measured.classes), "aurc": round(area, 4)}


def _decided(found: Answers) -> dict[str, Any]:
    return {
        "gestures": len(found.asked),
        **{
            name: round(float(which.mean()), 4) if len(which) else None
            for name, which in (
                ("right", found.right),
                ("wrong", found.wrong),
                ("missed", found.missed),
            )
        },
        "delay_s_p50": _rounded(found.delay_s(50), 3),
        "delay_s_p90": _rounded(found.delay_s(90), 3),
        "false_per_10_minutes": _rounded(found.false_per_10_minutes, 2),
        "idle_minutes": round(found.idle_minutes, 1),
    }


def _setting(other: Setting) -> dict[str, Any]:
    return {
        "enter": other.settings.enter,
        "enter_windows": other.settings.enter_windows,
        **_decided(other.answers),
    }


def _over_time(seen: TimeSeen) -> dict[str, Any]:
    return {
        "seconds": SECONDS.tolist(),
        "gestures": seen.remaining.tolist(),
        **{reading: _listed(seen.share(reading)) for reading in READINGS},
        "p_value": _listed(p_over_time(seen), 6),
    }


def _reliability(measured: GestureMeasures) -> dict[str, Any]:
    found = reliability(measured.probabilities[PREDICTED], measured.labels)
    return {
        "windows": found.counts.tolist(),
        "confidence": _listed(found.confidence),
        "accuracy": _listed(found.accuracy),
    }


def _prediction(measured: GestureMeasures) -> dict[str, Any]:
    return {
        **_gain(measured.gain),
        "gestures": _gain(measured.gesture_gain) if measured.gesture_gain else None,
        "classes": {
            name: {
                **_gain(gain),
                "hands_mm": {
                    reading: {
                        str(ms): round(float(off), 1)
                        for ms, off in zip(
                            HORIZONS_MS, rows[measured.of(name)].mean(axis=0), strict=True
                        )
                    }
                    for reading, rows in measured.hands_mm.items()
                },
            }
            for name, gain in measured.gains.items()
        },
    }


def _gain(gain: Gain) -> dict[str, Any]:
    return {
        "verdict": gain.verdict.name.lower(),
        "gain_points": round(gain.points, 2),
        "room_points": round(gain.room, 2),
        "p_value": gain.p_value,
    }


def _listed(values: Float64, digits: int = 4) -> list[float | None]:
    """Numbers for JSON, which has none that is not one."""
    return [None if np.isnan(value) else round(float(value), digits) for value in values]


def _rounded(value: float | None, digits: int) -> float | None:
    return None if value is None else round(value, digits)
