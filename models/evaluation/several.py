"""What several futures are worth to the classifier and to the live decision stage.

A window is named by the mean over its futures, as the server does it: the forecast and those
drawn futures that are judged real. Beside that stand the drawn futures alone.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32
from agent_server.domain.gesture import GESTURES
from agent_server.domain.motion import SEEN_FRAMES
from models.data.msrc12 import TaggedStream
from models.data.windows import AMBIGUOUS, Recording, Stretch, whole_labels, window_labels
from models.evaluation.decision_times import LiveStream, answers
from models.evaluation.gestures import Classify, Predict, calibration_error, sliding_seen
from models.evaluation.sampled import Draw
from models.evaluation.sim2real import known_windows
from models.hp_gan.judge import JUDGED_REAL

COUNTS = (1, 5, 10)
"""How many futures are compared."""
EVERY = 6
"""Every sixth of the test takes."""


@dataclass(frozen=True, slots=True)
class Take:
    """A recording as the server lives through it.

    Attributes:
        seen: Shape (N, 25, 9, 3), its windows, normalised.
        last: Shape (N,), last frame of each.
        frames: Length of the recording.
        stretches: The gestures in it.
    """

    seen: Float32
    last: NDArray[np.int64]
    frames: int
    stretches: tuple[Stretch, ...]


@dataclass(frozen=True, slots=True)
class Named:
    """Windows of which it is known what they show.

    Attributes:
        seen: Shape (N, 25, 9, 3), normalised.
        labels: Shape (N,), index in GESTURES.
    """

    seen: Float32
    labels: NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Futures:
    """What the classifier says of each future of N windows.

    Attributes:
        expected: Shape (N, C), of the forecast.
        drawn: Shape (N, K, C).
        good: Shape (N, K), which are judged real.
    """

    expected: Float32
    drawn: Float32
    good: NDArray[np.bool_]

    def together(self, count: int) -> Float32:
        """The mean (N, C) over the forecast and the good ones of ``count`` - 1 draws."""
        weights = self.good[:, : count - 1, None]
        total = self.expected + (self.drawn[:, : count - 1] * weights).sum(axis=1)
        mean: Float32 = total / (1 + weights.sum(axis=1))
        return mean

    def alone(self, count: int) -> Float32:
        """The mean (N, C) over ``count`` draws, whatever their quality."""
        mean: Float32 = self.drawn[:, :count].mean(axis=1)
        return mean

    def spread(self, count: int) -> NDArray[np.float64]:
        """Standard deviation (N,) of the most probable class, over what ``together`` averages."""
        rows = self.together(count)
        best = rows.argmax(1)[:, None]
        values = np.concatenate(
            [
                np.take_along_axis(self.expected, best, 1),
                np.take_along_axis(self.drawn[:, : count - 1], best[:, None], 2)[..., 0],
            ],
            axis=1,
        )
        weights = np.concatenate([np.ones((len(rows), 1)), self.good[:, : count - 1]], axis=1)
        mean = np.average(values, axis=1, weights=weights)[:, None]
        deviation: NDArray[np.float64] = np.sqrt(
            np.average((values - mean) ** 2, axis=1, weights=weights)
        )
        return deviation

    def rows(self) -> dict[str, Float32]:
        """Every way of naming a window, by its name."""
        return {
            "forecast": self.expected,
            **{f"{count}_futures": self.together(count) for count in COUNTS[1:]},
            **{f"{count}_drawn_alone": self.alone(count) for count in COUNTS},
        }


def read_futures(classify: Classify, predict: Predict, draw: Draw, seen: Float32) -> Futures:
    """Name every future of windows (N, 25, 9, 3)."""
    count = max(COUNTS)
    drawn = draw(seen, count)
    expected = classify(np.concatenate([seen, predict(seen)], axis=1))
    past = seen.repeat(count, axis=0)
    motion = np.concatenate([past, drawn.futures.reshape(len(past), -1, *seen.shape[2:])], axis=1)
    rows = classify(motion).reshape(len(seen), count, -1)
    return Futures(expected, rows, drawn.quality >= JUDGED_REAL)


def several_report(
    classify: Classify,
    predict: Predict,
    draw: Draw,
    takes: Sequence[Take],
    real: Named,
) -> dict[str, Any]:
    """Accuracy, calibration and times to a decision, for each number of futures.

    Args:
        classify: motion (B, 75, 9, 3) -> probabilities (B, C).
        predict: seen (B, 25, 9, 3) -> the forecast (B, 50, 9, 3).
        draw: Draws the others.
        takes: Of virtual people whom no model has seen.
        real: The first seconds of real people's gestures.
    """
    found = [read_futures(classify, predict, draw, take.seen) for take in takes]
    virtual = _joined(found)
    labels = np.concatenate([_judged(take) for take in takes])
    report: dict[str, Any] = {
        "synthetic": _named(virtual, labels),
        "msrc12": _named(read_futures(classify, predict, draw, real.seen), real.labels),
        "decisions": {},
    }
    for name in virtual.rows():
        streams = [
            LiveStream(each.rows()[name], take.last, take.frames, take.stretches)
            for each, take in zip(found, takes, strict=True)
        ]
        report["decisions"][name] = _decided(streams)
    return report


def live_takes(recordings: Sequence[Recording]) -> list[Take]:
    """Every sixth of the recordings, as the server lives through it."""
    return [
        Take(*sliding_seen(each.observed), len(each.observed), each.stretches)
        for each in recordings[::EVERY]
        if each.stretches is not None and len(each.observed) >= SEEN_FRAMES
    ]


def real_gestures(streams: Sequence[TaggedStream]) -> Named:
    """The first second of each of MSRC-12's gestures that the server knows by another name."""
    motion, asked = known_windows(streams)
    seen = np.ascontiguousarray(motion[:, :SEEN_FRAMES])
    return Named(seen, np.array([GESTURES.index(name) for name in asked]))


def _judged(take: Take) -> NDArray[np.int64]:
    """Labels of the windows whose seen second and whole say the same, else AMBIGUOUS."""
    seen, whole = (of(take.stretches, GESTURES, take.last) for of in (window_labels, whole_labels))
    return np.where(seen == whole, seen, AMBIGUOUS)


def _joined(found: Iterable[Futures]) -> Futures:
    parts = [(each.expected, each.drawn, each.good) for each in found]
    return Futures(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def _named(futures: Futures, labels: NDArray[np.int64]) -> dict[str, Any]:
    known = labels != AMBIGUOUS
    count = max(COUNTS)
    chosen = Futures(futures.expected[known], futures.drawn[known], futures.good[known])
    truth, spread = labels[known], chosen.spread(count)
    right = chosen.together(count).argmax(1) == truth
    return {
        "windows": int(known.sum()),
        "kept": round(float(chosen.good.mean()), 4),
        "rows": {name: _scores(rows, truth) for name, rows in chosen.rows().items()},
        "spread": {
            "right": round(float(spread[right].mean()), 4),
            "wrong": round(float(spread[~right].mean()), 4),
        },
    }


def _scores(rows: Float32, labels: NDArray[np.int64]) -> dict[str, float]:
    true = rows[np.arange(len(labels)), labels]
    return {
        "accuracy": round(float((rows.argmax(1) == labels).mean()), 4),
        "ece": round(calibration_error(rows, labels), 4),
        "nll": round(float(-np.log(true + 1e-12).mean()), 4),
    }


def _decided(streams: list[LiveStream]) -> dict[str, Any]:
    given = answers(streams, GESTURES)
    half, nine = given.delay_s(50), given.delay_s(90)
    return {
        "gestures": len(given.asked),
        "right": round(float(given.right.mean()), 4),
        "wrong": round(float(given.wrong.mean()), 4),
        "missed": round(float(given.missed.mean()), 4),
        "delay_s_p50": None if half is None else round(half, 3),
        "delay_s_p90": None if nine is None else round(nine, 3),
        "false_per_10_minutes": round(given.false_per_10_minutes or 0.0, 2),
    }
