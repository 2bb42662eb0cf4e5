"""From a training run to the bundle of a sampler."""

import tempfile
import warnings
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import PREDICTED_FRAMES, RATE_HZ, SEEN_FRAMES
from agent_server.inference.manifest import (
    FORMAT_VERSION,
    GOLDEN_FILE,
    MODEL_FILE,
    MotionManifest,
)
from models.evaluation.latency import percentiles_ms
from models.evaluation.protocols import protocol_named
from models.evaluation.sampled import (
    bundled_session,
    drawn_figures,
    trained_sampler,
)
from models.export.bundle import GOLDEN_ROWS, LICENCE, SERVER_SOURCES
from models.export.card import sampler_card
from models.export.onnx import OPSET, require_close, write_graph
from models.export.publish import publish, training_of
from models.hp_gan.judge import JUDGED_REAL
from models.hp_gan.sampler import DRAWS, Sampler, likely_vectors
from models.hp_gan.source import server_validation
from models.hp_gan.train import load_hp_gan
from models.ma_wgan.train import load_predictor
from models.training.run import read_best, read_info

MEASURED = {"server": "cmu", "server-synthetic": "synthetic"}
"""Protocol whose windows a sampler is measured on -> its name in the results."""
MEASURED_DRAWS = 4
CHECKED = 32
TIMED = (1, 4, 9)
"""Draws whose time is measured."""
MM = np.float32(1000)


def export_sampler(
    run: Path, other: Path | None, folder: Path, version: str, data: Path, cache: Path
) -> MotionManifest:
    """Write, check and measure the bundle of a run's best networks.

    Args:
        run: Folder of HP-GAN's run; its quality network judges.
        other: Run of a manifold-aware GAN with noise that draws in the generator's place, or None.
        folder: Folder of the bundle.
        version: Version of the model.
        data: Folder that holds the set folders.
        cache: Folder of generated recordings.

    Raises:
        BundleError: If ONNX does not compute what torch does.
    """
    info = read_info(other or run)
    generator, _, judge = load_hp_gan(run)
    drawing = generator if other is None else load_predictor(other)
    noise = drawing.config.noise
    asked = [held.seen for held in server_validation(data, cache).values()]
    network = Sampler(drawing, judge, likely_vectors(drawing, noise, judge, asked)).eval()
    windows = {
        name: _metres(protocol_named(protocol).windows(data, cache))
        for protocol, name in MEASURED.items()
    }
    motion = np.concatenate([part[:: len(part) // CHECKED] for part in windows.values()])
    checked = np.ascontiguousarray(motion[:, :SEEN_FRAMES])
    with tempfile.TemporaryDirectory() as scratch:
        draft = Path(scratch) / folder.name
        draft.mkdir()
        results = {
            **{name: _figures(network, part) for name, part in windows.items()},
            "onnx_difference": write_sampler(network, checked, draft),
            "latency": _latency(draft, checked[:1]),
            "update": read_best(other or run)["step"],
        }
        manifest = MotionManifest(
            format_version=FORMAT_VERSION,
            name=folder.name,
            version=version,
            task="sample",
            skeleton="core9",
            rate_hz=RATE_HZ,
            input_frames=SEEN_FRAMES,
            output_frames=PREDICTED_FRAMES,
            labels=[],
            normaliser="navel_last_seen",
            opset=OPSET,
            parameters=sum(p.numel() for p in network.parameters()),
            batch_exact=False,  # the server runs one window's draws at a time
            files={},
            licence=LICENCE,
            training=training_of(info, SERVER_SOURCES),
            results=results,
            draws=DRAWS,
        )
        return publish(draft, folder, manifest, sampler_card(manifest))


def write_sampler(network: Sampler, seen: Float32, folder: Path) -> float:
    """Write model and goldens; gives the largest difference to torch.

    Args:
        network: In evaluation mode.
        seen: Held-out windows (N, 25, 9, 3), metres.
        folder: Folder of the bundle.

    Raises:
        BundleError: If ONNX does not compute what torch does.
    """
    draw = np.arange(len(seen)) % DRAWS
    batch = torch.export.Dim("batch", min=1, max=4096)
    example = torch.from_numpy(seen[:2]), torch.from_numpy(draw[:2])
    path = folder / MODEL_FILE
    names = ["seen", "draw"], ["future", "quality"]
    with warnings.catch_warnings(category=UserWarning, action="ignore"):
        # That recurrent layers keep their weights in a list, and that both inputs share an axis.
        write_graph(network, example, path, *names, ({0: batch}, {0: batch}))
    run = bundled_session(folder)
    with torch.no_grad():
        expected = network(torch.from_numpy(seen), torch.from_numpy(draw))
    worst = max(
        float(np.abs(got - want.numpy()).max())
        for got, want in zip(run(seen, draw), expected, strict=True)
    )
    require_close(worst)
    still = np.repeat(seen[:1, :1], SEEN_FRAMES, axis=1)
    spread = np.linspace(0, len(seen) - 1, GOLDEN_ROWS - 1).astype(int)
    golden = np.concatenate([seen[spread], still])
    arrays: dict[str, Any] = {"seen": golden, "draw": draw[:GOLDEN_ROWS]}
    arrays |= zip(names[1], run(golden, draw[:GOLDEN_ROWS]), strict=True)
    np.savez_compressed(folder / GOLDEN_FILE, **arrays)
    return worst


def _latency(folder: Path, window: Float32) -> dict[str, Any]:
    """Times of one, four and nine draws of one window in one batch."""
    draw = bundled_session(folder)
    return {
        str(count): percentiles_ms(partial(draw, window.repeat(count, 0), np.arange(count)))
        for count in TIMED
    }


def _metres(windows: dict[str, Float32]) -> Float32:
    motion = np.concatenate(list(windows.values())) / MM
    return motion.astype(np.float32)


def _figures(network: Sampler, motion: Float32) -> dict[str, Any]:
    """Figures of the draws, and the judge's word on the true futures."""
    seen = np.ascontiguousarray(motion[:, :SEEN_FRAMES])
    true = np.ascontiguousarray(motion[:, SEEN_FRAMES:])
    drawn = trained_sampler(network)(seen, MEASURED_DRAWS)
    with torch.no_grad():
        real = network.judge.quality(torch.from_numpy(seen), torch.from_numpy(true))
    share = round(float((real > JUDGED_REAL).float().mean()), 4)
    return {**drawn_figures(drawn, seen, true), "real_plausible": share}
