"""The bundles that ship: whole, small, honest about their bits, and steady."""

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="models/export needs the train extra")

from agent_server.domain.gesture import GESTURES
from agent_server.inference.manifest import (
    GOLDEN_FILE,
    MODEL_FILE,
    MotionManifest,
    read_manifest,
)
from agent_server.inference.runtime import OnnxSampler
from models.export.onnx import is_batch_exact
from models.ops.session import OnnxModel

ARTIFACTS = Path(__file__).parents[2] / "models" / "artifacts"
PREDICTOR, CLASSIFIER = "ma_wgan_server", "interformer_server"


def load(name: str) -> tuple[MotionManifest, OnnxModel, np.ndarray, np.ndarray]:
    folder = ARTIFACTS / name
    manifest = read_manifest(folder)
    with np.load(folder / GOLDEN_FILE) as golden:
        inputs, outputs = (golden[key] for key in golden.files)
    return manifest, OnnxModel(folder / MODEL_FILE), inputs, outputs


@pytest.mark.parametrize("name", [PREDICTOR, CLASSIFIER])
def test_goldens_come_out_again(name: str) -> None:
    manifest, model, inputs, outputs = load(name)
    assert inputs.shape[1:] == (manifest.input_frames, 9, 3)
    np.testing.assert_allclose(model(inputs), outputs, atol=1e-4)
    assert manifest.parameters <= 3_000_000


@pytest.mark.parametrize("name", [PREDICTOR, CLASSIFIER])
def test_the_manifest_tells_the_truth_about_bits(name: str) -> None:
    manifest, model, inputs, _ = load(name)
    rng = np.random.default_rng(0)
    rows = np.concatenate([inputs] * 3)[:16]
    noise = rng.standard_normal(rows.shape).astype(np.float32)
    assert not manifest.batch_exact or is_batch_exact(model, rows + 0.01 * noise)


@pytest.mark.parametrize("name", [PREDICTOR, CLASSIFIER])
def test_the_card_names_its_data_and_yardstick(name: str) -> None:
    card = (ARTIFACTS / name / "CARD.md").read_text()
    assert "synthetic: synthetic" in card
    assert "free for all uses" in card
    assert ("zero velocity" if name == PREDICTOR else "last frame repeated") in card


def test_a_body_that_stands_still_is_predicted_to_stay() -> None:
    _, model, seen, _ = load(PREDICTOR)
    still = np.repeat(seen[:, -1:], 25, axis=1)
    future = model(still)
    moved = np.linalg.norm(future - still[:, -1:], axis=-1)
    assert np.isfinite(moved).all()
    assert moved.max() < 0.005  # metres
    assert np.isfinite(model(np.zeros((1, 25, 9, 3), dtype=np.float32))).all()


def test_the_future_follows_on_from_the_last_seen_pose() -> None:
    _, model, seen, _ = load(PREDICTOR)
    step = np.linalg.norm(model(seen)[:, 0] - seen[:, -1], axis=-1)
    last = np.linalg.norm(seen[:, -1] - seen[:, -2], axis=-1)
    assert step.mean() < 2 * last.mean() + 0.01


def test_the_sampler_ships_with_its_judge_and_gives_its_goldens_again() -> None:
    folder = ARTIFACTS / "sampler_server"
    sampler = OnnxSampler(folder, 15)
    with np.load(folder / GOLDEN_FILE) as golden:
        for seen, draw, future, quality in zip(
            *(golden[name] for name in ("seen", "draw", "future", "quality")), strict=True
        ):
            futures, qualities = sampler.draw(seen, int(draw) + 1)
            np.testing.assert_allclose(futures[draw], future, atol=1e-4)
            np.testing.assert_allclose(qualities[draw], quality, atol=1e-4)
            again, same = sampler.draw(seen, int(draw) + 1)
            assert again.tobytes() == futures.tobytes()
            assert same.tobytes() == qualities.tobytes()
    card = (folder / "CARD.md").read_text()
    assert "synthetic: synthetic" in card
    assert "free for all uses" in card
    assert "of the last pose repeated" in card


def test_probabilities_are_probabilities() -> None:
    manifest, model, motion, _ = load(CLASSIFIER)
    rows = model(motion)
    np.testing.assert_allclose(rows.sum(-1), 1.0, atol=1e-5)
    assert (rows >= 0).all()
    assert manifest.labels == list(GESTURES)
