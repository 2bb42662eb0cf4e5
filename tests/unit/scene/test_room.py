import pytest

from agent_server.domain.decision import Outcome
from agent_server.domain.scene import AgentMode, SceneSnapshot
from agent_server.domain.stamp import to_ns
from agent_server.scene.rules import default_rules, parse_rules

START = {"window": "open", "hifi": "high", "cigarette": "lit", "curtain": "open"}

TABLE = [
    # gesture, object, state that calls for it, state that does not, reaction
    ("cold", "window", "open", "closed", "close_window"),
    ("hot", "window", "closed", "open", "open_window"),
    ("loud", "hifi", "high", "low", "turn_down_hifi"),
    ("smell", "cigarette", "lit", "out", "put_out_cigarette"),
    ("bright", "curtain", "open", "closed", "close_curtain"),
]

PREEMPTING = """
[settings]
attention_s = 10
[objects]
window = { states = ["open", "closed"], initial = "open" }
lamp = { states = ["off", "on"], initial = "off" }
[steps]
act = { duration_s = 2 }
[reactions]
close = { steps = ["act"], effects = { window = "closed" }, priority = 5, ttl_s = 1 }
jacket = { steps = ["act"], priority = 5, ttl_s = 1 }
duck = { steps = ["act"], priority = 5, ttl_s = 1 }
resume_work = { steps = ["act"], priority = 0, ttl_s = 1 }
[[rules]]
gesture = "cold"
when = { window = "open", lamp = "on" }
reaction = "close"
[[rules]]
gesture = "cold"
when = { window = "closed" }
reaction = "jacket"
[[rules]]
gesture = "loud"
reaction = "duck"
preempts = ["jacket"]
"""


def test_the_agent_starts_at_work(new_stage):
    assert new_stage().at(1000) == SceneSnapshot(AgentMode.WORKING, START, None)


@pytest.mark.parametrize(("gesture", "thing", "needed", "other", "reaction"), TABLE)
def test_a_discomfort_is_handled_when_its_precondition_holds(
    new_stage, gesture, thing, needed, other, reaction
):
    stage = new_stage()
    stage.hand(thing, needed)
    considered = stage.gesture(gesture, 1)
    command = considered.command
    assert considered.outcome is Outcome.COMMAND
    assert considered.commands == (command,)
    assert (command.reaction, command.cause, command.preempts) == (reaction, gesture, None)
    assert (command.id, command.sequence) == ("s/c1", 1)
    assert (command.originating_ns, command.issued_ns) == (to_ns(1) - 7, to_ns(1))
    verdict = considered.verdict
    assert (verdict.mode, verdict.rule) == ("working", f"{gesture} -> {reaction}")
    assert (verdict.precondition, verdict.met) == (f"{thing} = {needed}", True)
    assert stage.at(1) == SceneSnapshot(AgentMode.REACTING, {**START, thing: needed}, "s/c1")
    after = stage.at(1 + command.duration_s)
    assert after == SceneSnapshot(AgentMode.ATTENTION, {**START, thing: other}, None)


@pytest.mark.parametrize(("gesture", "thing", "needed", "other", "reaction"), TABLE)
def test_a_discomfort_finds_nothing_to_do_when_its_precondition_fails(
    new_stage, gesture, thing, needed, other, reaction
):
    stage = new_stage()
    stage.hand(thing, other)
    considered = stage.gesture(gesture, 1)
    assert considered.outcome is Outcome.NOTHING_TO_DO
    assert (considered.command, considered.commands) == (None, ())
    verdict = considered.verdict
    assert (verdict.rule, verdict.met) == (f"{gesture} -> {reaction}", False)
    assert verdict.precondition == f"{thing} = {needed}"
    assert verdict.reason == f"{thing} is {other}"
    assert stage.at(1) == SceneSnapshot(AgentMode.WORKING, {**START, thing: other}, None)


def test_hello_is_greeted_whatever_the_room_is_like(new_stage):
    stage = new_stage()
    considered = stage.gesture("hello", 1)
    assert considered.command.reaction == "greet"
    assert (considered.verdict.precondition, considered.verdict.met) == (None, True)
    assert stage.mode(1 + considered.command.duration_s) == "attention"
    assert stage.at(5).objects == START
    assert stage.gesture("hello", 6).command.reaction == "greet"


def test_a_gesture_without_rule_does_nothing(new_stage):
    considered = new_stage().gesture("shrug", 1)
    assert considered.outcome is Outcome.NOTHING_TO_DO
    assert (considered.verdict.rule, considered.verdict.reason) == (None, "no rule for 'shrug'")
    assert not considered.verdict.met


def test_a_command_carries_what_the_rule_file_says(new_stage):
    command = new_stage().gesture("loud", 1).command
    reaction = default_rules().reactions["turn_down_hifi"]
    assert command.steps == reaction.steps
    assert (command.priority, command.ttl_ms) == (10, 5000)


# --- attention


def test_attention_ends_20_s_after_the_last_gesture(new_stage):
    stage = new_stage()
    stage.gesture("smell", 1)
    assert stage.mode(20.999) == "attention"
    assert stage.mode(21) == "working"
    resume = stage.sent[-1]
    assert stage.story == [
        ("put_out_cigarette", "smell", 1),
        ("resume_work", "attention_timeout", 21),
    ]
    assert (resume.originating_ns, resume.sequence, resume.id) == (to_ns(21), 2, "s/c2")
    assert stage.at(21).command_id == "s/c2"
    assert stage.at(21 + resume.duration_s).command_id is None


@pytest.mark.parametrize("gesture", ["smell", "hot", "shrug", "hello"])
def test_every_gesture_prolongs_attention_handled_or_not(new_stage, gesture):
    stage = new_stage()
    stage.gesture("smell", 1)
    stage.gesture(gesture, 20)
    assert stage.mode(39) != "working"
    assert stage.mode(40) == "working"


def test_a_gesture_that_comes_too_late_is_told_of_the_end_of_attention_first(new_stage):
    stage = new_stage()
    stage.gesture("smell", 1)
    considered = stage.gesture("loud", 21.5)
    assert [c.reaction for c in considered.commands] == ["resume_work", "turn_down_hifi"]
    assert considered.commands[0].issued_ns == to_ns(21)
    assert considered.verdict.mode == "working"


def test_a_gesture_while_working_that_finds_nothing_to_do_draws_no_attention(new_stage):
    stage = new_stage()
    stage.gesture("hot", 1)
    assert stage.mode(2) == "working"
    assert stage.mode(100) == "working"
    assert stage.sent == []


def test_attention_ends_when_the_body_leaves(new_stage):
    stage = new_stage()
    stage.gesture("smell", 1)
    assert stage.mode(5) == "attention"
    stage.leave(6)
    assert stage.story[1:] == [("resume_work", "body_lost", 6)]
    assert stage.at(6).mode is AgentMode.WORKING


def test_a_body_that_leaves_during_a_reaction_ends_attention_right_after_it(new_stage):
    stage = new_stage()
    stage.gesture("smell", 1)
    stage.leave(2)
    assert stage.mode(3.4) == "reacting"
    assert stage.mode(3.5) == "working"
    assert stage.story[1:] == [("resume_work", "body_lost", 3.5)]
    assert stage.at(4).objects["cigarette"] == "out"


def test_a_gesture_calls_off_the_departure(new_stage):
    stage = new_stage()
    stage.gesture("smell", 1)
    stage.leave(2)
    stage.gesture("loud", 3)
    assert stage.mode(22.9) == "attention"
    assert stage.mode(23) == "working"
    assert stage.sent[-1].cause == "attention_timeout"


def test_a_body_that_leaves_a_working_agent_changes_nothing(new_stage):
    stage = new_stage()
    stage.leave(1)
    stage.gesture("smell", 2)
    assert stage.mode(21) == "attention"
    assert len(stage.sent) == 1


def test_attention_that_has_run_out_during_a_reaction_ends_right_after_it(new_stage):
    stage = new_stage(renderer=True)
    command = stage.gesture("smell", 1).command
    for at_s in range(2, 30, 4):
        stage.ack(command, "progress", at_s)
    assert stage.mode(29) == "reacting"
    assert stage.ack(command, "done", 29.5)
    assert stage.story[1:] == [("resume_work", "attention_timeout", 29.5)]


# --- one thing at a time


def test_a_discomfort_cuts_a_greeting_short(new_stage):
    stage = new_stage()
    stage.gesture("hello", 1)
    considered = stage.gesture("cold", 2)
    assert considered.outcome is Outcome.COMMAND
    assert considered.command.preempts == "s/c1"
    assert (considered.verdict.mode, considered.verdict.reason) == ("reacting", "cuts short greet")
    assert stage.at(2).command_id == "s/c2"


@pytest.mark.parametrize(
    ("first", "second"),
    [("cold", "loud"), ("cold", "cold"), ("smell", "hello"), ("hello", "hello")],
)
def test_otherwise_an_agent_that_reacts_is_busy(new_stage, first, second):
    stage = new_stage()
    running = stage.gesture(first, 1).command
    considered = stage.gesture(second, 2)
    assert considered.outcome is Outcome.BUSY
    assert considered.command is None
    assert considered.verdict.met
    assert considered.verdict.reason == f"busy with {running.reaction}"
    assert stage.at(2).command_id == running.id


def test_an_agent_that_reacts_still_says_when_there_is_nothing_to_do(new_stage):
    stage = new_stage()
    stage.gesture("cold", 1)
    assert stage.gesture("hot", 2).outcome is Outcome.NOTHING_TO_DO


def test_a_rule_may_cut_short_what_it_names(new_stage):
    stage = new_stage(parse_rules(PREEMPTING, ["cold", "loud"], name="test"))
    stage.hand("window", "closed")
    assert stage.gesture("cold", 1).command.reaction == "jacket"
    assert stage.gesture("loud", 2).command.preempts == "s/c1"
    assert stage.gesture("cold", 3).outcome is Outcome.BUSY


def test_the_first_rule_that_holds_applies(new_stage):
    stage = new_stage(parse_rules(PREEMPTING, ["cold", "loud"], name="test"))
    nothing = stage.gesture("cold", 1).verdict
    assert nothing.precondition == "window = open and lamp = on"
    assert nothing.reason == "lamp is off, window is open"
    stage.hand("lamp", "on", 2)
    assert stage.gesture("cold", 3).verdict.rule == "cold -> close"
    assert stage.gesture("cold", 6).verdict.rule == "cold -> jacket"


def test_a_return_to_work_is_cut_short_by_any_reaction(new_stage):
    stage = new_stage()
    stage.gesture("smell", 1)
    assert stage.at(21.5).command_id == "s/c2"
    considered = stage.gesture("hello", 22)
    assert considered.command.preempts == "s/c2"
    assert considered.verdict.mode == "working"
    assert considered.verdict.reason == "cuts short resume_work"


def test_a_return_to_work_is_cut_short_whatever_its_priority(new_stage):
    text = PREEMPTING.replace("priority = 0", "priority = 1000")
    stage = new_stage(parse_rules(text, ["cold", "loud"], name="test"))
    stage.gesture("loud", 1)
    assert stage.at(11).command_id == "s/c2"
    assert stage.gesture("loud", 12).command.preempts == "s/c2"


def test_a_reaction_that_was_cut_short_has_no_effect(new_stage):
    text = PREEMPTING.replace('["jacket"]', '["close"]')
    stage = new_stage(parse_rules(text, ["cold", "loud"], name="test"))
    stage.hand("lamp", "on")
    close = stage.gesture("cold", 1).command
    stage.gesture("loud", 2)
    assert not stage.ack(close, "done", 2.5)
    assert stage.at(9).objects["window"] == "open"
