"""From a training run to the bundle of a generator of reactions, and of who judges them."""

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch.export import Dim

from agent_server.domain.arrays import Float32
from agent_server.inference.manifest import (
    FORMAT_VERSION,
    GOLDEN_FILE,
    MODEL_FILE,
    DataSource,
    ReactionManifest,
)
from agent_server.inference.reactor import QUALITY_FILE
from models.data.interactions import INTERACTION_SETS, JOINTS, LICENCE, Pairs
from models.evaluation.interaction import DRAWS, JUDGES, Court, React, as_long, stand_still
from models.evaluation.interaction_rows import reacting
from models.evaluation.latency import reaction_latency
from models.evaluation.reaction_quality import quality_report
from models.export.bundle import RESEARCH_LICENCE
from models.export.onnx import (
    OPSET,
    require_close,
    round_weights,
    store_halves,
    write_graph,
)
from models.export.publish import publish, training_of
from models.export.reaction_card import reaction_card
from models.export.reaction_range import training_range
from models.interformer.generator.generate import Encode, Step, TorchCore, generate
from models.interformer.generator.network import Generator
from models.interformer.generator.onnx_core import (
    ENCODE_INPUTS,
    ENCODER_FILE,
    STEP_INPUTS,
    OnnxCore,
)
from models.interformer.generator.train import load_generator
from models.interformer.quality.network import Quality, QualityStep
from models.interformer.quality.train import train_quality
from models.training.run import read_info

GOLDEN_ROWS = 4
GOLDEN_FRAMES = 20
QUALITY_SEED = 0


def export_reaction(
    run: Path, folder: Path, version: str, data: Path, runs: Path
) -> ReactionManifest:
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
    network, info = load_generator(run), read_info(run)
    config, spec = network.config, INTERACTION_SETS[info["config"]["data"]]
    court = Court.thesis(spec, data, runs)
    round_weights(network)
    with tempfile.TemporaryDirectory() as scratch:
        draft = Path(scratch) / folder.name
        draft.mkdir()
        write_graphs(network, draft)
        core = OnnxCore(draft / ENCODER_FILE, draft / MODEL_FILE)
        golden = golden_input(config.latent)
        results: dict[str, Any] = {
            "test_interactions": len(court.test),
            "judges": JUDGES,
            "draws": DRAWS,
            "reactions": court.measure(reacting(core, config.latent, config.frames)),
            "real": court.real(),
            "zero_velocity": court.measure(stand_still),
            "latency": reaction_latency(core, config.latent, config.frames),
            "onnx_difference_m": check_parity(network, core, golden),
        }
        reaction, _ = generate(core, *golden, GOLDEN_FRAMES, stops=False)
        training = spec.read(data, "train")
        judge = train_quality(spec, Pairs.of(training, spec.labels), QUALITY_SEED)
        write_quality(judge, draft / QUALITY_FILE)
        results["quality"] = measure_quality(
            judge, court, reacting(core, config.latent, config.frames)
        )
        names = ("action", "lengths", "given", "noise")
        arrays: dict[str, Any] = dict(zip(names, (part.numpy() for part in golden), strict=True))
        arrays |= {"reaction": reaction.numpy(), "quality": qualities(judge, golden[0], reaction)}
        np.savez_compressed(draft / GOLDEN_FILE, **arrays)
        manifest = ReactionManifest(
            format_version=FORMAT_VERSION,
            name=folder.name,
            version=version,
            task="react",
            skeleton="kinect15",
            rate_hz=spec.rate_hz,
            frames=config.frames,
            latent=config.latent,
            labels=list(spec.labels),
            opset=OPSET,
            parameters=sum(p.numel() for p in network.parameters()),
            batch_exact=False,
            files={ENCODER_FILE: "", QUALITY_FILE: ""},
            licence=RESEARCH_LICENCE,
            training=training_of(info, [DataSource(spec.name, LICENCE, synthetic=False)]),
            results=results,
            range=training_range(training, spec.rate_hz),
        )
        return publish(draft, folder, manifest, reaction_card(manifest))


def write_graphs(network: Generator, folder: Path) -> None:
    """Export the encoder and one step of the decoder; batch, action and past may be of any size."""
    config = network.config
    count, frames, written = 3, 9, 5
    batch = Dim("batch", min=1, max=1024)
    action_frames = Dim("action_frames", min=1, max=config.frames)
    past_frames = Dim("past_frames", min=0, max=config.frames)
    action = torch.randn(count, frames, JOINTS, 3)
    lengths = torch.tensor([9, 7, 5])
    encode, step = Encode(network).eval(), Step(network).eval()
    write_graph(
        encode,
        (action, lengths),
        folder / ENCODER_FILE,
        ENCODE_INPUTS,
        ("tokens", "bias", "seen", "kind"),
        ({0: batch, 1: action_frames}, {0: batch}),
    )
    with torch.no_grad():
        read = encode(action, lengths)
    poses = action[:, :3].unbind(1)
    write_graph(
        step,
        (
            *poses,
            torch.tensor([written]),
            torch.randn(count, config.latent),
            read.kind,
            torch.randn(*read.seen.shape[:4], written, read.seen.shape[5]),
            action[:, 0],
            read.tokens[:, 0],
            read.bias,
            read.seen,
        ),
        folder / MODEL_FILE,
        STEP_INPUTS,
        ("next_pose", "stop", "new_past"),
        (
            *({0: batch}, {0: batch}, {0: batch}, {}, {0: batch}, {0: batch}),
            {2: batch, 4: past_frames},
            *({0: batch}, {0: batch}),
            {0: batch, 3: action_frames},
            {2: batch, 4: action_frames},
        ),
    )
    for file in (ENCODER_FILE, MODEL_FILE):
        store_halves(folder / file)


def write_quality(network: Quality, path: Path) -> None:
    """Export one step of the quality network."""
    given = (torch.randn(1, 2 * JOINTS, 3) for _ in range(3))
    write_graph(
        QualityStep(network).eval(),
        (*given, torch.zeros(1, network.width)),
        path,
        ("first", "before", "pair", "hidden"),
        ("logit", "new_hidden"),
        ({}, {}, {}, {}),
    )


@torch.no_grad()
def qualities(network: Quality, action: torch.Tensor, reaction: torch.Tensor) -> Float32:
    """What is held of reactions (B, T, 15, 3) up to each of their frames, (B, T)."""
    logits = network(action, reaction)
    so_far = logits.cumsum(1) / torch.arange(1, logits.shape[1] + 1)
    held: Float32 = torch.sigmoid(so_far).numpy()
    return held


def measure_quality(network: Quality, court: Court, react: React) -> dict[str, Any]:
    """The quality network on the test split: recorded reactions, this generator's, none."""
    test = court.test
    made = {
        "generated": as_long(react(test, 0)[0], test),
        "zero_velocity": stand_still(test, 0)[0],
    }
    return quality_report(network, test, made)


def check_parity(network: Generator, core: OnnxCore, given: tuple[torch.Tensor, ...]) -> float:
    """Largest difference of whole reactions by torch and ONNX, in metres.

    Raises:
        BundleError: If it is above 1e-4.
    """
    action, lengths, first, noise = given
    frames = action.shape[1]
    expected, found = (
        generate(each, action, lengths, first, noise, frames, stops=False)[0]
        for each in (TorchCore(network), core)
    )
    worst = float((expected - found).abs().max())
    return require_close(worst, " m")


def golden_input(
    latent: int, seed: int = 0
) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor, torch.Tensor]:
    """Made-up actions of several lengths, first poses and noise: nobody's motion."""
    generator = torch.Generator().manual_seed(seed)
    bodies = 0.5 * torch.randn(2, GOLDEN_ROWS, 1, JOINTS, 3, generator=generator)
    steps = 0.02 * torch.randn(GOLDEN_ROWS, GOLDEN_FRAMES, JOINTS, 3, generator=generator)
    lengths = torch.tensor([GOLDEN_FRAMES, 15, 10, 5])
    noise = torch.randn(GOLDEN_ROWS, latent, generator=generator)
    return bodies[0] + steps.cumsum(1), lengths, bodies[1], noise
