"""What holds of the room whatever happens to it."""

import dataclasses
from functools import singledispatch

from hypothesis import event as note
from hypothesis import given, settings
from hypothesis import strategies as st

from agent_server.domain.command import Ack, AckStatus
from agent_server.domain.decision import Outcome
from agent_server.domain.gesture import DISCOMFORTS, HELLO
from agent_server.domain.motion import BodyLost
from agent_server.domain.scene import AgentMode, ObjectChanged
from agent_server.domain.stamp import to_ns
from agent_server.scene.room import Room
from agent_server.scene.rulebook import RESUME_WORK
from agent_server.scene.rules import default_rules

laws = settings(derandomize=True, deadline=None, max_examples=120)

RULES = default_rules()
ALL_PREEMPT = dataclasses.replace(
    RULES,
    rules={
        gesture: tuple(
            dataclasses.replace(rule, preempts=frozenset(RULES.reactions)) for rule in rules
        )
        for gesture, rules in RULES.rules.items()
    },
)


@dataclasses.dataclass(frozen=True)
class Gesture:
    stamp_ns: int
    name: str


@dataclasses.dataclass(frozen=True)
class Renderer:
    stamp_ns: int
    comes: bool


@singledispatch
def tell(event, room):
    """Tell the room of an event; give the commands and every other answer."""
    raise TypeError(event)


@tell.register
def _(event: Gesture, room):
    considered = room.consider(event.name, event.stamp_ns, event.stamp_ns)
    return considered.commands, (considered.outcome, considered.command, considered.verdict)


@tell.register
def _(event: Ack, room):
    answer = room.acknowledge(event)
    return answer.commands, answer.taken


@tell.register
def _(event: ObjectChanged, room):
    return room.change(event), None


@tell.register
def _(event: BodyLost, room):
    return room.lose_body(event), None


@tell.register
def _(event: Renderer, room):
    return (room.attach_renderer if event.comes else room.detach_renderer)(event.stamp_ns), None


REACTION_S = [sum(step.duration_s for step in r.steps) for r in RULES.reactions.values()]
PAUSES = st.one_of(
    st.integers(0, to_ns(3)),
    st.integers(0, to_ns(25)),
    # just before, at and just after whatever may fall due
    st.builds(
        lambda seconds, extra: max(0, to_ns(seconds) + extra),
        st.sampled_from([0, RULES.attention_s, *REACTION_S, *(2 * s for s in REACTION_S)]),
        st.integers(-1, 1),
    ),
)
CHANGES = [(thing.name, state) for thing in RULES.objects.values() for state in thing.states]
MAKERS = st.one_of(
    st.builds(
        lambda name: lambda at, _: Gesture(at, name),
        st.sampled_from([*DISCOMFORTS, HELLO, "shrug"]),
    ),
    st.builds(
        lambda change: lambda at, _: ObjectChanged(at, *change),
        st.sampled_from(CHANGES),
    ),
    st.builds(
        lambda status, back: lambda at, newest: Ack(at, f"s/c{newest - back}", status),
        st.sampled_from(AckStatus),
        st.sampled_from([0, 0, 0, 1, -1]),
    ),
    st.builds(lambda comes: lambda at, _: Renderer(at, comes), st.booleans()),
    st.just(lambda at, _: BodyLost(at, 1)),
)
MOVES = st.tuples(PAUSES, MAKERS)


@st.composite
def histories(draw):
    """Rules and events in order of time; acks speak of the newest command or one beside it."""
    rules = draw(st.sampled_from([RULES, ALL_PREEMPT]))
    room = Room(rules, "s")
    now_ns, newest, events = 0, 0, []
    for pause_ns, make in draw(st.lists(MOVES, max_size=6) | st.lists(MOVES, min_size=12)):
        now_ns += pause_ns
        newest += len(room.advance(now_ns))
        event = make(now_ns, newest)
        newest += len(tell(event, room)[0])
        events.append(event)
    return rules, events


def perform(rules, events, looks=()):
    """Every command, and every event's answer and snapshot, with extra looks at the clock."""
    room, commands, answers = Room(rules, "s"), [], []
    looks = sorted(looks)
    for event in events:
        while looks and looks[0] <= event.stamp_ns:
            commands += room.advance(looks.pop(0))
        sent, answer = tell(event, room)
        commands += sent
        answers.append((answer, room.snapshot()))
    commands += room.advance(events[-1].stamp_ns + to_ns(100) if events else 0)
    return commands, answers, room.snapshot()


@laws
@given(histories(), st.data())
def test_looking_at_the_clock_more_often_changes_nothing(history, data):
    rules, events = history
    end_ns = events[-1].stamp_ns if events else 0
    stamps = [event.stamp_ns for event in events]
    looks = data.draw(st.lists(st.integers(0, end_ns), max_size=20))
    once = perform(rules, events)
    assert perform(rules, events) == once
    assert perform(rules, events, looks) == once
    assert perform(rules, events, stamps) == once
    assert perform(rules, events, range(0, end_ns, max(1, end_ns // 200))) == once
    for command in once[0]:
        note(command.reaction)


@laws
@given(histories())
def test_a_look_right_after_an_event_finds_nothing_left_to_do(history):
    rules, events = history
    room = Room(rules, "s")
    for event in events:
        tell(event, room)
        before = room.snapshot()
        assert room.advance(event.stamp_ns) == ()
        assert room.snapshot() == before
        assert (room.deadline() or event.stamp_ns + 1) > event.stamp_ns


@laws
@given(histories())
def test_objects_stay_in_declared_states(history):
    rules, events = history
    changing = {thing.name: thing.states for thing in rules.objects.values() if thing.states}
    for _, snapshot in perform(rules, events)[1]:
        assert snapshot.objects.keys() == changing.keys()
        assert all(state in changing[name] for name, state in snapshot.objects.items())


@laws
@given(histories())
def test_commands_are_numbered_and_dated_in_order(history):
    commands, _, _ = perform(*history)
    assert [command.sequence for command in commands] == list(range(1, len(commands) + 1))
    assert [command.id for command in commands] == [f"s/c{c.sequence}" for c in commands]
    stamps = [command.issued_ns for command in commands]
    assert stamps == sorted(stamps)


@laws
@given(histories())
def test_the_agent_does_one_thing_at_a_time(history):
    rules, events = history
    room, running, sent = Room(rules, "s"), None, {}
    for event in events:
        for command in (*room.advance(event.stamp_ns), *tell(event, room)[0]):
            # whatever was still going on when a command was sent is named by it
            assert command.preempts in (None, running)
            sent[command.id] = command
            running = command.id
        now = room.snapshot()
        assert now.command_id in (None, running)
        running = now.command_id
        if now.mode is AgentMode.REACTING:
            assert sent[running].reaction != RESUME_WORK
        else:
            assert running is None or sent[running].reaction == RESUME_WORK
        if now.mode is AgentMode.ATTENTION:
            assert running is None


@laws
@given(histories())
def test_every_reaction_ends_in_attention_and_attention_in_work(history):
    """Followed from deadline to deadline, so that no change of mode goes unseen."""
    rules, events = history
    room, mode, commands = Room(rules, "s"), AgentMode.WORKING, []
    allowed = {
        (AgentMode.WORKING, AgentMode.REACTING): set(rules.reactions) - {RESUME_WORK},
        (AgentMode.ATTENTION, AgentMode.REACTING): set(rules.reactions) - {RESUME_WORK},
        (AgentMode.REACTING, AgentMode.ATTENTION): {None},
        (AgentMode.ATTENTION, AgentMode.WORKING): {RESUME_WORK},
        # attention that is over when it begins
        (AgentMode.REACTING, AgentMode.WORKING): {RESUME_WORK},
    }

    def follow(sent):
        nonlocal mode
        commands.extend(sent)
        after = room.snapshot().mode
        if after is not mode:
            assert (sent[-1].reaction if sent else None) in allowed[mode, after]
            mode = after

    for event in events:
        while (due_ns := room.deadline()) is not None and due_ns <= event.stamp_ns:
            follow(room.advance(due_ns))
        follow(tell(event, room)[0])
    while (due_ns := room.deadline()) is not None:
        follow(room.advance(due_ns))
    assert mode is AgentMode.WORKING
    reacted = [command.reaction != RESUME_WORK for command in commands]
    assert not reacted or not reacted[-1]
    assert all(reacted[index - 1] for index, is_reaction in enumerate(reacted) if not is_reaction)


@laws
@given(histories())
def test_attention_ends_no_sooner_than_it_may(history):
    rules, events = history
    commands, _, _ = perform(rules, events)
    for command in commands:
        if command.reaction == RESUME_WORK:
            earlier = [e for e in events if e.stamp_ns <= command.issued_ns]
            gestures = [e.stamp_ns for e in earlier if isinstance(e, Gesture)]
            if command.cause == "attention_timeout":
                # a gesture in the very moment of the end comes after it
                before = [at for at in gestures if at < command.issued_ns]
                assert command.issued_ns - max(before) >= to_ns(rules.attention_s)
            else:
                assert any(isinstance(e, BodyLost) for e in earlier)


@laws
@given(histories())
def test_a_verdict_tells_why_there_is_a_command_or_none(history):
    rules, events = history
    for (answer, snapshot), event in zip(perform(rules, events)[1], events, strict=True):
        if not isinstance(event, Gesture):
            continue
        outcome, command, verdict = answer
        assert (command is not None) == (outcome is Outcome.COMMAND)
        assert verdict.met == (outcome is not Outcome.NOTHING_TO_DO)
        assert verdict.reason
        if command is None:
            assert snapshot.mode.value == verdict.mode
        else:
            assert snapshot.command_id == command.id
            assert snapshot.mode is AgentMode.REACTING


@laws
@given(histories())
def test_only_one_word_ends_a_command(history):
    rules, events = history
    over, answers = set(), perform(rules, events)[1]
    for event, (taken, _) in zip(events, answers, strict=True):
        if isinstance(event, Ack):
            assert not (taken and event.command_id in over)
            if taken and event.status in (AckStatus.DONE, AckStatus.FAILED):
                over.add(event.command_id)


@laws
@given(histories())
def test_without_a_renderer_objects_change_only_by_reactions_and_by_hand(history):
    rules, events = history
    events = [event for event in events if not isinstance(event, Ack | Renderer)]
    room = Room(rules, "s")
    before, started = room.snapshot(), None
    for event in events:
        while (due_ns := room.deadline()) is not None and due_ns <= event.stamp_ns:
            sent = room.advance(due_ns)
            after = room.snapshot()
            expected = dict(before.objects)
            if before.command_id is not None:
                effects = rules.reactions[started.reaction].effects
                expected.update({effect.object: effect.state for effect in effects})
                nominal_ns = to_ns(started.duration_s)
                assert due_ns == started.issued_ns + nominal_ns
            assert after.objects == expected
            before, started = after, sent[-1] if sent else started
        sent, _ = tell(event, room)
        after = room.snapshot()
        changed = {event.object: event.state} if isinstance(event, ObjectChanged) else {}
        assert after.objects == {**before.objects, **changed}
        before, started = after, sent[-1] if sent else started
