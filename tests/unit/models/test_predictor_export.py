"""A predictor from its training to a bundle that anybody can measure."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")
pytest.importorskip("onnxscript", reason="needs the train extra")

from typer.testing import CliRunner  # noqa: E402

from agent_server.errors import ConfigError  # noqa: E402
from agent_server.inference.manifest import read_manifest  # noqa: E402
from models.__main__ import app  # noqa: E402
from models.data.layouts import H36M  # noqa: E402
from models.evaluation.futures import futures_figures  # noqa: E402
from models.evaluation.recursion import recursion_errors  # noqa: E402
from models.export.predictor import export_predictor  # noqa: E402
from models.ma_wgan.config import BEST, TrainConfig  # noqa: E402
from models.ma_wgan.network import Averaged  # noqa: E402
from models.ma_wgan.train import load_predictor, load_trained, train  # noqa: E402
from models.training.run import Run  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore")  # the exporter's own deprecations

TINY = replace(
    BEST,
    network=replace(BEST.network, seen=10, channels=16, blocks=1, critic_channels=8, noise=4),
    steps=4,
    batch=8,
    validate_every=2,
)


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Human3.6M's layout with people whose every joint swings."""
    folder = tmp_path_factory.mktemp("data")
    (folder / "h36m").mkdir()
    rng = np.random.default_rng(0)
    time = np.arange(260)[:, None, None] / 25
    arrays = {}
    for key in ("S1__walking_1", "S11__walking_1", "S5__walking_1", "S5__walking_2"):
        phase, pose = rng.uniform(0, 6, (1, 32, 3)), rng.uniform(-5000, 5000, (1, 32, 3))
        arrays[key] = (pose + 800 * np.sin(5 * time + phase)).astype(np.int16)
    np.savez(folder / "h36m" / "h36m_25fps.npz", **arrays)
    return folder


def trained(folder: Path, data: Path, config: TrainConfig = TINY, seed: int = 0) -> Path:
    command = f"python -m models train ma_wgan --config tiny --data DIR --out RUN --seed {seed}"
    train(config, Run(folder, config, seed, command, resume=False), data, data)
    return folder


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory, data: Path) -> list[Path]:
    folder = tmp_path_factory.mktemp("runs")
    return [trained(folder / str(seed), data, seed=seed) for seed in (0, 1)]


def test_two_runs_become_one_bundle_that_the_command_line_measures(
    runs: list[Path], data: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "tiny_h36m"
    export_predictor("ma_wgan", runs, folder, "0.0.1", data, data)
    manifest = read_manifest(folder)
    assert (manifest.skeleton, manifest.normaliser) == ("h36m22", "root")
    assert (manifest.input_frames, manifest.output_frames) == (10, 25)
    assert manifest.licence.startswith("research only")
    assert "--seed 0" in manifest.training.command
    assert "--seed 1" in manifest.training.command
    card = (folder / "CARD.md").read_text()
    assert "Research only" in card
    assert f"{manifest.results['h36m-256']['average']['mpjpe']['80']:.1f}" in card
    words = ["evaluate", "prediction", "--bundle", folder, "--protocol", "h36m-256"]
    result = CliRunner().invoke(app, [*map(str, words), "--data", str(data), "--json"])
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)["average"]["mpjpe"]
    assert found == pytest.approx(manifest.results["h36m-256"]["average"]["mpjpe"], abs=0.02)


def test_runs_of_two_kinds_are_not_averaged(runs: list[Path], data: Path, tmp_path: Path) -> None:
    other = replace(TINY, network=replace(TINY.network, seen=15))
    longer = trained(tmp_path / "longer", data, other)
    with pytest.raises(ConfigError, match="10 frames seen, another on h36m with 15"):
        export_predictor("ma_wgan", [runs[0], longer], tmp_path / "x", "0", data, data)


def test_an_average_lies_in_the_middle(runs: list[Path]) -> None:
    networks = [load_trained(run, H36M) for run in runs]
    seen = torch.randn(2, 10, 22, 3, generator=torch.Generator().manual_seed(0))
    middle = Averaged(networks)(seen)
    torch.testing.assert_close(middle, (networks[0](seen) + networks[1](seen)) / 2)


def test_recursion_is_set_beside_standing_still(runs: list[Path], data: Path) -> None:
    def still(seen: torch.Tensor) -> torch.Tensor:
        return seen[:, -1:].expand(-1, 25, -1, -1)

    rows = recursion_errors(still, 10, data)
    assert rows["mpjpe"] == rows["zero_velocity"]
    assert list(rows["mpjpe"]) == ["1000", "2000", "3000", "4000"]
    assert recursion_errors(load_predictor(runs[0]), 10, data)["mpjpe"] != rows["mpjpe"]


def test_the_best_of_ten_futures_is_no_worse_than_a_typical_one(runs: list[Path]) -> None:
    rng = np.random.default_rng(0)
    windows = {"walking": (1000 * rng.standard_normal((16, 35, 32, 3))).astype(np.float32)}
    figures = futures_figures(load_predictor(runs[0]), windows, H36M.joints, seed=0)
    assert figures == futures_figures(load_predictor(runs[0]), windows, H36M.joints, seed=0)
    assert figures["apart_mm"] > 0
    assert figures["best_of_10_mm"] < figures["expected_mm"] + figures["apart_mm"]
