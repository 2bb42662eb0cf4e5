"""Several clocks on one time line."""

import pytest

from agent_server.errors import InvalidInput
from agent_server.service.timeline import MAX_LEAD_NS, Timeline

S = 1_000_000_000


class Line(Timeline):
    """A time line whose messages are all taken."""

    def take(self, connection, stamp_ns, arrival_ns):
        mapped = self.map(connection, stamp_ns, arrival_ns)
        self.accept(connection, stamp_ns, mapped, arrival_ns)
        return mapped


def test_the_first_sensor_sets_the_line_and_keeps_its_stamps():
    line = Line()
    assert line.now(50 * S) == 0
    assert line.idle_ns(50 * S) == 0
    for index in range(5):
        assert line.take(1, 7 * S + index, 100 * S + 3 * index) == 7 * S + index


def test_time_goes_on_with_the_servers_clock_between_messages():
    line = Line()
    line.take(1, 7 * S, 100 * S)
    assert line.now(103 * S) == 10 * S
    assert line.idle_ns(103 * S) == 3 * S


def test_another_clock_is_mapped_by_its_first_arrival():
    line = Line()
    line.take(1, 7 * S, 100 * S)
    assert line.take(2, 500 * S, 101 * S) == 8 * S
    assert line.take(2, 501 * S, 150 * S) == 9 * S


def test_a_sensor_that_comes_back_with_a_new_clock_goes_on_where_time_is():
    line = Line()
    line.take(1, 7 * S, 100 * S)
    line.forget(1)
    assert line.take(3, 0, 110 * S) == 17 * S


def test_a_late_stamp_does_not_turn_time_back():
    line = Line()
    line.take(1, 7 * S, 100 * S)
    assert line.take(1, 6 * S, 101 * S) == 6 * S
    assert line.now(101 * S) == 8 * S


def test_what_is_mapped_but_not_taken_leaves_time_alone():
    line = Line()
    line.take(1, 7 * S, 100 * S)
    assert line.map(1, 30 * S, 100 * S) == 30 * S
    assert line.map(2, 0, 100 * S) == 7 * S
    assert line.now(100 * S) == 7 * S
    assert line.take(2, 90 * S, 101 * S) == 8 * S


@pytest.mark.parametrize("stamp_ns", [7 * S + MAX_LEAD_NS + 2 * S, 2**53 - 1])
def test_a_stamp_far_in_the_future_is_refused(stamp_ns):
    line = Line()
    line.take(1, 7 * S, 100 * S)
    with pytest.raises(InvalidInput) as refused:
        line.take(1, stamp_ns, 101 * S)
    assert (refused.value.field, refused.value.code) == ("originating_ns", "out_of_range")
    assert line.take(1, 9 * S, 102 * S) == 9 * S


def test_a_stamp_before_the_start_of_the_session_is_refused():
    line = Line()
    line.take(1, S, 100 * S)
    line.take(2, 500 * S, 100 * S)
    with pytest.raises(InvalidInput):
        line.take(2, 490 * S, 101 * S)
