"""How far predicted joints are from the true ones, beside standing still."""

from typing import Any

import numpy as np
import torch

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import FRAME_NS, SEEN_FRAMES
from agent_server.domain.skeleton import CORE_BONES
from models.data.windows import WindowSet
from models.export.session import OnnxModel

HORIZONS_MS = (80, 160, 320, 400, 560, 1000, 1500, 2000)


def horizon_errors(predicted: Float32, true: Float32) -> dict[str, float]:
    """Mean joint distance in mm at each horizon (MPJPE); both (N, 50, 9, 3), metres."""
    errors = 1000 * np.linalg.norm(predicted - true, axis=-1).mean(axis=(0, 2))
    return {str(ms): round(float(errors[ms * 1_000_000 // FRAME_NS - 1]), 2) for ms in HORIZONS_MS}


def mean_step(start: Float32, future: Float32) -> Float32:
    """Mean joint step in mm a frame, shape (50,): how fast the motion is at each frame."""
    steps = np.diff(future, axis=1, prepend=start)
    result: Float32 = 1000 * np.linalg.norm(steps, axis=-1).mean(axis=(0, 2))
    return result


def bone_error(predicted: Float32, seen: Float32) -> float:
    """Mean deviation of predicted bones from their last seen length, in mm."""
    parents, children = (list(ends) for ends in zip(*CORE_BONES, strict=True))

    def lengths(poses: Float32) -> Float32:
        bones: Float32 = np.linalg.norm(poses[..., children, :] - poses[..., parents, :], axis=-1)
        return bones

    return round(1000 * float(np.abs(lengths(predicted) - lengths(seen[:, -1:])).mean()), 2)


def evaluate_prediction(model: OnnxModel, windows: WindowSet) -> dict[str, Any]:
    """All figures of a predictor on held-out windows.

    Args:
        model: seen (B, 25, 9, 3) -> future (B, 50, 9, 3), normalised metres.
        windows: Errors are measured against the motion without sensor noise.
    """
    observed, clean = windows.frames(torch.arange(len(windows)))
    seen = observed[:, :SEEN_FRAMES].numpy()
    true = clean[:, SEEN_FRAMES:].numpy()
    start = seen[:, -1:]
    predicted = model.batched(seen)
    speed, true_speed = mean_step(start, predicted), mean_step(start, true)
    return {
        "windows": len(windows),
        "mpjpe": horizon_errors(predicted, true),
        "zero_velocity": horizon_errors(np.broadcast_to(start, true.shape), true),
        "mpjs_mm": round(float(speed.mean()), 2),
        "true_mpjs_mm": round(float(true_speed.mean()), 2),
        "mpjs_error_mm": round(float(np.abs(speed - true_speed).mean()), 2),
        "jump_mm": round(float(speed[0]), 2),
        "bone_error_mm": bone_error(predicted, seen),
    }
