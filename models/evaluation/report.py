"""All figures of a model, as cards, manifests and ``evaluate --json`` give them."""

from pathlib import Path
from typing import Any

import numpy as np

from agent_server.domain.motion import SEEN_FRAMES
from agent_server.synthetic.corpus import subject_names
from models.data.splits import HELD_OUT, cmu_split, synthetic_split
from models.data.streams import idle_streams
from models.data.windows import Recording, cut
from models.evaluation.gestures import (
    Classify,
    Predict,
    evaluate_decisions,
    false_reactions,
    hold_last,
    labelled_windows,
    probabilities_of,
    scores,
)
from models.evaluation.latency import latency_ms
from models.evaluation.prediction import evaluate_prediction
from models.export.session import OnnxModel

IDLE_MINUTES = 40
IDLE_SEED = 901
STRIDE = 5


def prediction_report(model: OnnxModel, data: Path, cache: Path) -> dict[str, Any]:
    """Errors of a predictor on held-out synthetic people and CMU's test files, and its latency."""
    synthetic = cut(synthetic_split(cache, "test"), STRIDE)
    mocap = cut(cmu_split(data, "test"), STRIDE)
    one = synthetic.frames(synthetic.starts[:1] * 0)[0][:, :SEEN_FRAMES].numpy()
    return {
        "synthetic": evaluate_prediction(model, synthetic),
        "cmu": evaluate_prediction(model, mocap),
        "latency": latency_ms(model, one),
    }


def gesture_report(
    classify: Classify, predict: Predict, recordings: list[Recording]
) -> dict[str, Any]:
    """The thesis's table (3 s, 1 s and 2 s predicted, last frame repeated) and decisions."""
    seen, motion, labels = labelled_windows(cut(recordings, STRIDE))
    return {
        "1s+2s_predicted": scores(probabilities_of(classify, predict, seen), labels),
        "1s+last_frame": scores(probabilities_of(classify, hold_last, seen), labels),
        "3s_true": scores(classify(motion), labels),
        "decisions": evaluate_decisions(classify, predict, recordings),
    }


def idle_report(classify: Classify, predict: Predict, data: Path) -> dict[str, Any]:
    """False reactions on long synthetic idle streams and on CMU's test files."""
    first, count, _ = HELD_OUT["test"]
    streams = idle_streams(IDLE_SEED, IDLE_MINUTES, subject_names(count, first))
    mocap = [take.observed for take in cmu_split(data, "test")]
    return {
        "idle_synthetic": false_reactions(classify, predict, streams),
        "idle_cmu": false_reactions(classify, predict, mocap),
    }


def classifier_report(
    classify: OnnxModel, predict: OnnxModel, data: Path, cache: Path
) -> dict[str, Any]:
    """All figures of a classifier on people that it was not trained on."""
    return {
        **gesture_report(classify.batched, predict.batched, synthetic_split(cache, "test")),
        **idle_report(classify.batched, predict.batched, data),
        "latency": latency_ms(classify, np.zeros((1, 75, 9, 3), np.float32)),
    }
