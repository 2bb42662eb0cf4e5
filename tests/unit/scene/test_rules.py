import dataclasses
from importlib import resources
from pathlib import Path

import pytest

from agent_server.domain.command import Step
from agent_server.domain.gesture import DISCOMFORTS, GESTURES, HELLO
from agent_server.domain.scene import AgentMode
from agent_server.errors import RuleError
from agent_server.scene.rulebook import Condition
from agent_server.scene.rules import default_rules, load_rules, parse_rules

ROOM = resources.files("agent_server.scene").joinpath("room.toml").read_text("utf-8")

SMALL = Path(__file__).with_name("small_room.toml").read_text(encoding="utf-8")


def small(old="", new=""):
    assert old in SMALL
    return SMALL.replace(old, new, 1)


def test_the_packaged_rules_cover_every_gesture_but_idle():
    rules = default_rules()
    assert set(rules.rules) == {*DISCOMFORTS, HELLO}
    assert rules.attention_s == 20.0


@pytest.mark.parametrize(
    ("gesture", "precondition", "reaction", "effects"),
    [
        ("cold", "window = open", "close_window", "window = closed"),
        ("hot", "window = closed", "open_window", "window = open"),
        ("loud", "hifi = high", "turn_down_hifi", "hifi = low"),
        ("smell", "cigarette = lit", "put_out_cigarette", "cigarette = out"),
        ("bright", "curtain = open", "close_curtain", "curtain = closed"),
        ("hello", None, "greet", ""),
    ],
)
def test_the_packaged_rules_are_the_table(gesture, precondition, reaction, effects):
    (rule,) = default_rules().rules[gesture]
    assert rule.precondition == precondition
    assert rule.reaction.name == reaction
    assert rule.name == f"{gesture} -> {reaction}"
    assert ", ".join(map(str, rule.reaction.effects)) == effects
    assert rule.preempts == frozenset()


def test_the_packaged_reactions_stand_up_and_sit_down_but_for_the_seated_ones():
    for name, reaction in default_rules().reactions.items():
        actions = [step.action for step in reaction.steps]
        if name in ("put_out_cigarette", "greet", "resume_work"):
            assert "stand_up" not in actions
        else:
            assert (actions[0], actions[-1]) == ("stand_up", "sit_down")


def test_in_the_packaged_rules_discomfort_comes_before_hello():
    rules = default_rules().rules
    hello = rules[HELLO][0].reaction.priority
    assert len({rules[gesture][0].reaction.priority for gesture in DISCOMFORTS}) == 1
    assert all(rules[gesture][0].reaction.priority > hello for gesture in DISCOMFORTS)


def test_in_the_packaged_rules_only_hello_needs_no_uncomfortable_face():
    rules = default_rules()
    assert not rules.is_gated(HELLO)
    assert all(rules.is_gated(gesture) for gesture in DISCOMFORTS)


def test_every_gesture_is_gated_unless_the_file_says_otherwise():
    assert parse_rules(SMALL, ["point"], name="my.toml").is_gated("point")
    text = small("attention_s = 5\n", 'attention_s = 5\nungated = ["point"]\n')
    assert not parse_rules(text, ["point"], name="my.toml").is_gated("point")


def test_the_packaged_room_starts_with_every_discomfort_but_hot():
    objects = default_rules().objects
    initial = {thing.name: thing.initial for thing in objects.values() if thing.states}
    assert initial == {"window": "open", "hifi": "high", "cigarette": "lit", "curtain": "open"}
    assert objects["keyboard"].initial is None


def test_the_packaged_agent_idles_in_both_modes():
    idle = default_rules().idle
    assert [b.step.action for b in idle[AgentMode.WORKING]] == ["type_on", "look_at", "look_at"]
    busiest = max(idle[AgentMode.ATTENTION], key=lambda behaviour: behaviour.weight)
    assert busiest.step == Step("look_at_person", None, 2.0)


def test_reads_every_key():
    rules = parse_rules(SMALL, ["point"], name="my.toml")
    (rule,) = rules.rules["point"]
    assert rules.attention_s == 5.0
    assert rules.objects["lamp"].states == ("on", "off")
    assert rule.when == (Condition("lamp", "off"),)
    assert rule.preempts == {"light"}
    assert rule.reaction.steps == (Step("nod", None, 1.0), Step("switch", "lamp", 0.5))
    assert rule.reaction.effects == (Condition("lamp", "on"),)
    assert (rule.reaction.priority, rule.reaction.ttl_ms) == (3, 2500)
    assert rules.idle == {AgentMode.WORKING: (), AgentMode.ATTENTION: ()}


def test_rules_are_frozen():
    with pytest.raises(dataclasses.FrozenInstanceError):
        default_rules().attention_s = 1.0


def test_a_classifier_may_know_other_gestures():
    text = small('gesture = "point"', 'gesture = "shrug"')
    assert list(parse_rules(text, ["shrug"], name="my.toml").rules) == ["shrug"]


def test_several_rules_of_a_gesture_keep_their_order():
    text = SMALL + '[[rules]]\ngesture = "point"\nreaction = "light"\n'
    rules = parse_rules(text, ["point"], name="my.toml").rules["point"]
    assert [rule.precondition for rule in rules] == ["lamp = off", None]


def test_a_file_is_read_with_or_without_a_byte_order_mark(tmp_path):
    plain, marked = tmp_path / "plain.toml", tmp_path / "marked.toml"
    plain.write_text(ROOM, encoding="utf-8")
    marked.write_text(ROOM, encoding="utf-8-sig")
    assert load_rules(plain) == load_rules(marked) == default_rules()


def test_a_mistake_in_a_file_names_the_file(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(ROOM.replace('reaction = "greet"', 'reaction = "great"'), encoding="utf-8")
    with pytest.raises(RuleError) as refused:
        load_rules(path, GESTURES)
    line = ROOM[: ROOM.index('reaction = "greet"')].count("\n") + 1
    assert str(refused.value).startswith(f"{path}:{line}: ")


def test_a_file_that_cannot_be_read_is_refused(tmp_path):
    with pytest.raises(RuleError, match=r"none\.toml: cannot be read \(No such file"):
        load_rules(tmp_path / "none.toml")
    (tmp_path / "latin.toml").write_bytes(b"# caf\xe9")
    with pytest.raises(RuleError, match="not UTF-8 at byte 5; save the file as UTF-8"):
        load_rules(tmp_path / "latin.toml")


def test_the_packaged_rules_need_their_gestures():
    with pytest.raises(RuleError, match=r"room\.toml:\d+: .*unknown gesture 'hello'"):
        default_rules(DISCOMFORTS)
