"""Reactions against expectations."""

from agent_server.domain.label import Label
from agent_server.domain.stamp import to_ns
from agent_server.qa.judge import Reaction, judge
from agent_server.qa.suite import Absent, Expected, Terms


def label(gesture, onset, offset, expected=None, quiet=False):
    return Label(gesture, to_ns(onset), to_ns(offset), "s", expected, quiet)


COLD = label("cold", 4.0, 7.0, "close_window")


def check(reactions, labels=(COLD,), duration=20_000, **terms):
    return judge([Reaction(*r) for r in reactions], labels, Terms(**terms), duration)


def reaction_checks(judgement):
    return [c for c in judgement.checks if c.kind == "reaction"]


def test_a_reaction_in_time_passes_with_its_delay():
    (found,) = reaction_checks(check([(5500, "close_window")]))
    assert (found.passed, found.delay_ms, found.got) == (True, 1500, "close_window")


def test_a_reaction_counts_until_a_moment_after_the_gesture():
    assert reaction_checks(check([(8000, "close_window")]))[0].passed
    late = check([(8001, "close_window")])
    assert not reaction_checks(late)[0].passed
    assert late.false_at_ms == [8001]


def test_a_late_reaction_fails_but_is_no_false_one():
    judgement = check([(6500, "close_window")], within_ms=2000)
    (found,) = reaction_checks(judgement)
    assert not found.passed
    assert "500 ms late" in found.detail
    assert judgement.false_at_ms == []


def test_the_first_reaction_answers_and_another_one_is_false():
    judgement = check([(5000, "greet"), (5500, "close_window")])
    (found,) = reaction_checks(judgement)
    assert not found.passed
    assert found.got == "greet"
    assert "not close_window" in found.detail
    assert judgement.false_at_ms == [5500]


def test_no_reaction_fails():
    (found,) = reaction_checks(check([]))
    assert (found.passed, found.delay_ms, found.detail) == (False, None, "no reaction came")


def test_quiet_is_broken_by_any_reaction_in_it():
    quiet = label("idle", 10.0, 15.0, quiet=True)
    judgement = check([(5000, "close_window"), (12_000, "greet")], [COLD, quiet])
    (found,) = [c for c in judgement.checks if c.kind == "quiet"]
    assert not found.passed
    assert "greet at 12.0 s" in found.detail
    assert judgement.false_at_ms == [12_000]


def test_so_many_reactions_may_be_allowed_in_quiet():
    quiet = [label("idle", a, a + 1.0, quiet=True) for a in (1.0, 3.0)]
    reactions = [(1500, "greet"), (3500, "greet")]
    two = check(reactions, quiet, max_in_quiet=2)
    one = check(reactions, quiet, max_in_quiet=1)
    assert [c.passed for c in two.checks] == [True]
    assert [c.passed for c in one.checks] == [False]
    assert two.false_at_ms == [1500, 3500]


def test_where_a_label_neither_asks_nor_forbids_nothing_is_false_or_judged():
    judgement = check([(2000, "greet")], [label("idle", 1.0, 4.0)])
    assert judgement.checks == []
    assert judgement.false_at_ms == []
    assert judgement.judged_ms == 20_000 - 4000


def test_judged_time_is_what_no_expectation_covers_and_counts_overlaps_once():
    again = label("hot", 6.0, 9.0, "open_window")
    assert check([], [COLD]).judged_ms == 20_000 - 4000
    assert check([], [COLD, again]).judged_ms == 20_000 - 6000


def test_the_suite_may_ask_for_more_than_the_labels():
    extra = Expected("greet", onset_s=1.0, within_ms=1000, gesture="hello")
    absent = (Absent("close_window", to_s=10.0), Absent("*", from_s=15.0))
    judgement = check(
        [(1500, "greet"), (5000, "close_window"), (16_000, "greet")],
        [],
        expect=(extra,),
        absent=absent,
    )
    assert [(c.kind, c.passed) for c in judgement.checks] == [
        ("reaction", True),
        ("absent", False),
        ("absent", False),
    ]


def test_names_of_checks_are_unique_in_a_recording():
    labels = [COLD, label("cold", 14.0, 16.0, "close_window"), label("idle", 8, 14, quiet=True)]
    names = [c.name for c in check([], labels).checks]
    assert len(set(names)) == len(names)
