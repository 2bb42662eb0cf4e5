"""The figures behind the plots, on runs small enough to count by hand."""

import pytest

from agent_server.qa import measures
from agent_server.qa.compare import compare
from agent_server.qa.report.svg import ticks
from agent_server.qa.result import CaseResult, Check, ForecastError, Run, Step, Stretch, Thresholds
from agent_server.qa.suite import Limits
from agent_server.qa.totals import check_limits, total

GATE = Thresholds(-3.0, 3.0)


def step(at, best="idle", outcome="idle", gesture=None, reaction=None, valence=0.0, arousal=5.0):
    return Step(at // 200, at, best, 0.9, gesture or best, outcome, reaction, valence, arousal)


def case(labels, steps=(), name="a", **given):
    return CaseResult(name, "0", "passed", labels=list(labels), steps=list(steps), **given)


COLD = Stretch("cold", 1000, 3000, "close_window", False)
IDLE = Stretch("idle", 5000, 9000, None, True)


def test_a_gesture_is_what_it_was_held_for_longest():
    steps = [
        step(1400, "hot", "gated"),
        step(1600, "cold", "command", reaction="close_window"),
        step(1800, "cold", "handled"),
        step(2000, "cold", "unsure"),
    ]
    found = measures.confusion([case([COLD, IDLE], steps)])
    assert found.labels == ["cold", "idle"]
    assert found.counts == [[1, 0], [0, 1]]


def test_a_gesture_that_nothing_was_held_for_counts_as_idle_and_idle_as_what_was_done():
    steps = [step(2000, "cold", "unsure"), step(6000, "hello", "command", reaction="greet")]
    found = measures.confusion([case([COLD, IDLE], steps)])
    assert found.labels == ["cold", "hello", "idle"]
    assert found.counts == [[0, 0, 1], [0, 0, 0], [0, 1, 0]]


def test_accuracy_is_counted_by_the_time_seen():
    first = case([COLD], [step(1100), step(1300, "cold"), step(4000, "cold")])
    second = case([COLD], [step(1150, "cold")])
    curve = measures.accuracy_over_time([first, second])
    assert curve.x == pytest.approx([0.1, 0.3])
    assert (curve.y, curve.n) == ([0.5, 1.0], [2, 1])


def test_the_gate_is_judged_by_faces_in_gestures_against_faces_in_quiet():
    steps = [
        step(1500, valence=-5.0),
        step(2000, valence=-2.0),
        step(6000, valence=-4.0),
        step(7000, valence=-9.0, arousal=1.0),
        step(8000, valence=1.0),
    ]
    curve = measures.gate_curve([case([COLD, IDLE], steps)], GATE)
    assert curve.at == pytest.approx((1 / 3, 1 / 2))
    assert (curve.positives, curve.negatives) == (2, 3)
    assert (curve.false_pass[0], curve.true_pass[0]) == (0, 0)
    assert (curve.false_pass[-1], curve.true_pass[-1]) == (1, 1)
    # Of the six pairs the gesture's face is the less pleasant one in five.
    assert curve.area == pytest.approx(5 / 6)


def test_a_gesture_that_is_quiet_because_of_the_room_says_nothing_of_the_face():
    again = Stretch("cold", 6000, 7000, None, True)
    steps = [step(1500, valence=-5.0), step(6500, valence=-5.0)]
    assert measures.gate_curve([case([COLD, again], steps)], GATE) is None


def test_forecasts_are_averaged_over_the_windows_of_all_recordings():
    one = ForecastError([1, 0, 0, 0, 0, 0], [10.0, 0, 0, 0, 0, 0], [20.0, 0, 0, 0, 0, 0])
    two = ForecastError([3, 1, 0, 0, 0, 0], [90.0, 7.0, 0, 0, 0, 0], [60.0, 8.0, 0, 0, 0, 0])
    cases = [case([], forecast={"gesture": error}) for error in (one, two)]
    live, held = measures.forecast_curves(cases, "gesture")
    assert (live.x, live.y, live.n) == ([0.08, 0.16], [25.0, 7.0], [4, 1])
    assert held.y == [20.0, 8.0]
    assert measures.forecast_curves(cases, "idle") is None


def check(name, passed, delay=None):
    return Check("reaction", name, 0, passed, "", delay_ms=delay)


def test_totals_and_limits():
    checks = [check("a", True, 800), check("b", True, 1200), check("c", False)]
    sums = total([case([], checks=checks, false_at_ms=[5], judged_ms=1_800_000)])
    assert (sums.asked, sums.right, sums.met, sums.false_per_hour) == (3, 2, 2, 2.0)
    assert sums.delay_p50_ms == 1000
    found = check_limits(sums, Limits(min_right=0.6, max_false_per_hour=1, max_delay_p90_ms=1100))
    assert [limit.passed for limit in found] == [True, False, False]
    assert not check_limits(total([]), Limits(min_right=0.5))[0].passed


def run(*cases):
    return Run("s", "0", {}, "room.toml", GATE, list(cases))


def test_two_runs_are_compared_window_by_window():
    old = case([], [step(200), step(400, "cold", "gated"), step(600)], checks=[check("a", True)])
    new = case(
        [], [step(200), step(400, "cold", "command", reaction="close_window"), step(800)],
        checks=[check("a", False), check("b", True)],
    )  # fmt: skip
    gone = case([], name="gone")
    found = compare(run(old, gone), run(new))
    (change,) = found.changes
    assert (found.broken, found.mended, found.differing, found.decisions) == (1, 0, 1, 2)
    assert change.unpaired == 2
    assert [(a.outcome, b.outcome) for a, b in change.differing] == [("gated", "command")]
    assert (found.added, found.removed) == ([], ["gone"])


def test_a_run_is_as_itself():
    same = run(case([COLD], [step(200), step(400, "cold", "gated")], checks=[check("a", True)]))
    found = compare(same, same)
    assert not any(change.is_change for change in found.changes)


@pytest.mark.parametrize(
    ("low", "high", "wanted"),
    [(0, 1, [0, 0.2, 0.4, 0.6, 0.8, 1.0]), (0, 26, [0, 5, 10, 15, 20, 25]), (-0.3, 0.3, None)],
)
def test_ticks_are_round_and_within(low, high, wanted):
    found = ticks(low, high)
    assert all(low <= value <= high for value in found)
    assert "-0" not in [f"{value:g}" for value in found]
    assert wanted is None or found == pytest.approx(wanted)
