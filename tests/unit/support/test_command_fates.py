"""What is made of what was seen: lost, doubled and untold commands are found."""

from dataclasses import replace

from agent_server.domain.command import Command
from agent_server.domain.scene import AgentMode, RoomState
from tests.support.command_fates import UNTOLD, WRONG, Observed, summary

ROOM = RoomState(AgentMode.WORKING, {}, 0, 0, 0, 0)


def running(sequence):
    command = Command(f"s/c{sequence}", sequence, "greet", "hello", (), 1, None, 0, 0, 1000)
    return replace(ROOM, sequence=sequence, command=command)


def seen(*words):
    """What was seen of session ``s``, word by word: who said what of which command."""
    observed = Observed("s")
    for word in words:
        said, number = word.rsplit(" ", 1)
        one = f"s/c{number}"
        if said in ("effect", "command", "cancel"):
            observed.hear({"event": said, "id": one})
        elif said == "issued":
            ttl_ms = 400 if int(number) > 7 else 20_000
            observed.tell({"type": "command", "id": one, "sequence": int(number), "ttl_ms": ttl_ms})
        else:
            status, _, reason = said.partition(" ")
            observed.tell(
                {"type": "ack_state", "command_id": one, "status": status, "reason": reason}
            )
    return observed


def test_a_command_that_is_done_once_is_fine():
    figures = summary([seen("issued 1", "accepted 1", "command 1", "effect 1", "done 1")])
    assert figures["commands"] == figures["effects"] == 1
    assert figures["ends"] == {"done": 1}
    assert {fault: figures[fault] for fault in WRONG if figures[fault]} == {}


def test_a_command_without_an_end_is_lost():
    figures = summary([seen("issued 1", "started 1", "issued 2", "done 2", "effect 2")])
    assert figures["lost"] == ["s/c1"]


def test_a_gap_in_the_sequence_is_a_lost_command():
    assert summary([seen("issued 3", "done 3", "effect 3")])["lost"] == ["s/c1", "s/c2"]


def test_a_second_effect_and_a_second_order_are_found():
    twice = seen("issued 1", "command 1", "effect 1", "command 1", "effect 1", "done 1")
    figures = summary([twice])
    assert figures["doubled"] == figures["received_twice"] == ["s/c1"]


def test_a_command_that_is_said_to_be_done_has_an_effect():
    assert summary([seen("issued 1", "done 1")])["done_without_effect"] == ["s/c1"]


def test_a_second_command_of_an_id_is_found():
    figures = summary([seen("issued 1", "done 1", "effect 1", "issued 1")])
    assert figures["reissued"] == ["s/c1"]


def test_a_command_is_given_up_when_it_was_worth_waiting_for():
    ends = ("timed_out 1", "assumed 2", "expired 3", "preempted 4", "failed broken 5", "expired 8")
    issued = (f"issued {number}" for number in range(1, 9))
    figures = summary([seen(*issued, *ends)])
    assert figures["given_up"] == ["s/c1", "s/c2", "s/c3"]


def test_an_effect_that_nobody_ordered_is_found():
    assert summary([seen("issued 1", "done 1", "effect 1", "effect 2")])["never_issued"] == ["s/c2"]


def test_the_first_end_counts_and_a_later_one_is_noted():
    figures = summary([seen("issued 1", "preempted 1", "effect 1", "done 1", "preempted 1")])
    assert figures["ends"] == {"preempted": 1}
    assert figures["late_ends"] == {"done after preempted": 1}
    assert figures["effects_of_other_ends"] == {"preempted": 1}


def test_a_failure_is_called_by_its_reason():
    figures = summary([seen("issued 2", "failed expired 1", "failed broken 2")])
    assert figures["ends"] == {"expired": 1, "failed": 1}


def test_what_a_dead_server_did_not_tell_is_told_by_the_client():
    observed = seen("issued 1", "issued 2", "issued 3", "cancel 2", "effect 1")
    observed.die(running(4))
    assert [observed.fate(f"s/c{n}") for n in range(1, 5)] == ["done", "preempted", UNTOLD, None]


def test_what_was_open_when_the_server_died_must_end_afterwards():
    observed = seen("issued 1")
    observed.die(running(1))
    assert observed.fate("s/c1") is None
    observed.tell({"type": "ack_state", "command_id": "s/c1", "status": "done"})
    assert observed.fate("s/c1") == "done"


def test_what_was_issued_after_a_death_is_not_excused_by_it():
    observed = seen("issued 1", "done 1")
    observed.die(replace(ROOM, sequence=1))
    observed.tell({"type": "command", "id": "s/c2", "sequence": 2, "ttl_ms": 1})
    assert observed.fate("s/c2") is None
