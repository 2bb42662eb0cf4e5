"""How far predicted motion is from the true one, and whether it moves like it."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from agent_server.domain.arrays import Float32
from models.evaluation.forecasters import Forecaster
from models.evaluation.protocols import Protocol

MM = 1000.0


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a model predicts for the windows of an action, in mm.

    Attributes:
        seen: Shape (N, seen, J, 3), the joints that models predict.
        predicted: Shape (N, future, J, 3).
        true: Shape (N, future, J, 3).
        errors: Shape (future,), the protocol's error at each frame.
    """

    seen: Float32
    predicted: Float32
    true: Float32
    errors: Float32


def outcomes(
    model: Forecaster, protocol: Protocol, windows_by_action: dict[str, Float32]
) -> dict[str, Outcome]:
    """Run a model over the windows of a protocol, by action."""
    result = {}
    for action, windows in windows_by_action.items():
        joints = windows[:, :, protocol.layout.joints]
        seen, true = joints[:, : protocol.seen], joints[:, protocol.seen :]
        predicted = MM * model(seen / np.float32(MM))
        errors = protocol.measure(predicted, windows[:, protocol.seen :])
        result[action] = Outcome(seen, predicted, true, errors)
    return result


def joint_speed(start: Float32, future: Float32) -> Float32:
    """Mean per-joint speed (MPJS) in mm a frame, shape (F,).

    Args:
        start: Last seen pose, shape (N, 1, J, 3), mm.
        future: Shape (N, F, J, 3), mm.
    """
    steps = np.diff(future, axis=1, prepend=start)
    speed: Float32 = np.linalg.norm(steps, axis=-1).mean(axis=(0, 2))
    return speed


def bone_error(predicted: Float32, true: Float32, bones: tuple[tuple[int, int], ...]) -> float:
    """Mean difference of bone lengths, predicted against true, in mm; (N, F, J, 3) both."""
    parents, children = (list(ends) for ends in zip(*bones, strict=True))

    def lengths(poses: Float32) -> Float32:
        lines: Float32 = np.linalg.norm(poses[..., children, :] - poses[..., parents, :], axis=-1)
        return lines

    return float(np.abs(lengths(predicted) - lengths(true)).mean())


def figures(outcome: Outcome, protocol: Protocol) -> dict[str, Any]:
    """All figures of one action.

    ``mpjpe`` holds the protocol's error at each horizon; ``mpjs_error`` is the mean over time of
    the difference of mean speeds; ``jump_mm`` is the mean size of the first predicted step, which
    ``true_jump_mm`` gives of the truth.
    """
    start = outcome.seen[:, -1:]
    speed = joint_speed(start, outcome.predicted)
    true_speed = joint_speed(start, outcome.true)
    at = {ms: float(outcome.errors[f]) for ms, f in zip(*_horizons(protocol), strict=True)}
    return {
        "mpjpe": at,
        "mpjs_mm": float(speed.mean()),
        "true_mpjs_mm": float(true_speed.mean()),
        "mpjs_error": float(np.abs(speed - true_speed).mean()),
        "jump_mm": float(speed[0]),
        "true_jump_mm": float(true_speed[0]),
        "bone_error_mm": bone_error(outcome.predicted, outcome.true, protocol.layout.bones),
    }


def evaluate(
    model: Forecaster, protocol: Protocol, windows_by_action: dict[str, Float32]
) -> dict[str, Any]:
    """Measure a model on the windows of a protocol, see ``summary``."""
    return summary(model, protocol, outcomes(model, protocol, windows_by_action))


def summary(model: Forecaster, protocol: Protocol, results: dict[str, Outcome]) -> dict[str, Any]:
    """``average`` over the actions, ``actions`` by name, ``parameters``, ``ms_per_window``."""
    actions = action_figures(protocol, results)
    return {
        "model": model.name,
        "protocol": protocol.name,
        "metric": protocol.metric,
        "windows": sum(len(outcome.seen) for outcome in results.values()),
        "average": average(actions),
        "actions": {action: _rounded(row) for action, row in actions.items()},
        "parameters": model.parameters,
        "ms_per_window": model.window_ms(),
    }


def action_figures(protocol: Protocol, results: dict[str, Outcome]) -> dict[str, dict[str, Any]]:
    """The figures of each action, unrounded."""
    return {action: figures(outcome, protocol) for action, outcome in results.items()}


def average(actions: dict[str, dict[str, Any]]) -> dict[str, Any]:
    """The mean of all actions' figures, which count alike, rounded."""
    return _rounded(_mean(list(actions.values())))


def gain_percent(errors: dict[str, float], baseline: dict[str, float]) -> dict[str, float]:
    """By how many percent errors are under those of a baseline, at each horizon."""
    return {ms: round(100 * (1 - error / baseline[ms]), 1) for ms, error in errors.items()}


def _horizons(protocol: Protocol) -> tuple[list[str], list[int]]:
    return [str(ms) for ms in protocol.horizons_ms], protocol.frames


def _mean(rows: list[dict[str, Any]]) -> dict[str, Any]:
    return {
        key: _mean([row[key] for row in rows])
        if isinstance(rows[0][key], dict)
        else sum(row[key] for row in rows) / len(rows)
        for key in rows[0]
    }


def _rounded(row: dict[str, Any]) -> dict[str, Any]:
    return {
        key: _rounded(value) if isinstance(value, dict) else round(value, 2)
        for key, value in row.items()
    }
