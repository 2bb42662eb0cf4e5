"""When the live decision stage answers a gesture, and what other thresholds would make of it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import msgspec
import numpy as np
from numpy.typing import NDArray

from agent_server.config import DecideSettings
from agent_server.domain.arrays import Float32, Float64
from agent_server.domain.motion import RATE_HZ, SEEN_FRAMES
from models.data.windows import Recording, Stretch
from models.evaluation.gestures import (
    ANSWER_FRAMES,
    DECIDE,
    Classify,
    Predict,
    answer_to,
    decisions,
    probabilities_of,
    sliding_seen,
)

ENTER = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95)
ENTER_WINDOWS = (1, 2, 3, 4)
SUREST = 0.99
"""No gesture is asked to be surer than this."""


@dataclass(frozen=True, slots=True)
class LiveStream:
    """A recording as the server lives through it, window after window.

    Attributes:
        probabilities: Shape (N, C).
        last: Shape (N,), last frame of each window.
        frames: Length of the recording.
        stretches: The gestures in it.
    """

    probabilities: Float32
    last: NDArray[np.int64]
    frames: int
    stretches: tuple[Stretch, ...]


@dataclass(frozen=True, slots=True)
class Answers:
    """What is decided on streams with K gestures.

    Attributes:
        asked: Name of each gesture.
        given: The decision that answers it; None where it is missed.
        delays_s: Shape (K,), from the onset to the end of the deciding window; NaN where missed.
        false: Decisions that answer nothing.
        idle_minutes: Time in which there is nothing to answer.
    """

    asked: tuple[str, ...]
    given: tuple[str | None, ...]
    delays_s: Float64
    false: int
    idle_minutes: float

    @property
    def right(self) -> NDArray[np.bool_]:
        """Shape (K,), which gestures are answered with their own name."""
        pairs = zip(self.asked, self.given, strict=True)
        return np.array([asked == given for asked, given in pairs], np.bool_)

    @property
    def missed(self) -> NDArray[np.bool_]:
        """Shape (K,), which gestures nothing answers."""
        return np.array([given is None for given in self.given], np.bool_)

    @property
    def wrong(self) -> NDArray[np.bool_]:
        """Shape (K,), which gestures are answered with another name."""
        return ~self.right & ~self.missed

    @property
    def false_per_10_minutes(self) -> float | None:
        """None where there is no idle time."""
        return 10 * self.false / self.idle_minutes if self.idle_minutes else None

    def delay_s(self, percent: float) -> float | None:
        """A percentile of the delays of the right answers; None where there is none."""
        delays = self.delays_s[self.right]
        return float(np.percentile(delays, percent)) if len(delays) else None

    def by(self, seconds: Float64, which: NDArray[np.bool_]) -> Float64:
        """Share of all gestures that are among some answers and decided by each time (S,)."""
        done = self.delays_s[which][:, None] <= seconds
        share: Float64 = done.sum(axis=0) / max(1, len(self.asked))
        return share


@dataclass(frozen=True, slots=True)
class Setting:
    """What other thresholds of the decision stage give.

    Attributes:
        settings: The thresholds.
        answers: What is decided with them.
    """

    settings: DecideSettings
    answers: Answers


def live_streams(
    classify: Classify, predict: Predict, recordings: Iterable[Recording]
) -> list[LiveStream]:
    """All windows of the recordings that are long enough and of which the gestures are known."""
    streams = []
    for recording in recordings:
        if recording.stretches is None or len(recording.observed) < SEEN_FRAMES:
            continue
        seen, last = sliding_seen(recording.observed)
        rows = probabilities_of(classify, predict, seen)
        streams.append(LiveStream(rows, last, len(recording.observed), recording.stretches))
    return streams


def answers(
    streams: Iterable[LiveStream], classes: tuple[str, ...], settings: DecideSettings = DECIDE
) -> Answers:
    """Run the decision stage over streams."""
    asked: list[str] = []
    given: list[str | None] = []
    delays: list[float] = []
    false = idle_frames = 0
    for stream in streams:
        decided = decisions(stream.probabilities, classes=classes, settings=settings)
        found = [(int(stream.last[window]), name) for window, name in decided]
        idle = np.ones(stream.frames, np.bool_)
        for stretch in stream.stretches:
            answer = answer_to(stretch, found)
            asked.append(stretch.gesture)
            given.append(answer[1] if answer else None)
            delays.append((answer[0] - stretch.onset) / RATE_HZ if answer else np.nan)
            idle[stretch.onset : stretch.offset + ANSWER_FRAMES + 1] = False
        false += sum(bool(idle[at]) for at, _ in found)
        idle_frames += int(idle.sum())
    return Answers(tuple(asked), tuple(given), np.array(delays), false, idle_frames / RATE_HZ / 60)


def sweep(streams: Sequence[LiveStream], classes: tuple[str, ...]) -> list[Setting]:
    """What the decision stage gives with other ``enter`` and ``enter_windows``."""
    grid = [_with(enter, windows) for windows in ENTER_WINDOWS for enter in ENTER]
    return [Setting(settings, answers(streams, classes, settings)) for settings in grid]


def _with(enter: float, enter_windows: int) -> DecideSettings:
    """The shipped settings, but for two; gestures that no face confirms stay as much surer."""
    surer = DECIDE.enter_ungated - DECIDE.enter
    return msgspec.structs.replace(
        DECIDE,
        enter=enter,
        enter_ungated=min(enter + surer, SUREST),
        leave=min(DECIDE.leave, enter),
        enter_windows=enter_windows,
    )
