"""How fast a client is read: turns for others, and no more than so many a second."""

from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.protocol.pace import TURN_NS, Pace


def test_who_sends_now_and_then_never_waits():
    pace = Pace(1000)
    assert {pace.wait_ns(at * 25 * NS_PER_MS) for at in range(40, 200)} == {None}


def test_in_a_burst_others_have_their_turn_after_each_message():
    pace = Pace(10**6)
    assert pace.wait_ns(5 * NS_PER_S) is None
    assert [pace.wait_ns(5 * NS_PER_S + at * TURN_NS // 2) for at in range(1, 50)] == [0] * 49


def test_a_second_s_worth_goes_through_at_once_and_then_one_after_the_other():
    pace, now_ns = Pace(100), 5 * NS_PER_S
    waits = [pace.wait_ns(now_ns) for _ in range(150)]
    assert not any(waits[:100])
    assert waits[101:104] == [20 * NS_PER_MS, 30 * NS_PER_MS, 40 * NS_PER_MS]
    # Who has waited may go on, and after a second of silence all is forgiven.
    assert pace.wait_ns(now_ns + 2 * NS_PER_S) is None
