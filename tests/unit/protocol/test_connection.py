"""The sans-IO connection: hello, roles, errors that add up."""

import pytest

from agent_server.errors import InvalidInput
from agent_server.protocol import codes
from agent_server.protocol import connection as c
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS

S = 1_000_000_000
JSON = CODECS[m.SUBPROTOCOL_JSON]
HELLO = JSON.encode(m.Hello("1.3", "tester"))
AFFECT = JSON.encode(m.Affect(1, 0.0, 0.0))


def connection(role="sensor", *, greeted=True, max_errors=3):
    made = c.ServerConnection(
        "s",
        role,
        JSON,
        max_message_bytes=4096,
        max_image_bytes=9000,
        max_errors=max_errors,
        heartbeat_ns=2 * S,
    )
    if greeted:
        assert isinstance(made.receive(HELLO, 0), c.Greeted)
    return made


def test_hello_opens_and_a_minor_version_more_is_welcome():
    made = connection(greeted=False)
    event = made.receive(HELLO, 0)
    assert isinstance(event, c.Greeted)
    assert event.hello.client == "tester"
    assert made.state is c.State.OPEN


def test_a_wrong_major_version_is_refused_with_both_versions():
    made = connection(greeted=False)
    event = made.receive(JSON.encode(m.Hello("2.0", "tester")), 0)
    assert isinstance(event, c.Refused)
    assert event.close_code == codes.CLOSE_WRONG_VERSION
    assert "2.0" in event.error.message
    assert m.PROTOCOL in event.error.message
    assert made.state is c.State.CLOSED


@pytest.mark.parametrize("first", [AFFECT, "nonsense", '{"type":"hello"}'])
def test_anything_but_hello_comes_too_early(first):
    made = connection(greeted=False)
    event = made.receive(first, 0)
    assert isinstance(event, c.Refused)
    assert event.close_code == codes.CLOSE_BAD_HELLO
    assert event.error.fatal


def test_messages_of_the_role_pass_and_others_do_not():
    assert isinstance(connection("sensor").receive(AFFECT, 0), c.Received)
    for role in ("renderer", "monitor"):
        event = connection(role).receive(AFFECT, 0)
        assert isinstance(event, c.Refused)
        assert (event.error.code, event.error.field) == ("wrong_role", "type")
        assert role in event.error.message
        assert event.close_code is None


def test_a_second_hello_is_an_error():
    event = connection().receive(HELLO, 0)
    assert isinstance(event, c.Refused)
    assert "twice" in event.error.message


def test_a_ping_is_answered_with_the_servers_time_and_a_pong_with_nothing():
    made = connection("monitor")
    assert made.receive(JSON.encode(m.Ping(5)), 77) == c.Reply(m.Pong(5, 77))
    assert made.receive(JSON.encode(m.Pong(5, 6)), 78) is None


def test_a_message_over_the_limit_is_refused_unread():
    event = connection().receive("x" * 4097, 0)
    assert isinstance(event, c.Refused)
    assert event.error.code == "too_large"
    assert "4097" in event.error.message


def test_errors_that_go_on_end_the_connection():
    made = connection(max_errors=3)
    for _ in range(3):
        assert made.receive("nonsense", 0).close_code is None
    last = made.receive("nonsense", 0)
    assert last.close_code == codes.CLOSE_TOO_MANY_ERRORS
    assert last.error.fatal
    assert made.rejected == 4


def test_good_messages_pay_errors_back():
    made = connection(max_errors=3)
    for _ in range(50):
        assert made.receive("nonsense", 0).close_code is None
        for _ in range(10):
            assert isinstance(made.receive(AFFECT, 0), c.Received)


def test_an_error_found_further_in_counts_too():
    made = connection(max_errors=1)
    error = InvalidInput("late", field="originating_ns", code="out_of_order")
    assert made.refuse(error).error == m.ErrorMessage("out_of_order", "late", "originating_ns")
    assert made.refuse(error).close_code == codes.CLOSE_TOO_MANY_ERRORS


def test_a_closed_connection_stays_closed():
    made = connection()
    made.close()
    made.close()
    assert made.state is c.State.CLOSED
    with pytest.raises(RuntimeError, match="cannot go"):
        made._enter(c.State.OPEN)
