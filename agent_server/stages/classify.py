"""From a window and its forecast, or several futures, to class probabilities."""

from collections.abc import Sequence

import numpy as np

from agent_server.domain.gesture import Classification, Spread
from agent_server.domain.model import Classifier
from agent_server.domain.motion import Forecast, Futures, Window
from agent_server.skeleton.normalise import normalise


def classify(
    classifier: Classifier, windows: Sequence[Window], forecasts: Sequence[Forecast]
) -> list[Classification]:
    """Name the three seconds that each window and its forecast make.

    A window with several futures gets the mean of their probabilities.

    Raises:
        InferenceError: If the classifier fails.
    """
    alone = [at for at, forecast in enumerate(forecasts) if forecast.futures is None]
    found: dict[int, Classification] = {}
    if alone:
        motion = np.stack(
            [np.concatenate((windows[at].positions, forecasts[at].positions)) for at in alone]
        )
        rows = classifier.classify(normalise(motion)[0])
        found = {
            at: Classification(classifier.labels, row) for at, row in zip(alone, rows, strict=True)
        }
    for at, forecast in enumerate(forecasts):
        if forecast.futures is not None:
            found[at] = _averaged(classifier, windows[at], forecast, forecast.futures)
    return [found[at] for at in range(len(windows))]


def _averaged(
    classifier: Classifier, window: Window, forecast: Forecast, futures: Futures
) -> Classification:
    """The mean over the forecast and what was drawn beside it; a window at a time."""
    after = np.concatenate((forecast.positions[None], futures.positions))
    before = np.broadcast_to(window.positions, (len(after), *window.positions.shape))
    motion, _ = normalise(np.concatenate((before, after), axis=1))
    rows = classifier.classify(motion)
    probabilities, deviations = rows.mean(axis=0), rows.std(axis=0)
    for array in (probabilities, deviations):
        array.flags.writeable = False
    spread = Spread(len(rows), futures.drawn - len(futures.positions), deviations)
    return Classification(classifier.labels, probabilities, spread)
