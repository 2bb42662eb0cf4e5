"""What the plots of a report show, from the decisions and labels of a run."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from agent_server.domain.decision import Outcome
from agent_server.domain.gesture import IDLE
from agent_server.qa.result import HORIZONS_MS, CaseResult, Step, Stretch, Thresholds

LATE_MS = 1000
"""A gesture is still recognised so long after its end: windows look back."""
BIN_MS = 200
SEEN_MS = 3000
_HELD = (
    Outcome.COMMAND.value,
    Outcome.HANDLED.value,
    Outcome.GATED.value,
    Outcome.BUSY.value,
    Outcome.NOTHING_TO_DO.value,
)
"""Outcomes of a window in which a gesture is held to be going on."""


@dataclass(frozen=True, slots=True)
class Confusion:
    """Labelled gestures by what the agent held them for longest.

    Attributes:
        labels: What was labelled, rows; what it was held for, columns; ``idle`` is last.
        counts: Shape (rows, columns).
    """

    labels: list[str]
    counts: list[list[int]]


@dataclass(frozen=True, slots=True)
class Curve:
    """Points of a line: x, y, and how many values each stands for."""

    x: list[float]
    y: list[float]
    n: list[int]


@dataclass(frozen=True, slots=True)
class GateCurve:
    """How well valence parts uncomfortable from other faces, over all thresholds.

    Attributes:
        false_pass: Share of other faces that pass, ascending.
        true_pass: Share of uncomfortable faces that pass.
        area: Area under the curve.
        at: (false_pass, true_pass) of the threshold in force.
        positives: Windows with a face that ought to pass.
        negatives: Windows with a face that ought not to.
    """

    false_pass: list[float]
    true_pass: list[float]
    area: float
    at: tuple[float, float]
    positives: int
    negatives: int


def confusion(cases: Iterable[CaseResult]) -> Confusion:
    """Count what each labelled stretch was held for longest; nothing counts as ``idle``."""
    counts: Counter[tuple[str, str]] = Counter()
    for case in cases:
        for label in case.labels:
            end_ms = label.offset_ms + (0 if label.gesture == IDLE else LATE_MS)
            held = Counter(
                step.gesture
                for step in _during(case, label.onset_ms, end_ms)
                if step.outcome in _HELD
            )
            # The end of a gesture reaches into the quiet after it: that is no mistake.
            if label.gesture == IDLE:
                held = Counter(step.gesture for step in _commands(case, label))
            counts[label.gesture, held.most_common(1)[0][0] if held else IDLE] += 1
    names = [*sorted({name for pair in counts for name in pair} - {IDLE}), IDLE]
    return Confusion(names, [[counts[row, column] for column in names] for row in names])


def accuracy_over_time(cases: Iterable[CaseResult]) -> Curve:
    """Share of windows whose most probable gesture is the labelled one, by time seen of it."""
    hits: dict[int, list[bool]] = defaultdict(list)
    for case in cases:
        for label in case.labels:
            if label.gesture == IDLE:
                continue
            for step in _during(case, label.onset_ms, label.offset_ms):
                seen_ms = step.at_ms - label.onset_ms
                if seen_ms < SEEN_MS:
                    hits[seen_ms // BIN_MS].append(step.best == label.gesture)
    bins = sorted(hits)
    return Curve(
        [(index + 0.5) * BIN_MS / 1000 for index in bins],
        [float(np.mean(hits[index])) for index in bins],
        [len(hits[index]) for index in bins],
    )


def gate_curve(cases: Iterable[CaseResult], gate: Thresholds) -> GateCurve | None:
    """Valence as a test of whether a face is uncomfortable, with the gate's bound on arousal.

    Positive are faces during gestures that ask for a reaction and are gated by valence.
    Negative are faces where the agent must stay quiet, but for gestures that the same recording
    asks a reaction to elsewhere: these are quiet because of the room, and tell nothing of the
    face. None where one of the two is missing.
    """
    good: list[float] = []
    bad: list[float] = []
    for case in cases:
        asked = {label.gesture for label in case.labels if label.expected is not None}
        for label in case.labels:
            if label.gesture == "hello" or (label.quiet and label.gesture in asked):
                continue
            if label.expected is None and not label.quiet:
                continue
            scores = [
                -step.valence if abs(step.arousal) > gate.arousal else -np.inf
                for step in _during(case, label.onset_ms, label.offset_ms)
                if step.valence is not None and step.arousal is not None
            ]
            (good if label.expected is not None else bad).extend(scores)
    if not good or not bad:
        return None
    positive, negative = np.array(good), np.array(bad)
    bounds = np.unique(np.concatenate([positive, negative, [np.inf, -np.inf]]))[::-1]
    true_pass = (positive[None] >= bounds[:, None]).mean(1)
    false_pass = (negative[None] >= bounds[:, None]).mean(1)
    at = (float((negative > -gate.valence).mean()), float((positive > -gate.valence).mean()))
    return GateCurve(
        false_pass.tolist(),
        true_pass.tolist(),
        float(np.trapezoid(true_pass, false_pass)),
        at,
        len(good),
        len(bad),
    )


def forecast_curves(cases: Iterable[CaseResult], part: str) -> tuple[Curve, Curve] | None:
    """Mean joint error by horizon: of the forecast, and of the last pose held.

    Args:
        cases: Recordings.
        part: ``gesture`` or ``idle``, as :attr:`CaseResult.forecast` has it.
    """
    errors = [case.forecast[part] for case in cases if part in case.forecast]
    windows = np.sum([error.windows for error in errors], axis=0)
    if not errors or not windows.any():
        return None
    kept = np.flatnonzero(windows)
    x = [HORIZONS_MS[index] / 1000 for index in kept.tolist()]
    curves = [
        Curve(x, (np.sum(sums, axis=0)[kept] / windows[kept]).tolist(), windows[kept].tolist())
        for sums in ([e.live for e in errors], [e.zero_velocity for e in errors])
    ]
    return curves[0], curves[1]


def _during(case: CaseResult, start_ms: int, end_ms: int) -> Iterator[Step]:
    return (step for step in case.steps if start_ms <= step.at_ms <= end_ms)


def _commands(case: CaseResult, label: Stretch) -> Iterator[Step]:
    return (s for s in _during(case, label.onset_ms, label.offset_ms) if s.reaction is not None)
