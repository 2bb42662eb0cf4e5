"""How good several drawn futures are: near the truth, apart from each other, whole at the seam."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch

from agent_server.domain.arrays import Float32
from agent_server.errors import BundleError
from agent_server.inference.manifest import MODEL_FILE, read_manifest
from models.hp_gan.judge import JUDGED_REAL
from models.hp_gan.sampler import Sampler
from models.ops.session import open_session

MM = 1000.0
CHUNK = 256


@dataclass(frozen=True, slots=True)
class Drawn:
    """Several futures of some windows.

    Attributes:
        futures: Shape (N, K, F, J, 3), metres.
        quality: Shape (N, K), in [0, 1].
    """

    futures: Float32
    quality: Float32


Draw = Callable[[Float32, int], Drawn]
"""Seen (N, 25, 9, 3) and K -> K futures of each."""
Run = Callable[[Float32, Any], list[Float32]]
"""Seen (B, 25, 9, 3) and numbers of draws (B,) -> future (B, 50, 9, 3) and quality (B,)."""


def bundled_sampler(folder: Path) -> Draw:
    """The sampler of a bundle, as the server runs it.

    Raises:
        BundleError: If the bundle is not whole, or holds no sampler.
    """
    manifest = read_manifest(folder)
    if manifest.task != "sample":
        raise BundleError(f"{folder} holds no sampler but a model that can {manifest.task}")
    return _in_chunks(bundled_session(folder))


def bundled_session(folder: Path) -> Run:
    """The model in a folder, as a function of seen windows and numbers of draws."""
    session = open_session(folder / MODEL_FILE)

    def run(seen: Float32, draw: Any) -> list[Float32]:
        results: list[Float32] = session.run(["future", "quality"], {"seen": seen, "draw": draw})
        return results

    return run


def trained_sampler(network: Sampler) -> Draw:
    """A sampler of torch."""

    @torch.no_grad()
    def run(seen: Float32, draw: Any) -> list[Float32]:
        given = torch.from_numpy(seen), torch.from_numpy(draw)
        return [part.numpy() for part in network(*given)]

    return _in_chunks(run)


def _in_chunks(run: Run) -> Draw:
    def draw(seen: Float32, count: int) -> Drawn:
        rows, numbers = seen.repeat(count, axis=0), np.tile(np.arange(count), len(seen))
        parts = [
            run(rows[at : at + CHUNK], numbers[at : at + CHUNK])
            for at in range(0, len(rows), CHUNK)
        ]
        future, quality = (np.concatenate(part) for part in zip(*parts, strict=True))
        return Drawn(
            future.reshape(len(seen), count, *future.shape[1:]), quality.reshape(-1, count)
        )

    return draw


def drawn_figures(drawn: Drawn, seen: Float32, true: Float32) -> dict[str, float]:
    """Figures over all windows, mean over joints and time, in mm.

    ``seam_mm`` is how far the first step is from the last seen one, ``jump_mm`` how long it is;
    ``true_`` stands before what the truth does. ``plausible`` is the share of futures that are
    judged real.

    Args:
        drawn: Futures of the windows, two or more of each.
        seen: Shape (N, 25, 9, 3), metres.
        true: Shape (N, 50, 9, 3), metres.
    """
    off = np.linalg.norm(drawn.futures - true[:, None], axis=-1).mean(axis=(2, 3))  # (N, K)
    pairs = np.linalg.norm(np.diff(drawn.futures, axis=1), axis=-1)
    seams = _seams(seen[:, None], drawn.futures)
    true_seams = _seams(seen[:, None], true[:, None])
    return {
        "windows": len(seen),
        "error_mm": _mm(off),
        "best_mm": _mm(off.min(axis=1)),
        "mean_mm": _mm(np.linalg.norm(drawn.futures.mean(axis=1) - true, axis=-1)),
        "still_mm": _mm(np.linalg.norm(seen[:, -1:] - true, axis=-1)),
        "apart_mm": _mm(pairs),
        "jump_mm": _mm(seams[0]),
        "true_jump_mm": _mm(true_seams[0]),
        "seam_mm": _mm(seams[1]),
        "true_seam_mm": _mm(true_seams[1]),
        "plausible": round(float((drawn.quality > JUDGED_REAL).mean()), 4),
    }


def _seams(seen: Float32, futures: Float32) -> tuple[Float32, Float32]:
    """Lengths of the first steps, and of their difference from the last seen ones."""
    first, last = futures[:, :, 0] - seen[:, :, -1], seen[:, :, -1] - seen[:, :, -2]
    return np.linalg.norm(first, axis=-1), np.linalg.norm(first - last, axis=-1)


def _mm(metres: Float32) -> float:
    return round(MM * float(metres.mean()), 2)
