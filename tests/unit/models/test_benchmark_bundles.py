"""The research bundles that come with the project."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from agent_server.errors import BundleError
from agent_server.inference.manifest import (
    GOLDEN_FILE,
    MODEL_FILE,
    read_manifest,
)
from agent_server.inference.runtime import OnnxPredictor
from models.evaluation.forecasters import BENCHMARKS
from models.ops.session import OnnxModel

ROOT = Path(__file__).parents[3]
BUNDLES = sorted(path.parent for path in (ROOT / BENCHMARKS).glob("*/manifest.json"))
LIMIT_BYTES = 20_000_000


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


@pytest.mark.parametrize("name", ["best_h36m", "simlpe_h36m"])
def test_the_server_refuses_a_research_model(name: str) -> None:
    with pytest.raises(BundleError, match="research model of h36m22"):
        OnnxPredictor(ROOT / BENCHMARKS / name)
