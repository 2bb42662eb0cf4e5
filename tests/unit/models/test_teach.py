"""Teaching gestures: what is read, what is refused, and what comes out."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from typer.testing import CliRunner  # noqa: E402

from agent_server.domain.label import Label  # noqa: E402
from agent_server.domain.skeleton import CORE_JOINT_NAMES, SkeletonFrame  # noqa: E402
from agent_server.errors import BundleError, InvalidInput  # noqa: E402
from agent_server.inference.manifest import read_manifest  # noqa: E402
from agent_server.inference.runtime import OnnxClassifier  # noqa: E402
from agent_server.recording.metadata import RecordingMetadata  # noqa: E402
from agent_server.recording.writer import RecordingWriter  # noqa: E402
from models.__main__ import app  # noqa: E402
from models.data.labelled import (  # noqa: E402
    GestureSet,
    check_known,
    check_repetitions,
    read_gestures,
)
from models.data.synthetic import Mix, synthetic_recordings  # noqa: E402
from models.data.windows import Recording, Stretch  # noqa: E402
from models.export import teach as teaching  # noqa: E402
from models.export.restore import restore_classifier  # noqa: E402
from models.export.teach import BUILT_IN, Lesson, People, choose_people, teach  # noqa: E402

ARTIFACTS = Path(__file__).parents[3] / "models" / "artifacts"
CLASSIFIER, PREDICTOR = ARTIFACTS / "interformer_server", ARTIFACTS / "ma_wgan_server"
STEP_NS = 40_000_000


def write(path: Path, frames: int, *labels: tuple[str, float, float], subject: str = "p01") -> None:
    """A recording of somebody who stands still, with labels in seconds.

    The person is chosen in the first 0.2 s, so that the models see what comes after.
    """
    pose = np.ones((len(CORE_JOINT_NAMES), 4), np.float32)
    pose[:, :3] = np.random.default_rng(0).uniform(-0.4, 0.4, (9, 3))
    pose[:, 2] += 2.0
    pose.flags.writeable = False
    metadata = RecordingMetadata(session="s", server_version="0", joint_format="core9")
    with RecordingWriter(path, metadata) as writer:
        for gesture, onset, offset in labels:
            ends = (round(onset * 1e9), round(offset * 1e9))
            writer.append_label(Label(gesture, *ends, subject, None, False), f"tag_{gesture}")
        for index in range(frames):
            writer.append_input(SkeletonFrame(index * STEP_NS, 3, "core9", pose))


def test_labels_become_stretches_and_idle_is_none(tmp_path: Path) -> None:
    write(tmp_path / "a.mcap", 200, ("wink", 1.0, 2.0), ("idle", 3.0, 5.0), ("wink", 6.0, 7.0))
    taught = read_gestures(tmp_path)
    assert (taught.gestures, taught.subjects) == (("wink",), ("p01",))
    assert taught.recordings[0].stretches == (Stretch("wink", 20, 45), Stretch("wink", 145, 170))
    assert read_gestures(tmp_path, tags=True).gestures == ("tag_idle", "tag_wink")


@pytest.mark.parametrize(
    ("frames", "labels", "words"),
    [
        (200, (), "has no labels: record it with agent-server gestures record"),
        (40, (("wink", 0.2, 1.0),), "1.4 s of skeletons, at least 3 s are needed"),
    ],
)
def test_a_recording_that_teaches_nothing_is_refused(
    tmp_path: Path, frames: int, labels: tuple[tuple[str, float, float], ...], words: str
) -> None:
    write(tmp_path / "a.mcap", frames, *labels)
    with pytest.raises(InvalidInput, match=words):
        read_gestures(tmp_path)


def test_a_folder_without_recordings_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="gestures record"):
        read_gestures(tmp_path)


def test_unknown_and_rare_gestures_are_named() -> None:
    with pytest.raises(InvalidInput, match="show bow, b knows wink"):
        check_known(["wink", "bow"], ["wink"], "b")
    shown = tuple(Stretch("wink", at * 50, at * 50 + 25) for at in range(4))
    still = np.zeros((300, 9, 3), np.float32)
    with pytest.raises(InvalidInput, match=r"wink is shown 4 times.*at least 5"):
        check_repetitions([Recording(still, still, shown, "p01")], ["wink"])


def test_people_have_one_role_each_where_there_are_three() -> None:
    assert choose_people(("a", "b", "c", "d"), None) == People(("a", "b"), "c", "d")
    assert choose_people(("a", "b", "c"), "a") == People(("b",), "c", "a")
    assert choose_people(("a", "b"), None) == People(("a",), "b", "b")
    with pytest.raises(InvalidInput, match="record a second person"):
        choose_people(("a",), None)
    with pytest.raises(InvalidInput, match=r"--held-out is z.*a, b"):
        choose_people(("a", "b"), "z")


def test_the_weights_of_a_bundle_can_be_gone_on_with() -> None:
    network = restore_classifier(CLASSIFIER)
    shipped = OnnxClassifier(CLASSIFIER)
    motion = np.random.default_rng(1).uniform(-0.5, 0.5, (3, 75, 9, 3)).astype(np.float32)
    with torch.no_grad():
        given = network(torch.from_numpy(motion)).numpy()
    np.testing.assert_allclose(given, shipped.classify(motion), atol=1e-4)


def test_a_predictor_is_no_classifier_to_go_on_with() -> None:
    with pytest.raises(BundleError, match="holds no classifier"):
        restore_classifier(PREDICTOR)


@pytest.fixture
def taught() -> GestureSet:
    """Three virtual people who wave, which is called ahoy here."""
    people = ("v900", "v901", "v902")
    takes = [
        replace(
            take,
            stretches=tuple(replace(s, gesture="ahoy") for s in take.stretches or ()),
        )
        for take in synthetic_recordings(5, 260, people)
        if {s.gesture for s in take.stretches or ()} <= {"hello"}
    ]
    return GestureSet(tuple(takes), ("ahoy",), people)


def test_a_frozen_lesson_changes_the_head_alone_and_the_server_takes_it(
    taught: GestureSet, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(teaching, "TAKES", 120)
    monkeypatch.setattr(teaching, "IDLE_MINUTES", 1)
    lesson = Lesson(
        tmp_path / "mine", CLASSIFIER, PREDICTOR, tmp_path / "cache", encoder="frozen", steps=3
    )
    manifest = teach(taught, lesson)
    assert manifest.labels == [*BUILT_IN, "ahoy", "idle"]
    assert manifest.results["people"] == {"train": ["v900"], "chosen": "v901", "test": "v902"}
    assert manifest.licence == teaching.LICENCE
    assert "ahoy" in (tmp_path / "mine" / "CARD.md").read_text()
    assert OnnxClassifier(tmp_path / "mine").labels == tuple(manifest.labels)
    before, after = (
        restore_classifier(folder).classifier.state_dict()
        for folder in (CLASSIFIER, tmp_path / "mine")
    )
    changed = {name for name in before if not torch.equal(before[name], after[name])}
    assert changed == {"hidden.weight", "hidden.bias", "head.weight", "head.bias"}


def test_idle_actions_that_are_taught_are_not_idle_any_more() -> None:
    made = synthetic_recordings(5, 40, ("v900",))
    same = synthetic_recordings(5, 40, ("v900",), Mix(without=("no_such_action",)))
    assert all(np.array_equal(a.observed, b.observed) for a, b in zip(made, same, strict=True))
    without = synthetic_recordings(
        5, 40, ("v900",), Mix(without=("drink", "clap", "talk", "phone"))
    )
    assert any(
        a.observed.shape != b.observed.shape or not np.array_equal(a.observed, b.observed)
        for a, b in zip(made, without, strict=True)
    )


def test_the_shipped_labels_are_those_of_the_lesson_without_gestures() -> None:
    assert read_manifest(CLASSIFIER).labels == [*BUILT_IN, "idle"]


def test_a_check_prints_a_matrix_and_refuses_what_the_bundle_does_not_know(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(teaching, "IDLE_MINUTES", 1)
    streams = Path(__file__).parents[3] / "recorded_streams"
    (tmp_path / "hello.mcap").write_bytes((streams / "hello.mcap").read_bytes())
    words = ["gestures", "check", str(CLASSIFIER), str(tmp_path)]
    told = CliRunner().invoke(app, words, catch_exceptions=False)
    assert told.exit_code == 0, told.output
    assert "hello" in told.stdout
    assert "calibration error" in told.stdout
    assert "0.9 s" in told.stdout
    found = json.loads(CliRunner().invoke(app, [*words, "--json"]).stdout)
    assert found["decisions"]["1s+2s_predicted"]["gestures"] >= 2
    assert found["1s+2s_predicted"]["recall"]["hello"] > 0.4
    write(tmp_path / "wink.mcap", 200, ("wink", 1.0, 2.0))
    with pytest.raises(InvalidInput, match="show wink"):
        CliRunner().invoke(app, words, catch_exceptions=False)
