"""What is left out under load, and in which order."""

from agent_server.protocol import messages as m
from agent_server.service.audience import Audience, Client
from agent_server.service.load import Load, LoadGauge
from agent_server.service.mailbox import Outbox


def pushed(gauge, lag_s, times=60):
    for _ in range(times):
        gauge.push(lag_s)
    return gauge.load


def test_telemetry_goes_first_then_windows_and_they_come_back_in_the_other_order():
    gauge = LoadGauge()
    order = [pushed(gauge, lag_s) for lag_s in (0.01, 0.12, 0.3, 0.2, 0.11, 0.08, 0.01)]
    assert order == [
        *(Load.NONE, Load.TELEMETRY, Load.WINDOWS),
        *(Load.WINDOWS, Load.TELEMETRY, Load.TELEMETRY, Load.NONE),
    ]


def test_one_hiccup_is_no_load():
    gauge = LoadGauge()
    assert not gauge.push(4.0)
    assert gauge.load is Load.NONE


async def test_monitors_are_told_what_was_left_out_and_get_all_that_matters():
    gauge = LoadGauge()
    audience = Audience(gauge)
    monitor = Client("monitor", m.Hello(m.PROTOCOL, "tester"), Outbox(8))
    renderer = Client("renderer", m.Hello(m.PROTOCOL, "tester"), Outbox(8))
    audience.clients = [monitor, renderer]
    assert audience.wants("pose")
    pushed(gauge, 0.5)
    assert not audience.wants("pose")
    audience.show("affect", m.AffectTelemetry(0, 1.0, 1.0, None, None, "mesh"))
    command = m.CommandMessage("s/c1", 1, "e", "greet", "hello", [], 5, 0, 0, 1000)
    audience.order(command)
    audience.show("error", m.ErrorMessage("x", "y"))
    assert await renderer.outbox.take() == [command]
    command_told, error, missed = await monitor.outbox.take()
    assert (command_told, error.code) == (command, "x")
    assert missed.topics == {"pose": 1, "affect": 1}
