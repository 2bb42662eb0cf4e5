"""Commands take effect once: every row of the table in docs/clients.md."""

import pytest

from agent_server.client.ledger import REMEMBERED, CommandLedger
from agent_server.protocol.messages import AckMessage, CommandMessage, StepMessage

MS = 1_000_000


def command(sequence, *, age_ms=0, ttl_ms=5000):
    return CommandMessage(
        id=f"s/c{sequence}",
        sequence=sequence,
        epoch="e",
        reaction="greet",
        cause="hello",
        steps=[StepMessage("look_at_person", 2.0)],
        priority=5,
        originating_ns=0,
        issued_ns=0,
        ttl_ms=ttl_ms,
        age_ms=age_ms,
    )


def ack(sequence, status, step=None, reason=None):
    return AckMessage(f"s/c{sequence}", status, step, reason)


@pytest.fixture
def ledger():
    made = CommandLedger()
    assert made.welcome("first") is None
    return made


def test_a_new_command_is_accepted_and_ordered(ledger):
    taken = ledger.take(command(1), 0)
    assert taken.acks == (ack(1, "accepted"),)
    assert taken.cancelled is None
    assert taken.order == command(1)
    assert (ledger.running, ledger.sequence) == (command(1), 1)


@pytest.mark.parametrize("until", ["accepted", "started", "progress", "done", "failed"])
def test_a_known_command_gets_its_last_word_again_and_nothing_happens(ledger, until):
    last = ledger.take(command(1), 0).acks[-1]
    if until != "accepted":
        _, last = ledger.start("s/c1", 1)
    if until == "progress":
        last = ledger.progress("s/c1", 0)
    if until == "done":
        last = ledger.finish("s/c1")
    if until == "failed":
        last = ledger.finish("s/c1", "the window is stuck")
    again = ledger.take(command(1, age_ms=100), 2)
    assert again.acks == (last,)
    assert last.status == until
    assert again.order is None
    assert again.cancelled is None


def test_one_that_comes_too_late_has_expired(ledger):
    taken = ledger.take(command(1, age_ms=5000), 0)
    assert taken.acks == (ack(1, "failed", reason="expired"),)
    assert taken.order is None
    assert (ledger.running, ledger.sequence) == (None, 1)


def test_one_that_is_older_than_a_known_one_is_not_carried_out(ledger):
    ledger.take(command(3), 0)
    taken = ledger.take(command(2), 1)
    assert taken.acks == (ack(2, "failed", reason="preempted"),)
    assert taken.order is None
    assert ledger.running == command(3)


def test_a_newer_one_cuts_the_running_one_short(ledger):
    ledger.take(command(1), 0)
    ledger.start("s/c1", 0)
    taken = ledger.take(command(2), 1)
    assert taken.acks == (ack(1, "failed", reason="preempted"), ack(2, "accepted"))
    assert taken.cancelled == command(1)
    assert taken.order == command(2)
    assert ledger.finish("s/c1") is None


@pytest.mark.parametrize(("after_ms", "may"), [(4000, True), (4001, False)])
def test_what_is_left_of_its_time_counts_from_its_arrival(ledger, after_ms, may):
    ledger.take(command(1, age_ms=1000), 7)
    started, said = ledger.start("s/c1", 7 + after_ms * MS)
    assert started is may
    assert said == (ack(1, "started") if may else ack(1, "failed", reason="expired"))
    assert (ledger.running is None) is not may


def test_nothing_starts_twice(ledger):
    ledger.take(command(1), 0)
    assert ledger.start("s/c1", 1)[0]
    assert ledger.start("s/c1", 2) == (False, None)


def test_progress_and_the_end_need_a_start(ledger):
    ledger.take(command(1), 0)
    assert ledger.progress("s/c1", 0) is None
    assert ledger.finish("s/c1") is None
    assert ledger.finish("s/c1", "cannot") == ack(1, "failed", reason="cannot")
    assert ledger.finish("s/c1", "cannot") is None


def test_words_on_what_is_over_or_unknown_are_not_said(ledger):
    ledger.take(command(1), 0)
    ledger.start("s/c1", 0)
    assert ledger.finish("s/c1") == ack(1, "done")
    for name in ("s/c1", "s/c9"):
        assert ledger.start(name, 1) == (False, None)
        assert ledger.progress(name, 0) is None
        assert ledger.finish(name) is None


def test_another_ledger_makes_everything_forgotten(ledger):
    ledger.take(command(7), 0)
    ledger.start("s/c7", 0)
    assert ledger.welcome("first") is None
    assert ledger.welcome("second") == command(7)
    assert (ledger.running, ledger.sequence) == (None, 0)
    assert ledger.take(command(7), 1).order == command(7)


def test_the_last_word_on_what_is_open_can_be_said_again(ledger):
    assert ledger.open_ack() is None
    ledger.take(command(1), 0)
    assert ledger.open_ack() == ack(1, "accepted")
    ledger.start("s/c1", 0)
    ledger.progress("s/c1", 2)
    assert ledger.open_ack() == ack(1, "progress", 2)
    ledger.finish("s/c1")
    assert ledger.open_ack() is None


def test_the_ends_of_the_last_commands_are_remembered(ledger):
    for sequence in range(1, REMEMBERED + 3):
        ledger.take(command(sequence), 0)
        ledger.start(f"s/c{sequence}", 0)
        ledger.finish(f"s/c{sequence}")
    assert ledger.take(command(3), 1).acks == (ack(3, "done"),)
    # What is forgotten is older than what is known, and not carried out either.
    assert ledger.take(command(1), 1).acks == (ack(1, "failed", reason="preempted"),)
