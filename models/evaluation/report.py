"""All figures of a model, as cards, manifests and ``evaluate --json`` give them."""

from pathlib import Path
from typing import Any

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.synthetic.corpus import subject_names
from models.data.splits import HELD_OUT, cmu_split, synthetic_split
from models.data.streams import idle_streams
from models.data.windows import Recording, cut
from models.evaluation.forecasters import Forecaster, forecaster, names_for, zero_velocity
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
from models.evaluation.html_report import write_report
from models.evaluation.latency import latency_ms
from models.evaluation.prediction import evaluate, gain_percent, outcomes, summary
from models.evaluation.protocols import Protocol, protocol_named
from models.ops.session import OnnxModel

IDLE_MINUTES = 40
IDLE_SEED = 901
STRIDE = 5


def benchmark_report(model: Forecaster, windows: dict[str, dict[str, Float32]]) -> dict[str, Any]:
    """Figures of a research model, by protocol.

    Args:
        model: What is measured.
        windows: Protocol -> action -> windows.
    """
    return {
        name: evaluate(model, protocol_named(name), by_action)
        for name, by_action in windows.items()
    }


def server_report(model: Forecaster, windows: dict[str, dict[str, Float32]]) -> dict[str, Any]:
    """The same for nine joints, beside standing still: CMU's test files come first.

    The figures of the other recordings lie beside them under the protocol's short name,
    ``msrc12`` and ``synthetic``.
    """
    rows: dict[str, Any] = {}
    for name, by_action in windows.items():
        protocol = protocol_named(name)
        row = evaluate(model, protocol, by_action)
        still = evaluate(zero_velocity(protocol), protocol, by_action)["average"]["mpjpe"]
        row |= {
            "zero_velocity": still,
            "gain_percent": gain_percent(row["average"]["mpjpe"], still),
        }
        rows |= row if name == "server" else {name.removeprefix("server-"): row}
    return rows


def compare(
    model: Forecaster,
    protocol: Protocol,
    data: Path,
    windows: dict[str, Float32],
    folder: Path,
) -> Path:
    """Write an HTML page that shows a model beside all others at hand for the protocol."""
    others = [name for name in names_for(protocol) if name != model.name]
    # The page speaks of the first one.
    models = [model, *(forecaster(name, protocol, data) for name in others)]
    results = {each.name: outcomes(each, protocol, windows) for each in models}
    summaries = {each.name: summary(each, protocol, results[each.name]) for each in models}
    return write_report(folder, protocol, results, summaries)


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
