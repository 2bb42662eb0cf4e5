"""What is stuck is seen from outside, said, counted, and makes the server unready."""

import logging
import time

from agent_server.service import watchdog as module
from agent_server.service.watchdog import Watchdog

STUCK_S = 0.2


def watching(busy_s=lambda: None):
    dog = Watchdog(STUCK_S, busy_s)
    dog.start()
    return dog


def hold_up_the_loop():
    time.sleep(4 * STUCK_S)


def test_a_stuck_loop_is_named_with_its_place(caplog):
    dog = watching()
    assert dog.is_well
    hold_up_the_loop()
    dog.stop()
    assert (dog.loop_stalls, dog.inference_stalls) == (1, 0)
    assert not dog.is_well
    (record,) = [one for one in caplog.records if one.levelno == logging.ERROR]
    assert "hold_up_the_loop" in record.getMessage()


def test_models_that_do_not_come_back_are_named_and_recovery_takes_a_moment(caplog, monkeypatch):
    monkeypatch.setattr(module, "RECOVERY_S", 0.5)
    began_s = [time.monotonic()]
    dog = watching(lambda: began_s[0])
    for _ in range(8):
        time.sleep(STUCK_S / 2)
        dog.beat()
    assert (dog.loop_stalls, dog.inference_stalls) == (0, 1)
    assert not dog.is_well
    began_s[0] = None
    for _ in range(8):
        time.sleep(STUCK_S / 2)
        dog.beat()
    dog.stop()
    assert dog.is_well
    assert [record.levelno for record in caplog.records] == [logging.ERROR, logging.WARNING]


def test_all_is_well_while_both_get_on(caplog):
    dog = watching(time.monotonic)
    for _ in range(12):
        time.sleep(STUCK_S / 4)
        dog.beat()
    dog.stop()
    assert dog.is_well
    assert not caplog.records
