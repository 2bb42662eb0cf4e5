"""Outboxes: commands in order, telemetry only the latest."""

import asyncio

import pytest

from agent_server.protocol.messages import Missed, Ping
from agent_server.service.mailbox import Outbox, Overflow


async def test_what_is_posted_leaves_in_order_before_telemetry():
    box = Outbox(4)
    box.update("pose", Ping(9))
    box.post(Ping(1))
    box.post(Ping(2))
    box.precede(Ping(0))
    assert await box.take() == [Ping(0), Ping(1), Ping(2), Ping(9)]


async def test_only_the_latest_of_a_topic_waits_and_the_rest_is_counted():
    box = Outbox(4)
    for value in range(5):
        box.show("pose", Ping(value))
    box.show("stats", Ping(7))
    assert await box.take() == [Ping(4), Ping(7), Missed({"pose": 4})]
    assert box.missed == 4


async def test_too_many_commands_overflow():
    box = Outbox(2)
    box.post(Ping(1))
    box.post(Ping(2))
    with pytest.raises(Overflow):
        box.post(Ping(3))


async def test_taking_waits_until_there_is_something():
    box = Outbox(2)
    taking = asyncio.create_task(box.take())
    await asyncio.sleep(0)
    assert not taking.done()
    box.post(Ping(1))
    assert await taking == [Ping(1)]


async def test_closing_lets_what_waits_go_first_and_keeps_the_first_reason():
    box = Outbox(2)
    box.post(Ping(1))
    box.close(4409, "replaced")
    box.close(1000, "")
    assert await box.take() == [Ping(1)]
    assert await box.take() == []
    assert (box.close_code, box.close_reason) == (4409, "replaced")
