"""How well gestures are told apart, how early, and how rarely where there is none."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import torch

from agent_server.config import DecideSettings, WindowSettings
from agent_server.domain.arrays import Float32
from agent_server.domain.gesture import GESTURES, HELLO, IDLE, Classification
from agent_server.domain.motion import FRAME_NS, RATE_HZ, SEEN_FRAMES
from agent_server.domain.skeleton import CoreJoint
from agent_server.stages.decide import GestureTracker, Phase
from models.data.windows import Recording, Stretch, WindowSet

HOP_FRAMES = WindowSettings().hop
DECIDE = DecideSettings()
ANSWER_FRAMES = 10
"""A gesture may still be decided on this many frames after its offset."""
REJECT = 0.5
"""A single window whose best class is less probable than this is rejected: it counts as idle."""

Predict = Callable[[Float32], Float32]
"""seen (B, 25, 9, 3) -> future (B, 50, 9, 3)."""
Classify = Callable[[Float32], Float32]
"""motion (B, 75, 9, 3) -> probabilities (B, C)."""


def hold_last(seen: Float32) -> Float32:
    """The future that repeats the last seen frame."""
    return np.repeat(seen[:, -1:], 50, axis=1)


def probabilities_of(classify: Classify, predict: Predict, seen: Float32) -> Float32:
    """Probabilities (N, C) of windows of which only the seen second (N, 25, 9, 3) is known."""
    return classify(np.concatenate([seen, predict(seen)], axis=1))


def named_or_idle(probabilities: Float32, classes: Sequence[str] = GESTURES) -> list[str]:
    """The class of each row (N, C); one that is not more probable than not counts as idle."""
    best = probabilities.argmax(1)
    sure = probabilities.max(1) > REJECT
    return [classes[c] if s else IDLE for c, s in zip(best, sure, strict=True)]


def labelled_windows(windows: WindowSet) -> tuple[Float32, Float32, np.ndarray]:
    """Seen frames, whole windows and labels of the windows that can be judged.

    These have a label, and their future shows nothing that the label does not say.
    """
    judged = windows.judged()
    motion = judged.all().numpy()
    return motion[:, :SEEN_FRAMES], motion, judged.labels.numpy()


def scores(
    probabilities: Float32, labels: np.ndarray, classes: Sequence[str] = GESTURES
) -> dict[str, Any]:
    """Accuracy, its balanced form, recall a class, calibration error and confusion.

    ``rejecting`` is the accuracy with the reject option, and the share that it accepts.
    """
    guess = probabilities.argmax(1)
    confusion = np.zeros((len(classes), len(classes)), dtype=int)
    np.add.at(confusion, (labels, guess), 1)
    shown = confusion.sum(1)
    recall = np.divide(confusion.diagonal(), shown, where=shown > 0, out=np.zeros(len(shown)))
    return {
        "windows": len(labels),
        "accuracy": round(float((guess == labels).mean()), 4),
        "balanced_accuracy": round(float(recall[shown > 0].mean()), 4),
        "recall": {name: round(float(r), 4) for name, r in zip(classes, recall, strict=True)},
        "rejecting": rejecting(probabilities, labels),
        "ece": round(calibration_error(probabilities, labels), 4),
        "confusion": confusion.tolist(),
    }


def rejecting(probabilities: Float32, labels: np.ndarray) -> dict[str, float]:
    """Share of windows that the reject option accepts, and the accuracy on those."""
    sure = probabilities.max(1) > REJECT
    right = probabilities.argmax(1) == labels
    accuracy = float(right[sure].mean()) if sure.any() else 0.0
    return {"accepted": round(float(sure.mean()), 4), "accuracy": round(accuracy, 4)}


def calibration_error(probabilities: Float32, labels: np.ndarray, bins: int = 15) -> float:
    """Expected calibration error: mean gap of confidence and accuracy over equal bins."""
    confidence = probabilities.max(1)
    right = probabilities.argmax(1) == labels
    which = np.minimum((confidence * bins).astype(int), bins - 1)
    gap = 0.0
    for b in range(bins):
        inside = which == b
        if inside.any():
            gap += inside.mean() * abs(float(confidence[inside].mean() - right[inside].mean()))
    return float(gap)


def sliding_seen(positions: Float32) -> tuple[Float32, np.ndarray]:
    """Normalised seen windows (N, 25, 9, 3) of a stream, 5 frames apart, and their last frame."""
    last = np.arange(SEEN_FRAMES - 1, len(positions), HOP_FRAMES)
    windows = positions[last[:, None] + np.arange(1 - SEEN_FRAMES, 1)]
    return windows - windows[:, -1:, CoreJoint.NAVEL : CoreJoint.NAVEL + 1], last


def decisions(
    probabilities: Float32,
    ends_ns: Sequence[int] | None = None,
    *,
    classes: tuple[str, ...] = GESTURES,
    settings: DecideSettings = DECIDE,
) -> list[tuple[int, str]]:
    """Windows in which the live decision stage decides on a gesture, and which.

    Args:
        probabilities: Shape (N, C), a row a window.
        ends_ns: When each window ends; None stands for one every 0.2 s.
        classes: Names of the columns.
        settings: Of the decision stage.
    """
    if ends_ns is None:
        ends_ns = range(0, len(probabilities) * HOP_FRAMES * FRAME_NS, HOP_FRAMES * FRAME_NS)
    tracker = GestureTracker(settings, {HELLO})
    found: list[tuple[int, str]] = []
    for window, (row, end_ns) in enumerate(zip(probabilities, ends_ns, strict=True)):
        tracking = tracker.push(Classification(classes, row), end_ns)
        if tracking.phase is Phase.ACTIVE:
            found.append((window, tracking.gesture))
            tracker.mark_handled()
    return found


def answer_to(asked: Stretch, found: Iterable[tuple[int, str]]) -> tuple[int, str] | None:
    """The first decision between a gesture's onset and 0.4 s after its offset.

    Args:
        asked: The gesture.
        found: Last frame of the deciding window and what is decided, in the order of time.
    """
    until = asked.offset + ANSWER_FRAMES
    return next(((at, name) for at, name in found if asked.onset <= at <= until), None)


def evaluate_decisions(
    classify: Classify,
    predict: Predict,
    recordings: Iterable[Recording],
    classes: tuple[str, ...] = GESTURES,
) -> dict[str, Any]:
    """What is decided while gestures are made: right, wrong, missed, and how late.

    The delay runs from the onset to the end of the deciding window, in seconds.
    """
    delays: list[float] = []
    right = wrong = missed = 0
    for take in recordings:
        if not take.stretches or len(take.observed) < SEEN_FRAMES:
            continue
        seen, last = sliding_seen(take.observed)
        rows = probabilities_of(classify, predict, seen)
        found = [(int(last[at]), name) for at, name in decisions(rows, classes=classes)]
        for asked in take.stretches:
            answer = answer_to(asked, found)
            if answer is None:
                missed += 1
            elif answer[1] == asked.gesture:
                right += 1
                delays.append((answer[0] - asked.onset) / RATE_HZ)
            else:
                wrong += 1
    total = max(1, right + wrong + missed)
    return {
        "takes": right + wrong + missed,
        "right": round(right / total, 4),
        "wrong": round(wrong / total, 4),
        "missed": round(missed / total, 4),
        "delay_s_p50": round(float(np.median(delays)), 3) if delays else None,
        "delay_s_p90": round(float(np.percentile(delays, 90)), 3) if delays else None,
    }


def false_reactions(
    classify: Classify,
    predict: Predict,
    streams: Iterable[Float32],
    classes: tuple[str, ...] = GESTURES,
) -> dict[str, Any]:
    """Decisions on streams in which nothing is to be decided, (T, 9, 3) each."""
    frames, found = 0, []
    for positions in streams:
        if len(positions) < SEEN_FRAMES:
            continue
        seen, _ = sliding_seen(positions)
        rows = probabilities_of(classify, predict, seen)
        found += [name for _, name in decisions(rows, classes=classes)]
        frames += len(positions)
    minutes = frames / RATE_HZ / 60
    return {
        "minutes": round(minutes, 1),
        "false_reactions": len(found),
        "per_10_minutes": round(10 * len(found) / minutes, 2),
        "gestures": {name: found.count(name) for name in classes if name in found},
    }


def as_torch(model: torch.nn.Module) -> Callable[[Float32], Float32]:
    """A torch network as a function of arrays, a few hundred rows at a time."""

    def run(values: Float32) -> Float32:
        with torch.no_grad():
            parts = [model(part) for part in torch.split(torch.from_numpy(values), 256)]
        result: Float32 = torch.cat(parts).numpy()
        return result

    return run
