"""The ways of completing a second that was seen, by the names that all figures use."""

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import SEEN_FRAMES
from models.evaluation.gestures import Classify, hold_last

PREDICTED = "1s+2s_predicted"
HELD = "1s+last_frame"
TRUE = "3s_true"
READINGS = (PREDICTED, HELD, TRUE)


def completed(classify: Classify, seen: Float32, predicted: Float32) -> dict[str, Float32]:
    """Probabilities (N, C) of windows whose future is not known.

    Args:
        classify: Of whole windows.
        seen: Shape (N, 25, 9, 3).
        predicted: Shape (N, 50, 9, 3).
    """
    return {
        PREDICTED: classify(_joined(seen, predicted)),
        HELD: classify(_joined(seen, hold_last(seen))),
    }


def read_all(classify: Classify, motion: Float32, predicted: Float32) -> dict[str, Float32]:
    """Probabilities (N, C) in each reading of whole windows (N, 75, 9, 3)."""
    return {
        **completed(classify, motion[:, :SEEN_FRAMES], predicted),
        TRUE: classify(motion),
    }


def _joined(seen: Float32, future: Float32) -> Float32:
    return np.concatenate([seen, future], axis=1)
