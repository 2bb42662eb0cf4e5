"""Small models without weights, for tests of everything around a model."""

from collections.abc import Callable

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.gesture import GESTURES
from agent_server.domain.motion import PREDICTED_FRAMES
from agent_server.errors import InferenceError


class LastFramePredictor:
    """Predicts that nothing moves. ``fail_on`` names calls (from 0) that raise instead."""

    name = "last_frame_predictor"
    sha256 = "0" * 64

    def __init__(self, fail_on: frozenset[int] = frozenset()) -> None:
        self._fail_on = fail_on
        self.calls = 0

    def predict(self, seen: Float32) -> Float32:
        """Repeat the last seen frame 50 times."""
        call, self.calls = self.calls, self.calls + 1
        if call in self._fail_on:
            raise InferenceError(f"{self.name} failed on call {call}, as it was told to")
        return np.repeat(seen[:, -1:], PREDICTED_FRAMES, axis=1)


class RuleClassifier:
    """Names a motion by a function of its normalised positions (75, 9, 3)."""

    name = "rule_classifier"
    sha256 = "1" * 64

    def __init__(self, rule: Callable[[Float32], str], labels: tuple[str, ...] = GESTURES) -> None:
        self._rule = rule
        self.labels = labels

    def classify(self, motion: Float32) -> Float32:
        """Give 0.94 to the named class and share the rest."""
        rest = 0.06 / (len(self.labels) - 1)
        result = np.full((len(motion), len(self.labels)), rest, dtype=np.float32)
        for row, one in enumerate(motion):
            result[row, self.labels.index(self._rule(one))] = 0.94
        return result
