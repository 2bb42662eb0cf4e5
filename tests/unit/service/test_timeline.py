"""Several clocks on one time line."""

from agent_server.service.timeline import Timeline

S = 1_000_000_000


def test_the_first_sensor_sets_the_line_and_keeps_its_stamps():
    line = Timeline()
    assert line.now(50 * S) == 0
    assert line.idle_ns(50 * S) == 0
    for index in range(5):
        assert line.map(1, 7 * S + index, 100 * S + 3 * index) == 7 * S + index


def test_time_goes_on_with_the_servers_clock_between_messages():
    line = Timeline()
    line.map(1, 7 * S, 100 * S)
    assert line.now(103 * S) == 10 * S
    assert line.idle_ns(103 * S) == 3 * S


def test_another_clock_is_mapped_by_its_first_arrival():
    line = Timeline()
    line.map(1, 7 * S, 100 * S)
    assert line.map(2, 500 * S, 101 * S) == 8 * S
    assert line.map(2, 501 * S, 150 * S) == 9 * S


def test_a_sensor_that_comes_back_with_a_new_clock_goes_on_where_time_is():
    line = Timeline()
    line.map(1, 7 * S, 100 * S)
    line.forget(1)
    assert line.map(3, 0, 110 * S) == 17 * S


def test_a_late_stamp_does_not_turn_time_back():
    line = Timeline()
    line.map(1, 7 * S, 100 * S)
    assert line.map(1, 6 * S, 101 * S) == 6 * S
    assert line.now(101 * S) == 8 * S
