import pytest

from agent_server.domain.command import Ack, AckStatus
from agent_server.domain.decision import Outcome
from agent_server.domain.scene import AgentMode, ObjectChanged, SceneSnapshot
from agent_server.domain.stamp import to_ns
from agent_server.errors import InvalidInput
from agent_server.scene.room import Room
from agent_server.scene.rules import default_rules

START = {"window": "open", "hifi": "high", "cigarette": "lit", "curtain": "open"}


def test_a_reaction_is_over_when_the_renderer_says_so(new_stage):
    stage = new_stage(renderer=True)
    command = stage.gesture("cold", 1).command
    for status in ("accepted", "started", "progress"):
        assert stage.ack(command, status, 2)
    assert stage.at(2).objects["window"] == "open"
    assert stage.ack(command, "done", 3)
    assert stage.at(3) == SceneSnapshot(AgentMode.ATTENTION, {**START, "window": "closed"}, None)


def test_a_reaction_that_fails_has_no_effect(new_stage):
    stage = new_stage(renderer=True)
    assert stage.ack(stage.gesture("cold", 1).command, "failed", 3)
    assert stage.at(3) == SceneSnapshot(AgentMode.ATTENTION, START, None)


def test_a_silent_renderer_fails_a_reaction_after_twice_its_nominal_time(new_stage):
    stage = new_stage(renderer=True)
    command = stage.gesture("smell", 1).command
    assert stage.mode(1 + 2 * command.duration_s - 0.001) == "reacting"
    assert stage.at(1 + 2 * command.duration_s) == SceneSnapshot(AgentMode.ATTENTION, START, None)


def test_a_renderer_that_reports_is_given_more_time(new_stage):
    stage = new_stage(renderer=True)
    command = stage.gesture("smell", 1).command
    stage.ack(command, "started", 4)
    assert stage.mode(4 + 2 * command.duration_s - 0.001) == "reacting"
    assert stage.mode(4 + 2 * command.duration_s) == "attention"


def test_words_on_other_commands_change_nothing(new_stage):
    stage = new_stage(renderer=True)
    first = stage.gesture("smell", 1).command
    assert stage.ack(first, "done", 2)
    second = stage.gesture("cold", 3).command
    assert not stage.ack(first, "done", 4)
    assert not stage.ack(first, "failed", 4)
    unknown = stage.room.acknowledge(Ack(to_ns(4), "s/c99", AckStatus.DONE))
    assert (unknown.taken, unknown.commands) == (False, ())
    assert stage.at(4).command_id == second.id
    assert stage.ack(second, "done", 5)
    assert not stage.ack(second, "done", 5)
    assert stage.at(6).mode is AgentMode.ATTENTION


def test_a_late_word_still_delivers_what_fell_due(new_stage):
    stage = new_stage(renderer=True)
    command = stage.gesture("smell", 1).command
    assert not stage.ack(command, "done", 30)
    assert stage.story[1:] == [("resume_work", "attention_timeout", 21)]
    assert stage.at(30).objects["cigarette"] == "lit"


def test_a_return_to_work_takes_words_too(new_stage):
    stage = new_stage(renderer=True)
    stage.ack(stage.gesture("smell", 1).command, "done", 2)
    stage.at(21)
    assert stage.ack(stage.sent[-1], "failed", 21.5)
    assert stage.at(21.5) == SceneSnapshot(AgentMode.WORKING, {**START, "cigarette": "out"}, None)


def test_a_renderer_that_comes_late_is_given_its_time(new_stage):
    stage = new_stage()
    command = stage.gesture("smell", 1).command
    stage.attach(3)
    assert stage.mode(3 + 2 * command.duration_s - 0.001) == "reacting"
    assert stage.at(3 + 2 * command.duration_s) == SceneSnapshot(AgentMode.ATTENTION, START, None)


def test_without_its_renderer_a_reaction_ends_at_its_nominal_time(new_stage):
    stage = new_stage(renderer=True)
    command = stage.gesture("smell", 1).command
    stage.detach(2)
    assert stage.mode(1 + command.duration_s - 0.001) == "reacting"
    assert stage.at(1 + command.duration_s).objects["cigarette"] == "out"


def test_a_reaction_past_its_nominal_time_ends_when_the_renderer_leaves(new_stage):
    stage = new_stage(renderer=True)
    stage.gesture("smell", 1)
    stage.leave(2)
    stage.detach(5)
    assert stage.story[1:] == [("resume_work", "body_lost", 5)]
    assert stage.room.snapshot().objects["cigarette"] == "out"


# --- changes by hand, and time


def test_a_change_by_hand_counts_from_then_on(new_stage):
    stage = new_stage()
    stage.hand("window", "closed", 1)
    assert stage.gesture("cold", 2).outcome is Outcome.NOTHING_TO_DO
    stage.hand("window", "open", 3)
    assert stage.gesture("cold", 4).outcome is Outcome.COMMAND


def test_a_change_by_hand_comes_after_what_fell_due(new_stage):
    stage = new_stage()
    stage.gesture("smell", 1)
    stage.hand("cigarette", "lit", 30)
    assert stage.story[1:] == [("resume_work", "attention_timeout", 21)]
    assert stage.at(30).objects["cigarette"] == "lit"


@pytest.mark.parametrize(
    ("thing", "state", "field", "code", "message"),
    [
        ("windw", "open", "object", "unknown_object", "unknown object 'windw'; did you mean 'win"),
        ("desk", "open", "object", "unknown_object", "known objects with states: cigarette,"),
        ("window", "opn", "state", "unknown_state", "did you mean 'open'. known states: closed, o"),
    ],
)
def test_an_impossible_change_is_refused(new_stage, thing, state, field, code, message):
    stage = new_stage()
    stage.gesture("smell", 1)
    with pytest.raises(InvalidInput, match=message) as refused:
        stage.hand(thing, state, 100)
    assert (refused.value.field, refused.value.code) == (field, code)
    assert stage.room.snapshot().mode is AgentMode.REACTING


def test_an_event_from_the_past_happens_now(new_stage):
    stage = new_stage()
    stage.at(10)
    assert stage.gesture("smell", 5).command.issued_ns == to_ns(10)
    assert stage.at(3).mode is AgentMode.REACTING


def test_the_deadline_says_when_to_look_again(new_stage):
    stage = new_stage()
    assert stage.room.deadline() is None
    stage.gesture("smell", 1)
    assert stage.room.deadline() == to_ns(3.5)
    stage.at(3.5)
    assert stage.room.deadline() == to_ns(21)


def test_a_snapshot_does_not_follow_the_room(new_stage):
    stage = new_stage()
    before = stage.room.snapshot()
    stage.hand("window", "closed", 1)
    assert before.objects == START


def test_rooms_share_nothing():
    rules = default_rules()
    Room(rules, "a").change(ObjectChanged(0, "window", "closed"))
    other = Room(rules, "b")
    assert other.snapshot().objects == START
    assert other.consider("hello", 0, 0).command.id == "b/c1"
