"""Bundles: what ships runs as promised, and what was altered is refused."""

import json
import shutil

import msgspec
import numpy as np
import pytest

from agent_server import assets
from agent_server.config import FaceSettings, ModelSettings, Settings
from agent_server.domain.gesture import GESTURES
from agent_server.errors import BundleError, InferenceError
from agent_server.inference.manifest import read_manifest, write_manifest
from agent_server.inference.runtime import (
    OnnxAffect,
    OnnxClassifier,
    OnnxFaceNetwork,
    OnnxPredictor,
    OnnxSampler,
)
from agent_server.service.loading import (
    AFFECT_SOURCES,
    CLASSIFIER,
    DETECTOR,
    MESHES,
    PREDICTOR,
    SAMPLER,
    load_models,
)
from tests.support.bodies import core_joints


@pytest.fixture
def bundles(tmp_path):
    """A copy of the bundles that may be damaged."""
    shutil.copytree(assets.bundles(), tmp_path / "bundles")
    return tmp_path / "bundles"


def motions(count, frames):
    """Slowly waving bodies of a plausible size, normalised; shape (count, frames, 9, 3)."""
    rng = np.random.default_rng(5)
    pose = rng.normal(0, 0.3, (count, 1, 9, 3))
    phase = np.linspace(0, 6, frames)[None, :, None, None] + rng.uniform(0, 6, (count, 1, 9, 3))
    moving = pose + 0.1 * np.sin(phase)
    return (moving - moving[:, 24:25, 2:3]).astype(np.float32)


def test_what_ships_loads_and_gives_what_it_promises():
    models = load_models()
    future = models.predictor.predict(motions(3, 25))
    assert future.shape == (3, 50, 9, 3)
    probabilities = models.classifier.classify(motions(3, 75))
    assert probabilities.shape == (3, len(GESTURES))
    np.testing.assert_allclose(probabilities.sum(axis=1), 1.0, atol=1e-5)
    assert models.classifier.labels == GESTURES
    assert all(len(digest) == 12 for digest in models.hashes.values())


def test_a_sampler_is_loaded_on_request_alone():
    assert load_models().drawing is None
    drawing = load_models(Settings(models=ModelSettings(futures=4))).drawing
    assert (drawing.count, drawing.least_quality) == (4, 0.5)
    futures, quality = drawing.sampler.draw(motions(1, 25)[0], 3)
    assert futures.shape == (3, 50, 9, 3)
    assert ((quality >= 0) & (quality <= 1)).all()
    assert (futures[0] != futures[1]).any()


def test_a_sampler_that_holds_too_few_draws_is_refused():
    with pytest.raises(BundleError, match="can draw 16 futures, 17 are asked for"):
        OnnxSampler(assets.bundles() / SAMPLER, 17)
    with pytest.raises(BundleError, match="can predict, one that can sample"):
        OnnxSampler(assets.bundles() / PREDICTOR, 2)


@pytest.mark.parametrize(
    ("kind", "name", "run", "frames"),
    [
        (OnnxPredictor, PREDICTOR, "predict", 25),
        (OnnxClassifier, CLASSIFIER, "classify", 75),
    ],
)
def test_a_row_of_a_batch_has_the_bits_that_it_has_alone(kind, name, run, frames):
    model = kind(assets.bundles() / name)
    batch = motions(16, frames)
    together = getattr(model, run)(batch)
    for index in range(16):
        alone = getattr(model, run)(batch[index : index + 1])
        assert alone.tobytes() == together[index : index + 1].tobytes()


def test_a_body_that_stands_still_is_predicted_to_stay_almost_where_it_is():
    standing, waiting = core_joints()[:, :3], core_joints(hands_up=True)[:, :3]
    poses = np.stack([standing, waiting]) - standing[2]
    still = np.repeat(poses[:, None], 25, axis=1)
    future = load_models().predictor.predict(still)
    assert np.isfinite(future).all()
    moved = np.linalg.norm(future - still[:, 24:25], axis=-1).mean(axis=(1, 2))
    # Arms that hang may hang on; hands held up will come down at some time.
    assert moved[0] < 0.03
    assert moved[1] < 0.15


def test_the_forecast_goes_on_from_the_last_seen_pose_without_a_jump():
    seen = motions(8, 25)
    future = load_models().predictor.predict(seen)
    jump = np.linalg.norm(future[:, 0] - seen[:, -1], axis=-1).mean()
    step = np.linalg.norm(np.diff(seen, axis=1), axis=-1).mean()
    assert jump < 3 * step


@pytest.mark.parametrize("name", ["model.onnx", "golden.npz", "CARD.md"])
def test_an_altered_file_is_refused(bundles, name):
    path = bundles / PREDICTOR / name
    path.write_bytes(path.read_bytes() + b" ")
    with pytest.raises(BundleError, match="altered"):
        OnnxPredictor(bundles / PREDICTOR)


def test_a_missing_file_is_refused_by_name(bundles):
    (bundles / PREDICTOR / "golden.npz").unlink()
    with pytest.raises(BundleError, match=r"golden\.npz is missing"):
        OnnxPredictor(bundles / PREDICTOR)
    with pytest.raises(BundleError, match=r"no manifest\.json"):
        OnnxPredictor(bundles / "nothing")


def test_a_bundle_under_another_name_is_refused(bundles):
    (bundles / PREDICTOR).rename(bundles / "other")
    with pytest.raises(BundleError, match=f"manifest of '{PREDICTOR}'"):
        OnnxPredictor(bundles / "other")


def test_what_ships_has_the_names_that_the_server_asks_for():
    faces = {DETECTOR, MESHES["full"]} | {f"affect_{source}" for source in AFFECT_SOURCES}
    assert set(load_models().hashes) == {PREDICTOR, CLASSIFIER} | faces
    fast = load_models(Settings(face=FaceSettings(mesh="fast"))).hashes
    assert MESHES["fast"] in fast and MESHES["full"] not in fast


def test_a_model_that_is_none_is_refused(bundles):
    folder = bundles / PREDICTOR
    manifest = read_manifest(folder)
    (folder / "model.onnx").write_bytes(b"not a model")
    write_manifest(folder, manifest)
    with pytest.raises(BundleError, match="cannot be loaded"):
        OnnxPredictor(folder)


def test_a_model_that_does_not_give_its_golden_output_is_refused(bundles):
    folder = bundles / PREDICTOR
    manifest = read_manifest(folder)
    with np.load(folder / "golden.npz") as golden:
        arrays = dict(golden)
    arrays["future"] = arrays["future"] + 0.01
    np.savez(folder / "golden.npz", **arrays)
    write_manifest(folder, manifest)
    with pytest.raises(BundleError, match="golden output"):
        OnnxPredictor(folder)
    np.savez(folder / "golden.npz", seen=arrays["seen"])
    write_manifest(folder, manifest)
    with pytest.raises(BundleError, match="cannot be read"):
        OnnxPredictor(folder)


def test_a_manifest_that_does_not_fit_is_refused(bundles):
    folder = bundles / PREDICTOR
    manifest = read_manifest(folder)
    with pytest.raises(BundleError, match="can predict"):
        OnnxClassifier(folder)
    write_manifest(folder, msgspec.structs.replace(manifest, input_frames=10))
    with pytest.raises(BundleError, match="frames in and out"):
        OnnxPredictor(folder)
    write_manifest(folder, msgspec.structs.replace(manifest, format_version=9))
    with pytest.raises(BundleError, match="format version 9"):
        OnnxPredictor(folder)
    table = json.loads((folder / "manifest.json").read_text())
    (folder / "manifest.json").write_text(json.dumps({**table, "task": "juggle"}))
    with pytest.raises(BundleError, match="can juggle"):
        OnnxPredictor(folder)
    (folder / "manifest.json").write_text(json.dumps({**table, "rate_hz": "fast"}))
    with pytest.raises(BundleError, match="not a valid manifest"):
        OnnxPredictor(folder)


def test_a_bundle_of_another_kind_is_refused(bundles):
    with pytest.raises(BundleError, match="can face"):
        OnnxPredictor(bundles / DETECTOR)
    with pytest.raises(BundleError, match="for detector"):
        OnnxFaceNetwork(bundles / DETECTOR, "mesh")
    with pytest.raises(BundleError, match="reads affect from points68"):
        OnnxAffect(bundles / "affect_points68", "mesh")


def test_input_that_makes_no_sense_fails_as_inference():
    predictor = OnnxPredictor(assets.bundles() / PREDICTOR)
    with pytest.raises(InferenceError):
        predictor.predict(np.zeros((1, 3, 9, 3), np.float32))
    with pytest.raises(InferenceError, match="not finite"):
        predictor.predict(np.full((1, 25, 9, 3), np.nan, np.float32))
