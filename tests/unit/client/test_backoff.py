"""Waiting times between attempts."""

from agent_server.client.backoff import Backoff


def test_the_bound_doubles_to_what_finds_a_restarted_server_within_two_seconds():
    backoff = Backoff(lambda: 1.0)
    assert [backoff.next_s(0.0) for _ in range(5)] == [0.25, 0.5, 1.0, 1.5, 1.5]


def test_a_long_outage_is_asked_about_less_often():
    backoff = Backoff(lambda: 1.0)
    for now_s in range(20):
        backoff.next_s(now_s)
    assert [backoff.next_s(20.0 + now_s) for now_s in range(6)] == [1.5, 3.0, 6.0, 12.0, 15.0, 15.0]


def test_a_live_connection_sets_it_back():
    backoff = Backoff(lambda: 1.0)
    for now_s in range(40):
        backoff.next_s(now_s)
    backoff.reset()
    assert [backoff.next_s(100.0 + now_s) for now_s in range(3)] == [0.25, 0.5, 1.0]


def test_it_waits_any_time_below_the_bound():
    numbers = iter((0.0, 0.5, 0.25))
    backoff = Backoff(lambda: next(numbers))
    assert [backoff.next_s(0.0) for _ in range(3)] == [0.0, 0.25, 0.25]
