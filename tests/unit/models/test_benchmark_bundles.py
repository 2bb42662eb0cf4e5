"""The research bundles that come with the project."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

import torch

from agent_server.errors import BundleError
from agent_server.inference.manifest import (
    GOLDEN_FILE,
    MODEL_FILE,
    MotionManifest,
    read_manifest,
    read_task,
)
from agent_server.inference.runtime import OnnxPredictor
from models.bigraphdiff.onnx_denoiser import INPUTS, read_generator
from models.evaluation.forecasters import BENCHMARKS
from models.interformer.generator.generate import generate
from models.interformer.generator.onnx_core import OnnxCore
from models.ops.session import OnnxModel

ROOT = Path(__file__).parents[3]
ALL = sorted(path.parent for path in (ROOT / BENCHMARKS).glob("*/manifest.json"))
BUNDLES = [folder for folder in ALL if read_task(folder) == "predict"]
REACTIONS = [folder for folder in ALL if read_task(folder) == "react"]
INTERACTIONS = [folder for folder in ALL if read_task(folder) == "interact"]
LIMIT_BYTES = 20_000_000
LATENCY_MS = 8.0
"""A frame of a reaction, as measured at export."""


def test_they_are_few_and_small() -> None:
    assert {"best_h36m", "simlpe_h36m"} <= {folder.name for folder in BUNDLES}
    size = sum(file.stat().st_size for file in (ROOT / BENCHMARKS).rglob("*") if file.is_file())
    assert size < LIMIT_BYTES


@pytest.mark.parametrize("folder", BUNDLES, ids=lambda folder: folder.name)
def test_each_is_whole_gives_its_golden_output_and_says_what_it_is_for(folder: Path) -> None:
    manifest = read_manifest(folder)
    model = OnnxModel(folder / MODEL_FILE)
    with np.load(folder / GOLDEN_FILE) as golden:
        np.testing.assert_allclose(model(golden["seen"]), golden["future"], atol=1e-4)
    trained_on = {source.name for source in manifest.training.data}
    research = manifest.licence.startswith("research only")
    assert research == ("h36m" in trained_on)
    card = (folder / "CARD.md").read_text()
    assert ("Research only" in card) == research


@pytest.mark.parametrize("folder", REACTIONS, ids=lambda folder: folder.name)
def test_generators_of_reactions_give_their_golden_output_and_are_for_research(
    folder: Path,
) -> None:
    core, manifest = OnnxCore.of(folder)
    with np.load(folder / GOLDEN_FILE) as golden:
        given = [torch.from_numpy(golden[name]) for name in ("action", "lengths", "given", "noise")]
        found, _ = generate(core, *given, golden["reaction"].shape[1], stops=False)
        np.testing.assert_allclose(found.numpy(), golden["reaction"], atol=1e-4)
    assert manifest.licence.startswith("research only")
    assert manifest.results["latency"]["p50_ms"] <= LATENCY_MS
    assert "Research only" in (folder / "CARD.md").read_text()
    with pytest.raises(BundleError, match="not a valid manifest"):
        read_manifest(folder, MotionManifest)  # what a server's models have


@pytest.mark.parametrize("folder", INTERACTIONS, ids=lambda folder: folder.name)
def test_generators_of_interactions_give_their_golden_output_and_are_for_research(
    folder: Path,
) -> None:
    generator, manifest = read_generator(folder)
    with np.load(folder / GOLDEN_FILE) as golden:
        found = generator.denoise(*(torch.from_numpy(golden[name]) for name in INPUTS))
        np.testing.assert_allclose(found.numpy(), golden["clean"], atol=1e-4)
    assert manifest.licence.startswith("research only")
    assert manifest.drawn_steps <= 50
    assert "Research only" in (folder / "CARD.md").read_text()
    with pytest.raises(BundleError, match="not a valid manifest"):
        read_manifest(folder, MotionManifest)


@pytest.mark.parametrize("name", ["best_h36m", "simlpe_h36m"])
def test_the_server_refuses_a_research_model(name: str) -> None:
    with pytest.raises(BundleError, match="research model of h36m22"):
        OnnxPredictor(ROOT / BENCHMARKS / name)
