"""From a window and its forecast to class probabilities."""

from collections.abc import Sequence

import numpy as np

from agent_server.domain.gesture import Classification
from agent_server.domain.model import Classifier
from agent_server.domain.motion import Forecast, Window
from agent_server.skeleton.normalise import normalise


def classify(
    classifier: Classifier, windows: Sequence[Window], forecasts: Sequence[Forecast]
) -> list[Classification]:
    """Name the three seconds that each window and its forecast make.

    Raises:
        InferenceError: If the classifier fails.
    """
    motion = np.stack(
        [
            np.concatenate((window.positions, forecast.positions))
            for window, forecast in zip(windows, forecasts, strict=True)
        ]
    )
    normalised, _ = normalise(motion)
    probabilities = classifier.classify(normalised)
    return [Classification(classifier.labels, row) for row in probabilities]
