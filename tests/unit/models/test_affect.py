"""Affect models: readers, training, what ships, and how it is measured."""

import json
import subprocess
import sys

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")
pytest.importorskip("kornia", reason="needs the train extra")
import cv2  # noqa: E402

from agent_server import assets  # noqa: E402
from agent_server.errors import ConfigError, InvalidInput  # noqa: E402
from agent_server.inference.manifest import AffectManifest, read_manifest  # noqa: E402
from models.affect.config import SOURCES, AffectConfig, named  # noqa: E402
from models.affect.data import FaceFeatures, Mirror, features_of_clips  # noqa: E402
from models.affect.network import AffectNetwork  # noqa: E402
from models.affect.train import cross_validate, estimate, train, train_and_calibrate  # noqa: E402
from models.data.afew_va import read_afew_va  # noqa: E402
from models.data.labelled_faces import read_faces, test_split  # noqa: E402
from models.evaluation.affect import affect_measures, concordance, gate_rates  # noqa: E402
from models.evaluation.affect_baselines import affect_baselines  # noqa: E402
from tests.support.pictures import DATA, FACES, needs_faces  # noqa: E402

test_split.__test__ = False
SMALL = AffectConfig("mesh", hidden=(16, 8), members=2, epochs=60, batch=32, dropout=0.0)


def toy(count=240, views=2, size=6, seed=0):
    """Faces whose affect is a function of their features; the first is odd in a mirror."""
    rng = np.random.default_rng(seed)
    features = rng.normal(size=(count, 1, size)).repeat(views, 1).astype(np.float32)
    features += 0.05 * rng.normal(size=features.shape).astype(np.float32)
    affect = np.stack((np.tanh(features[:, 0, 1]), 0.5 * np.sin(features[:, 0, 2])), axis=1)
    signs = np.ones(size, np.float32)
    signs[0] = -1
    return FaceFeatures(
        features,
        np.ones((count, views), bool),
        (0.6 * affect).astype(np.float32),
        np.arange(count) // 3,
        Mirror(np.arange(size), signs),
    )


def test_a_network_learns_and_knows_how_well():
    faces = toy()
    network, validated, _ = train_and_calibrate(SMALL, faces, 4, 0)
    measures = affect_measures(validated.estimates, validated.affect)
    assert measures["valence"]["ccc"] > 0.85
    assert measures["arousal"]["ccc"] > 0.85
    for name in ("valence", "arousal"):
        assert 0.5 < measures["calibration"][name]["within_1_sd"] < 0.97
    new = toy(seed=1)
    seen = estimate(network, new.features[:, 0])
    assert concordance(seen[:, 0], new.affect[:, 0]) > 0.85


def test_a_mirrored_face_is_read_alike():
    faces = toy()
    network = train(SMALL, faces, 0)
    features = faces.features[:20, 0]
    mirrored = features[:, faces.mirror.order] * faces.mirror.signs
    np.testing.assert_allclose(estimate(network, features), estimate(network, mirrored), atol=1e-6)


def test_no_face_makes_the_network_overflow():
    network = train(SMALL, toy(), 0)
    wild = np.array([[1e9] * 6, [-1e9] * 6, [0] * 6], np.float32)
    seen = estimate(network, wild)
    assert np.isfinite(seen).all()
    assert np.abs(seen[:, :2]).max() <= 1
    assert seen[:, 2:].min() > 0


def test_training_again_gives_the_same_network():
    one, other = (estimate(train(SMALL, toy(), 3), toy().features[:4, 0]) for _ in range(2))
    np.testing.assert_array_equal(one, other)


def test_validation_keeps_a_persons_faces_together():
    faces = toy()
    seen = np.zeros(len(faces.affect), int)
    for train_on, test_on in faces.folds(5, 0):
        assert not set(faces.people[train_on]) & set(faces.people[test_on])
        seen[test_on] += 1
    assert (seen == 1).all()
    assert len(cross_validate(SMALL, faces, 3, 0).estimates) == len(faces.affect)


def test_configurations_refuse_nonsense():
    with pytest.raises(ConfigError, match="default or paper"):
        named("best", "mesh")
    with pytest.raises(ConfigError, match="members"):
        AffectConfig("mesh", members=0)
    paper = named("paper", "points68")
    # Four dense layers: three hidden ones and the estimate.
    assert (len(paper.hidden) + 1, paper.members, paper.linear) == (4, 1, 0.0)
    network = AffectNetwork(paper, 136, range(136), [1.0] * 136)
    assert network(torch.zeros(3, 136)).shape == (3, 4)


@pytest.mark.parametrize("source", SOURCES)
def test_what_ships_is_better_than_the_baselines_where_it_was_measured(source):
    manifest = read_manifest(assets.bundles() / f"affect_{source}", AffectManifest)
    assert manifest.source == source
    assert manifest.training.data[0].licence == "CC0"
    assert manifest.results["onnx_difference"] < 1e-4
    assert manifest.results["test"]["faces_found"] >= 0.99


def test_measures_of_what_is_known():
    labels = np.array([[-0.5, 0.5], [-0.4, -0.4], [0.5, 0.4], [0.0, 0.0]])
    exact = np.column_stack((labels, np.full((4, 2), 0.1)))
    measures = affect_measures(exact, labels)
    assert measures["valence"] == {"rmse": 0.0, "mae": 0.0, "ccc": 1.0, "pearson": 1.0}
    assert measures["gate"] == {
        "uncomfortable": 2,
        "uncomfortable_pass": 1.0,
        "pleasant": 1,
        "pleasant_pass": 0.0,
    }
    shifted = exact.copy()
    shifted[:, 0] += 0.25
    assert gate_rates(shifted, labels)["uncomfortable_pass"] == 0.0
    assert affect_measures(shifted, labels)["valence"]["pearson"] == 1.0
    assert affect_measures(shifted, labels)["valence"]["ccc"] < 0.9
    assert affect_measures(shifted, labels)["calibration"]["valence"]["within_2_sd"] == 0.0


def clip(folder, name, actor, frames):
    frames = {
        f"{index:05d}": {
            "landmarks": [[float(i + index), float(i % 7) * 3] for i in range(68)],
            "valence": valence,
            "arousal": 1.0,
        }
        for index, valence in enumerate(frames)
    }
    folder.mkdir(exist_ok=True)
    (folder / f"{name}.json").write_text(
        json.dumps({"video_id": name, "actor": actor, "frames": frames})
    )


def test_afew_va_is_read_as_published(tmp_path):
    clip(tmp_path / "001", "001", "anna", [-5.0, 0.0])
    clip(tmp_path / "002", "002", "ben", [10.0])
    clip(tmp_path / "003", "003", "anna", [1.0])
    clips = read_afew_va(tmp_path)
    assert clips.points.shape == (4, 68, 2)
    np.testing.assert_allclose(clips.affect[:, 0], [-0.5, 0.0, 1.0, 0.1])
    assert clips.actors == ("anna", "anna", "ben", "anna")
    faces = features_of_clips(clips)
    assert faces.features.shape == (4, 1, 136)
    for train_on, test_on in faces.folds(2, 0):
        assert {clips.actors[i] for i in train_on}.isdisjoint(clips.actors[i] for i in test_on)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"actor": None}, "actor"),
        ({"frames": {"0": {"landmarks": [[1, 2]], "valence": 0, "arousal": 0}}}, "landmarks"),
        (
            {"frames": {"0": {"landmarks": [[1, 2]] * 68, "valence": 11, "arousal": 0}}},
            "valence",
        ),
    ],
)
def test_a_clip_that_is_not_as_published_is_named(tmp_path, change, word):
    content = {"video_id": "7", "actor": "a", "frames": {}} | change
    (tmp_path / "007.json").write_text(json.dumps(content))
    with pytest.raises(InvalidInput, match="007.json.*" + word):
        read_afew_va(tmp_path)


def test_no_clip_at_all_is_said(tmp_path):
    with pytest.raises(InvalidInput, match="no clip"):
        read_afew_va(tmp_path)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("file,valence\na.jpg,1\n", "arousal"),
        ("file,valence,arousal\na.jpg,x,0\n", "line 2: valence is 'x'"),
        ("file,valence,arousal\na.jpg,0,0\nb.jpg,0,1.5\n", "line 3: arousal is 1.5"),
        ("file,valence,arousal\n", "no rows"),
    ],
)
def test_labels_that_are_wrong_are_named(tmp_path, text, word):
    (tmp_path / "labels.csv").write_text(text)
    with pytest.raises(InvalidInput, match=word):
        read_faces(tmp_path)
    with pytest.raises(InvalidInput, match="give a folder"):
        read_faces(tmp_path / "elsewhere")


@needs_faces
def test_the_split_is_that_of_the_set():
    faces = read_faces(FACES)
    train_on, test_on = test_split(faces)
    assert (len(faces.files), len(test_on)) == (1032, 199)
    assert not set(train_on) & set(test_on)


@needs_faces
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("source", SOURCES)
def test_any_folder_of_labelled_pictures_can_be_measured(tmp_path, source):
    faces = read_faces(FACES)
    rows = ["file,valence,arousal"]
    for index in range(0, 240, 12):
        image = cv2.resize(faces.picture(index), (500, 500))
        cv2.imwrite(str(tmp_path / f"{index}.png"), image[..., ::-1])
        rows.append(f"{index}.png,{faces.affect[index, 0]:.1f},{faces.affect[index, 1]:.1f}")
    (tmp_path / "labels.csv").write_text("\n".join(rows) + "\n")
    command = [sys.executable, "-m", "models", "evaluate", "affect", "--data", str(tmp_path)]
    out = subprocess.run(
        [*command, "--input", source, "--json", "--report", str(tmp_path / "report")],
        capture_output=True,
        text=True,
        check=True,
    )
    result = json.loads(out.stdout)
    assert result["faces"] == 20
    assert result["faces_found"] == 1.0
    assert result["valence"].keys() == {"rmse", "mae", "ccc", "pearson"}
    assert result["valence"]["mae"] < 0.3
    assert result["ms_per_frame"] > 0
    page = (tmp_path / "report" / "index.html").read_text()
    assert page.count("<figure>") == 4
    assert DATA not in page


def test_simpler_models_are_measured_on_the_same_faces():
    faces = toy(views=1)
    source = FaceFeatures(
        np.tile(faces.features, (1, 1, 2)), faces.found, faces.affect, faces.people,
        Mirror(np.arange(12), np.ones(12, np.float32)),
    )  # fmt: skip
    rows = affect_baselines("mesh", source, list(range(180)), list(range(180, 240)), 3)
    assert rows.keys() == {"ridge", "boosted_trees", "paper"}
    for row in rows.values():
        assert row.keys() == {"cross_validated", "test"}
    # A sine that nearly is a line: ridge regression must find it.
    assert rows["ridge"]["test"]["valence"]["ccc"] > 0.85
    assert rows["ridge"]["cross_validated"]["valence"]["ccc"] > 0.85
