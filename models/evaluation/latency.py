"""How long a model takes for one window, on one thread."""

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.inference.manifest import GOLDEN_FILE, MODEL_FILE, read_manifest
from models.ops.session import OnnxModel


def latency_ms(model: OnnxModel, window: Float32, repeats: int = 500) -> dict[str, float]:
    """p50 and p95 in milliseconds for a batch of one, after a warm-up.

    Args:
        model: What to time.
        window: Shape (1, frames, 9, 3).
        repeats: How often.
    """
    return percentiles_ms(lambda: model(window), repeats)


def percentiles_ms(call: Callable[[], object], repeats: int = 500) -> dict[str, float]:
    """p50 and p95 in milliseconds of anything, after a warm-up."""
    for _ in range(50):
        call()
    times = np.empty(repeats)
    for i in range(repeats):
        began = time.perf_counter_ns()
        call()
        times[i] = time.perf_counter_ns() - began
    p50, p95 = np.percentile(times, [50, 95]) / 1e6
    return {"p50_ms": round(float(p50), 3), "p95_ms": round(float(p95), 3)}


def bundle_latency(folder: Path) -> dict[str, float]:
    """The same for a bundle, on its first golden window."""
    manifest = read_manifest(folder)
    name = "seen" if manifest.task == "predict" else "motion"
    with np.load(folder / GOLDEN_FILE) as golden:
        window = golden[name][:1]
    return latency_ms(OnnxModel(folder / MODEL_FILE), window)
