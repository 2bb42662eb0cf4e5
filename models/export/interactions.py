"""From a training run to the bundle of a generator of interactions: one step of the denoiser."""

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch.export import Dim

from agent_server.inference.manifest import (
    FORMAT_VERSION,
    GOLDEN_FILE,
    MODEL_FILE,
    DataSource,
)
from models.bigraphdiff.config import NetworkConfig
from models.bigraphdiff.diffusion import Denoise, Normaliser
from models.bigraphdiff.generate import Generator
from models.bigraphdiff.manifest import NORMALISER_FILE, InteractionManifest
from models.bigraphdiff.network import PEOPLE, Denoiser, to_draw_with
from models.bigraphdiff.onnx_denoiser import INPUTS, OUTPUT, open_denoiser
from models.bigraphdiff.train import load_denoiser
from models.bigraphdiff.words import tokens
from models.data.interaction_sets import two_person_set
from models.data.interactions import LICENCE, Pairs
from models.evaluation.interaction_pair_rows import interacting
from models.evaluation.interaction_pairs import PairCourt
from models.evaluation.latency import percentiles_ms
from models.export.bundle import RESEARCH_LICENCE
from models.export.interactions_card import interactions_card
from models.export.onnx import (
    OPSET,
    require_close,
    round_weights,
    store_halves,
    write_graph,
)
from models.export.publish import publish, training_of
from models.training.run import read_info

GOLDEN_ROWS = 4
GOLDEN_FRAMES = 20
TIMED_DRAWS = 10
SHARE = (0.1, 0.9)
"""Of the training interactions of a label, those that are shorter than its lengths."""


def export_interactions(
    run: Path, folder: Path, version: str, data: Path, runs: Path
) -> InteractionManifest:
    """Write, check and measure a bundle; nothing is left behind if a check fails.

    Args:
        run: Folder of the training run.
        folder: Folder of the bundle.
        version: Version of the model.
        data: Folder that holds the set folders.
        runs: Where the judges are kept.

    Raises:
        BundleError: If ONNX does not compute what torch does.
    """
    (network, normaliser), info = load_denoiser(run), read_info(run)
    config, spec = network.config, two_person_set(info["config"]["data"])
    round_weights(network)
    court = PairCourt.of(spec, data, runs)
    words = tokens(spec.labels)
    with tempfile.TemporaryDirectory() as scratch:
        draft = Path(scratch) / folder.name
        draft.mkdir()
        write_denoiser(network, draft / MODEL_FILE)
        write_normaliser(normaliser, draft / NORMALISER_FILE)
        denoise = open_denoiser(draft / MODEL_FILE)
        generator = Generator.of(denoise, normaliser, words, config)
        golden = golden_input(config, words)
        results: dict[str, Any] = {
            **court.setting(),
            "interactions": court.measure(interacting(generator)),
            "latency": draw_latency(generator, int(court.test.lengths.median())),
            "onnx_difference": check_parity(network, denoise, golden),
        }
        arrays: dict[str, Any] = dict(zip(INPUTS, (part.numpy() for part in golden), strict=True))
        np.savez_compressed(draft / GOLDEN_FILE, **arrays, clean=denoise(*golden).numpy())
        manifest = InteractionManifest(
            format_version=FORMAT_VERSION,
            name=folder.name,
            version=version,
            task="interact",
            skeleton="kinect15",
            rate_hz=spec.rate_hz,
            frames=config.frames,
            steps=config.steps,
            drawn_steps=generator.drawn_steps,
            labels=list(spec.labels),
            lengths=lengths_of(court.training, spec.labels),
            opset=OPSET,
            parameters=sum(p.numel() for p in network.parameters()),
            batch_exact=False,
            files={NORMALISER_FILE: ""},
            licence=RESEARCH_LICENCE,
            training=training_of(info, [DataSource(spec.name, LICENCE, synthetic=False)]),
            results=results,
        )
        return publish(draft, folder, manifest, interactions_card(manifest))


def write_denoiser(network: Denoiser, path: Path) -> None:
    """Export one step; batch and frames may be of any size, up to the longest piece.

    Args:
        network: With weights that were rounded, or the file has 32 bits a weight.
        path: The file.
    """
    config = network.config
    count, frames = 3, 9
    batch = Dim("batch", min=1, max=1024)
    length = Dim("frames", min=1, max=config.frames)
    write_graph(
        to_draw_with(network),
        (
            torch.randn(count, PEOPLE, frames, config.joints, 3),
            torch.tensor([9, 7, 5]),
            torch.tensor([999, 500, 0]).clamp(max=config.steps - 1),
            torch.ones(count, config.words, dtype=torch.int64),
        ),
        path,
        INPUTS,
        (OUTPUT,),
        ({0: batch, 2: length}, {0: batch}, {0: batch}, {0: batch}),
    )
    store_halves(path)


def write_normaliser(normaliser: Normaliser, path: Path) -> None:
    """Write how motions are scaled."""
    mean, deviation = normaliser.mean.numpy(), normaliser.deviation.numpy()
    np.savez_compressed(path, mean=mean, deviation=deviation)


def check_parity(network: Denoiser, denoise: Denoise, given: tuple[torch.Tensor, ...]) -> float:
    """Largest difference of one step by torch and ONNX, in normalised units.

    Raises:
        BundleError: If it is above 1e-4.
    """
    with torch.no_grad():
        expected = to_draw_with(network)(*given)
    noisy, lengths, step, words = given
    worst = float((expected - denoise(noisy, lengths, step, words)).abs().max())
    return require_close(worst)


def golden_input(
    config: NetworkConfig, words: torch.Tensor, seed: int = 0
) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor, torch.Tensor]:
    """Noise of several lengths at several steps: nobody's motion."""
    generator = torch.Generator().manual_seed(seed)
    shape = (GOLDEN_ROWS, PEOPLE, GOLDEN_FRAMES, config.joints, 3)
    last = config.steps - 1
    return (
        torch.randn(shape, generator=generator),
        torch.tensor([GOLDEN_FRAMES, 15, 10, 5]),
        torch.tensor([last, last // 2, last // 10, 0]),
        words[torch.arange(GOLDEN_ROWS) % len(words)],
    )


def lengths_of(training: Pairs, labels: tuple[str, ...]) -> dict[str, tuple[int, int]]:
    """Short and long interactions of each label, in frames."""
    found = {}
    for at, label in enumerate(labels):
        lengths = training.lengths[training.labels == at].double()
        low, high = (int(lengths.quantile(share).round()) for share in SHARE)
        found[label] = (low, high)
    return found


def draw_latency(generator: Generator, frames: int) -> dict[str, float]:
    """p50 and p95 in milliseconds of a whole interaction of so many frames."""
    label, length = torch.tensor([0]), torch.tensor([frames])
    white = torch.Generator().manual_seed(0)
    times = percentiles_ms(
        lambda: generator.interactions(label, length, white), TIMED_DRAWS, warm_up=2
    )
    return {**times, "frames": frames}
