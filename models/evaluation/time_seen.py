"""How much of a gesture must be seen before it is named right."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32, Float64
from agent_server.domain.motion import CLASSIFIED_FRAMES, FRAME_NS, PREDICTED_FRAMES, SEEN_FRAMES
from agent_server.domain.skeleton import CoreJoint
from models.data.windows import JUDGED, Recording
from models.evaluation.gestures import Classify, Predict
from models.evaluation.readings import HELD, PREDICTED, READINGS, TRUE, completed

SECONDS: Float64 = np.round(np.arange(0.3, 3.05, 0.1), 1)
"""Times after the onset of a gesture."""
FRAMES: NDArray[np.int64] = np.round(SECONDS * 1e9).astype(np.int64) // FRAME_NS
"""The last frame at or before each of these times, counted from the onset."""


@dataclass(frozen=True, slots=True)
class TimeSeen:
    """Windows that end at set times after the onset of a gesture, one a gesture and time.

    Attributes:
        gestures: Shape (K,), what each gesture is.
        there: Shape (K, S), whether a gesture is still going on and the whole second before is
            known.
        complete: Shape (K, S), whether the two seconds after are known as well.
        right: Reading -> shape (K, S), whether the most probable class is the true one; False
            where the window is not there.
    """

    gestures: NDArray[np.str_]
    there: NDArray[np.bool_]
    complete: NDArray[np.bool_]
    right: dict[str, NDArray[np.bool_]]

    @property
    def remaining(self) -> NDArray[np.int64]:
        """How many gestures are there at each time, shape (S,)."""
        count: NDArray[np.int64] = self.there.sum(axis=0)
        return count

    def share(self, reading: str, gesture: str | None = None) -> Float64:
        """Share of the gestures that are named right at each time (S,); NaN where none is there.

        Args:
            reading: Which future completes the windows.
            gesture: Only of this one.
        """
        counted = self.complete if reading == TRUE else self.there
        if gesture is not None:
            counted = counted & (self.gestures == gesture)[:, None]
        shown = counted.sum(axis=0)
        found = (self.right[reading] & counted).sum(axis=0)
        nothing = np.full(len(shown), np.nan)
        share: Float64 = np.divide(found, shown, out=nothing, where=shown > 0)
        return share

    def first_at(self, reading: str, share: float) -> float | None:
        """The first time at which a share of the gestures is named right, in seconds."""
        # A share of nothing is compared as False, as it should.
        reached = self.share(reading) >= share
        return float(SECONDS[reached.argmax()]) if reached.any() else None


def time_seen(
    classify: Classify,
    predict: Predict,
    recordings: Iterable[Recording],
    classes: tuple[str, ...],
) -> TimeSeen:
    """Classify the windows of which t seconds of a gesture are seen, in three readings.

    Args:
        classify: Whole windows.
        predict: Completes seen ones.
        recordings: Gestures in them start anywhere.
        classes: Names of the classifier's columns.
    """
    gestures: list[str] = []
    windows, places, complete = [], [], []
    for recording in recordings:
        for stretch in recording.stretches or ():
            last = stretch.onset + FRAMES
            known = (last >= SEEN_FRAMES - 1) & (last < len(recording.observed))
            known &= last <= stretch.offset - JUDGED.leaving
            for step in np.flatnonzero(known):
                windows.append(_window(recording.observed, int(last[step])))
                places.append((len(gestures), step))
                complete.append(last[step] + PREDICTED_FRAMES < len(recording.observed))
            gestures.append(stretch.gesture)
    shape = (len(gestures), len(SECONDS))
    there, whole = np.zeros(shape, np.bool_), np.zeros(shape, np.bool_)
    right = {reading: np.zeros(shape, np.bool_) for reading in READINGS}
    if windows:
        motion, known = np.stack(windows), np.array(complete)
        rows, steps = np.array(places).T
        asked = np.array([classes.index(gestures[row]) for row in rows])
        there[rows, steps], whole[rows, steps] = True, known
        seen = motion[:, :SEEN_FRAMES]
        found = completed(classify, seen, predict(seen))
        for reading in (PREDICTED, HELD):
            right[reading][rows, steps] = found[reading].argmax(1) == asked
        if known.any():
            true = classify(motion[known]).argmax(1) == asked[known]
            right[TRUE][rows[known], steps[known]] = true
    return TimeSeen(np.array(gestures), there, whole, right)


def _window(positions: Float32, last: int) -> Float32:
    """The normalised window whose last seen frame is given; what nobody recorded stays zero."""
    window = np.zeros((CLASSIFIED_FRAMES, *positions.shape[1:]), np.float32)
    known = positions[last - SEEN_FRAMES + 1 : last + PREDICTED_FRAMES + 1]
    window[: len(known)] = known - positions[last, CoreJoint.NAVEL]
    return window
