"""``python -m models``: what a person types and gets."""

import json
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from typer.testing import CliRunner

from agent_server.errors import ConfigError
from models.__main__ import app
from models.ma_wgan.ablations import BASE, ROWS


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """Two takes of one action in which every joint moves 1 mm a frame."""
    (tmp_path / "h36m").mkdir()
    arrays = {}
    for subject, take in (("S5", 1), ("S5", 2), ("S1", 1)):
        positions = np.zeros((300, 32, 3), np.int16)
        positions[:, :, 0] = 10 * np.arange(300)[:, None]
        arrays[f"{subject}__walking_{take}"] = positions
    np.savez(tmp_path / "h36m" / "h36m_25fps.npz", **arrays)
    return tmp_path


def run(*words: object) -> dict[str, object]:
    result = CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    answer: dict[str, object] = json.loads(result.stdout)
    return answer


def test_the_figures_of_a_protocol_come_as_one_object(data: Path) -> None:
    answer = run(
        "evaluate", "prediction", "--model", "zero_velocity", "--protocol", "h36m-256",
        "--data", data, "--json",
    )  # fmt: skip
    assert list(answer["actions"]) == ["walking"]
    average = answer["average"]
    assert average["mpjpe"]["80"] == pytest.approx(2 * 28 / 32, abs=0.01)
    assert {"mpjs_error", "jump_mm", "bone_error_mm"} <= set(average)
    assert answer["parameters"] == 0
    assert answer["ms_per_window"] >= 0


def test_one_linear_map_goes_on_where_a_motion_is_linear(data: Path) -> None:
    answer = run(
        "evaluate", "prediction", "--model", "one_fc", "--protocol", "h36m-rms",
        "--data", data, "--json",
    )  # fmt: skip
    assert max(answer["average"]["mpjpe"].values()) < 0.5
    assert answer["parameters"] == 49 * 25


def test_a_page_beside_the_figures(data: Path, tmp_path: Path) -> None:
    run(
        "evaluate", "prediction", "--model", "zero_velocity", "--protocol", "h36m-rms",
        "--data", data, "--json", "--report", tmp_path / "report",
    )  # fmt: skip
    page = (tmp_path / "report" / "index.html").read_text()
    assert "zero_velocity" in page
    assert "one_fc" in page


@pytest.mark.parametrize(
    ("model", "protocol", "words"),
    [
        ("oracle", "h36m-256", "no bundle for protocol h36m-256.*zero_velocity, one_fc"),
        ("server", "h36m-256", "predicts 50 frames of core9.*25 of h36m22"),
        ("best", "h36m", "protocol 'h36m' is none of h36m-256"),
    ],
)
def test_what_does_not_fit_is_refused_in_words(
    data: Path, model: str, protocol: str, words: str
) -> None:
    with pytest.raises(ConfigError, match=words):
        run("evaluate", "prediction", "--model", model, "--protocol", protocol, "--data", data)


def test_each_ablation_changes_something_and_no_two_are_the_same() -> None:
    assert ROWS["all"] == BASE
    configs = list(ROWS.values())
    assert all(configs.count(config) == 1 for config in configs)
    assert len({config.steps * config.batch for config in configs}) == 1
