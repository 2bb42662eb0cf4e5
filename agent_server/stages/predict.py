"""From windows to forecasts: the predictor, or the last frame where it fails."""

from collections.abc import Sequence

import numpy as np

from agent_server.domain.model import Predictor
from agent_server.domain.motion import PREDICTED_FRAMES, Forecast, Window
from agent_server.errors import InferenceError
from agent_server.skeleton.normalise import denormalise, normalise

LAST_FRAME = "last_frame"


def predict(predictor: Predictor, windows: Sequence[Window]) -> list[Forecast]:
    """Continue every window by two seconds.

    A batch that fails is tried one by one, so that one bad window costs no other its forecast.
    A window whose forecast fails is completed by its last frame, and the forecast says why.
    """
    seen = np.stack([window.positions for window in windows])
    normalised, origin = normalise(seen)
    try:
        future = denormalise(predictor.predict(normalised), origin)
    except InferenceError as error:
        if len(windows) > 1:
            return [predict(predictor, [window])[0] for window in windows]
        return [hold_last(windows[0], str(error))]
    return [Forecast(one, predictor.name) for one in future]


def hold_last(window: Window, failure: str) -> Forecast:
    """The forecast that stands in when the predictor has failed: nothing moves any more."""
    still = np.repeat(window.positions[-1:], PREDICTED_FRAMES, axis=0)
    return Forecast(still, LAST_FRAME, failure)
