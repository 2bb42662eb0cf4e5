"""The other side's clock, against clocks that are known."""

from random import Random

import pytest

from agent_server.protocol.clock_estimate import ClockEstimate

MS = 1_000_000


def exchange(estimate, at_ns, offset_ns, there_ns=MS, back_ns=MS):
    """One ping at ``at_ns`` to a clock that is ``offset_ns`` ahead."""
    return estimate.push(at_ns, at_ns + there_ns + offset_ns, at_ns + there_ns + back_ns)


def test_nothing_is_known_before_the_first_pong():
    estimate = ClockEstimate()
    assert (estimate.offset_ns, estimate.round_trip_ns) == (None, None)


def test_the_first_sample_counts_as_it_is():
    estimate = ClockEstimate()
    assert exchange(estimate, 0, 123 * MS) is None
    assert (estimate.offset_ns, estimate.round_trip_ns) == (123 * MS, 2 * MS)


@pytest.mark.parametrize("offset_ns", [0, 10**15, -(10**15)])
def test_it_stays_within_half_a_round_trip_on_a_bad_network(offset_ns):
    random = Random(5)
    estimate = ClockEstimate()
    for index in range(200):
        there, back = (MS + int(random.expovariate(1 / (20 * MS))) for _ in range(2))
        exchange(estimate, index * 2000 * MS, offset_ns, there, back)
        if index >= 20:
            assert abs(estimate.offset_ns - offset_ns) < 15 * MS
    assert estimate.jumps == 0


def test_a_drifting_clock_is_followed():
    estimate = ClockEstimate()
    for index in range(100):
        # 50 parts in a million: 0.1 ms between two pings.
        exchange(estimate, index * 2000 * MS, index * MS // 10)
    assert abs(estimate.offset_ns - 99 * MS // 10) < 2 * MS
    assert estimate.jumps == 0


def test_a_jump_is_told_after_three_samples_and_followed_at_once():
    estimate = ClockEstimate()
    for index in range(10):
        exchange(estimate, index * 2000 * MS, 0)
    told = [exchange(estimate, (10 + index) * 2000 * MS, 3_600_000 * MS) for index in range(4)]
    assert told == [None, None, 3_600_000 * MS, None]
    assert estimate.offset_ns == 3_600_000 * MS
    assert estimate.jumps == 1


@pytest.mark.parametrize(("there_ns", "back_ns"), [(600 * MS, MS), (MS, 600 * MS)])
def test_a_first_pong_that_was_slow_on_one_way_is_no_jump(there_ns, back_ns):
    estimate = ClockEstimate()
    exchange(estimate, 0, 0, there_ns, back_ns)
    for index in range(1, 10):
        assert exchange(estimate, index * 2000 * MS, 0) is None
        assert abs(estimate.offset_ns) <= MS
    assert estimate.jumps == 0


def test_single_outliers_to_either_side_are_no_jump():
    estimate = ClockEstimate()
    exchange(estimate, 0, 0)
    for index in range(12):
        wild = 500 * MS if index % 4 < 2 else -500 * MS
        assert exchange(estimate, (index + 1) * 2000 * MS, wild) is None
    assert estimate.offset_ns == 0


def test_a_pong_from_the_future_is_passed_over():
    estimate = ClockEstimate()
    assert estimate.push(10, 0, 9) is None
    assert estimate.offset_ns is None
