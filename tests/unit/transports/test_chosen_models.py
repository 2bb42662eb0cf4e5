"""Models of one's own: bundles that are named, and rooms for the gestures that they know."""

import shutil
from pathlib import Path

import msgspec
import pytest

from agent_server import assets
from agent_server.cli.options import settings_with
from agent_server.config import GateSettings, ModelSettings, Settings, load_settings
from agent_server.domain.decision import Outcome
from agent_server.domain.gesture import GESTURES
from agent_server.errors import BundleError, ConfigError, RuleError
from agent_server.inference.fake import LastFramePredictor, RuleClassifier
from agent_server.inference.manifest import read_manifest, write_manifest
from agent_server.scene import rules as scene_rules
from agent_server.service.core import Core
from agent_server.service.loading import CLASSIFIER, PREDICTOR, load_models, load_room
from agent_server.service.models import Models
from agent_server.service.replay import replay_stream
from tests.support.bodies import stream
from tests.support.models import covers_ears

ROOM = (Path(scene_rules.__file__).parent / "room.toml").read_text("utf-8")
DIM = """
[[rules]]
gesture = "dim"
when = { curtain = "open" }
reaction = "close_curtain"
"""


def bundle_of(folder, name, shipped, **changes):
    """A copy of a bundle that ships, under another name."""
    shutil.copytree(assets.bundles() / shipped, folder / name)
    manifest = read_manifest(assets.bundles() / shipped)
    changed = msgspec.structs.replace(manifest, name=name, **changes)
    write_manifest(folder / name, changed)
    return folder / name


def knowing(*labels):
    """Models whose classifier knows these gestures."""
    return Models(LastFramePredictor(), RuleClassifier(lambda _: "idle", labels))


def room_file(tmp_path, text):
    (tmp_path / "room.toml").write_text(text, "utf-8")
    return Settings(rules=str(tmp_path / "room.toml"))


def test_settings_name_bundles_relative_to_where_the_server_starts(tmp_path, monkeypatch):
    taught = [*GESTURES[:-2], "dim", "idle"]
    bundle_of(tmp_path, "mine", CLASSIFIER, labels=taught)
    bundle_of(tmp_path, "forecast", PREDICTOR)
    (tmp_path / "settings").mkdir()
    (tmp_path / "settings" / "s.toml").write_text("[models]\nclassifier = 'mine'\n")
    monkeypatch.chdir(tmp_path)
    models = load_models(load_settings(Path("settings/s.toml")))
    assert models.classifier.labels == tuple(taught)
    assert (models.predictor.name, models.classifier.name) == (PREDICTOR, "mine")
    options = settings_with(Path("settings/s.toml"), predictor=Path("forecast"))
    chosen = load_models(options)
    assert (chosen.predictor.name, chosen.classifier.name) == ("forecast", "mine")


def test_the_command_line_goes_before_the_file(tmp_path):
    (tmp_path / "s.toml").write_text("rules = 'a.toml'\n[models]\nclassifier = 'a'\n")
    settings = settings_with(tmp_path / "s.toml", classifier=Path("b"), rules=Path("b.toml"))
    assert settings.models == ModelSettings(classifier="b")
    assert settings.rules == "b.toml"
    unchanged = settings_with(tmp_path / "s.toml", port=1)
    assert (unchanged.models.classifier, unchanged.rules) == ("a", "a.toml")
    with pytest.raises(ConfigError, match="port"):
        settings_with(None, port=-1)


def test_a_bundle_that_is_none_is_refused_with_what_one_is(tmp_path):
    with pytest.raises(BundleError, match=r"no manifest\.json in .*a bundle is a folder with"):
        load_models(Settings(models=ModelSettings(classifier=str(tmp_path))))


def test_a_predictor_is_no_classifier():
    shipped = str(assets.bundles() / PREDICTOR)
    with pytest.raises(BundleError, match="classify is needed"):
        load_models(Settings(models=ModelSettings(classifier=shipped)))


def test_the_room_that_ships_works_with_gestures_beyond_its_own():
    rules = load_room(Settings(), knowing(*GESTURES, "dim"))
    assert set(rules.rules) == set(GESTURES) - {"idle"}


def test_a_rule_file_may_name_a_taught_gesture_and_must_not_name_others(tmp_path):
    settings = room_file(tmp_path, ROOM + DIM)
    rules = load_room(settings, knowing(*GESTURES, "dim"))
    assert rules.rules["dim"][0].reaction.name == "close_curtain"
    with pytest.raises(RuleError, match="unknown gesture 'dim'"):
        load_room(settings, knowing(*GESTURES))


def test_the_rule_of_the_guide_is_taken(tmp_path):
    guide = (Path(__file__).parents[3] / "docs" / "teaching.md").read_text("utf-8")
    rule = guide.partition("<!-- example: rule -->\n```toml\n")[2].partition("```")[0]
    room = ROOM.replace('ungated = ["hello"]', 'ungated = ["hello", "thumbs_up"]')
    rules = load_room(room_file(tmp_path, room + "\n" + rule), knowing(*GESTURES, "thumbs_up"))
    assert rules.rules["thumbs_up"][0].reaction.name == "greet"
    assert not rules.is_gated("thumbs_up")


def decisions_on_raised_hands(settings):
    """What comes of two seconds of raised hands, which the classifier has learnt as ``dim``."""
    classifier = RuleClassifier(
        lambda motion: "dim" if covers_ears(motion) == "loud" else "idle", (*GESTURES, "dim")
    )
    models = Models(LastFramePredictor(), classifier)
    core = Core("s", settings, load_room(settings, models), models)
    return list(replay_stream(core, models, stream(6, hands_up=lambda t: 2 <= t < 4)))


OPEN_GATE = GateSettings(mode="off")


def test_a_taught_gesture_leads_to_the_reaction_of_its_rule(tmp_path):
    settings = msgspec.structs.replace(room_file(tmp_path, ROOM + DIM), gate=OPEN_GATE)
    decisions = decisions_on_raised_hands(settings)
    commands = [decision.command for decision in decisions if decision.command is not None]
    assert [(command.cause, command.reaction) for command in commands] == [("dim", "close_curtain")]
    assert "dim" in decisions[0].probabilities


def test_a_taught_gesture_without_a_rule_is_seen_and_nothing_follows():
    decisions = decisions_on_raised_hands(Settings(gate=OPEN_GATE))
    seen = {decision.outcome for decision in decisions if decision.gesture == "dim"}
    assert Outcome.NOTHING_TO_DO in seen
    assert Outcome.COMMAND not in seen


def test_a_classifier_without_the_built_in_gestures_needs_a_room_of_its_own(tmp_path):
    models = knowing("dim", "idle")
    with pytest.raises(RuleError) as refused:
        load_room(Settings(), models)
    said = str(refused.value)
    assert "rule_classifier" in said
    assert "known gestures: dim" in said
    assert "--rules FILE" in said
    copied, _, _ = said.partition("copy ")[2].partition(",")
    assert Path(copied).read_text("utf-8") == ROOM
    room = ROOM.replace('ungated = ["hello"]', "ungated = []")
    room = room[: room.index("[[rules]]")] + DIM
    assert set(load_room(room_file(tmp_path, room), models).rules) == {"dim"}
