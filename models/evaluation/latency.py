"""How long a model takes for one window, on one thread."""

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import torch

from agent_server.domain.arrays import Float32
from agent_server.inference.manifest import GOLDEN_FILE, MODEL_FILE, read_manifest
from models.data.interactions import JOINTS
from models.interformer.generator.generate import Core, generate
from models.interformer.generator.onnx_core import OnnxCore
from models.ops.session import OnnxModel


def latency_ms(model: OnnxModel, window: Float32, repeats: int = 500) -> dict[str, float]:
    """p50 and p95 in milliseconds for a batch of one, after a warm-up.

    Args:
        model: What to time.
        window: Shape (1, frames, 9, 3).
        repeats: How often.
    """
    return percentiles_ms(lambda: model(window), repeats)


def percentiles_ms(
    call: Callable[[], object], repeats: int = 500, warm_up: int = 50
) -> dict[str, float]:
    """p50 and p95 in milliseconds of anything, after ``warm_up`` calls."""
    for _ in range(warm_up):
        call()
    times = np.empty(repeats)
    for i in range(repeats):
        began = time.perf_counter_ns()
        call()
        times[i] = time.perf_counter_ns() - began
    p50, p95 = np.percentile(times, [50, 95]) / 1e6
    return {"p50_ms": round(float(p50), 3), "p95_ms": round(float(p95), 3)}


def reaction_latency(core: Core, latent: int, frames: int) -> dict[str, float]:
    """p50 and p95 in milliseconds a frame, of 50 whole reactions of ``frames`` frames.

    Reading the action is part of it.
    """
    action = 0.1 * torch.randn(1, frames, JOINTS, 3, generator=torch.Generator().manual_seed(0))
    lengths, noise = torch.tensor([frames]), torch.zeros(1, latent)
    times = np.empty(50)
    for at in range(-5, len(times)):
        began = time.perf_counter_ns()
        generate(core, action, lengths, action[:, :1], noise, frames, stops=False)
        if at >= 0:
            times[at] = (time.perf_counter_ns() - began) / frames
    p50, p95 = np.percentile(times, [50, 95]) / 1e6
    return {"p50_ms": round(float(p50), 3), "p95_ms": round(float(p95), 3)}


def reaction_bundle_latency(folder: Path) -> dict[str, float]:
    """The same for a bundle."""
    core, manifest = OnnxCore.of(folder)
    return reaction_latency(core, manifest.latent, manifest.frames)


def bundle_latency(folder: Path) -> dict[str, float]:
    """The same for a bundle, on its first golden window."""
    manifest = read_manifest(folder)
    name = "seen" if manifest.task == "predict" else "motion"
    with np.load(folder / GOLDEN_FILE) as golden:
        window = golden[name][:1]
    return latency_ms(OnnxModel(folder / MODEL_FILE), window)
