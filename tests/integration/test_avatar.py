"""From a sensor's websocket to an avatar program's UDP port."""

import asyncio
import socket

import pytest
from pythonosc.osc_bundle import OscBundle

from agent_server.client.once import join
from agent_server.config import ServerSettings, Settings, VmcSettings
from agent_server.protocol.convert import skeleton_to_message
from agent_server.transports.server import address, bind, build_hub, serving
from tests.support.bodies import stream
from tests.support.models import fake_models


def received(program):
    """Everything that has arrived as (address, arguments)."""
    messages = []
    while True:
        try:
            datagram = program.recv(65536)
        except BlockingIOError:
            return messages
        messages += [(message.address, message.params) for message in OscBundle(datagram)]


@pytest.mark.parametrize(("show", "least"), [("observed", 70), ("predicted", 40)])
async def test_a_person_reaches_an_avatar_program(show, least):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as program:
        program.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
        program.bind(("127.0.0.1", 0))
        program.setblocking(False)
        vmc = VmcSettings(enabled=True, port=program.getsockname()[1], show=show)
        settings = Settings(server=ServerSettings(port=0), vmc=vmc)
        hub, listener = build_hub(settings, fake_models()), bind(settings)
        messages = []
        async with serving(hub, listener), join(address(listener), "s", "sensor") as sensor:
            for frame in stream(4, hands_up=lambda t: t > 2):
                await sensor.send(skeleton_to_message(frame))
                await asyncio.sleep(0.003)
                messages += received(program)
            await asyncio.sleep(0.1)
        messages += received(program)
    forearms = [
        arguments[4:]
        for path, arguments in messages
        if path == "/VMC/Ext/Bone/Pos" and arguments[0] == "RightLowerArm"
    ]
    assert len(forearms) >= least
    # Half turned back about the elbow: the hand is at the ear.
    assert forearms[-1][1] < -0.9 < forearms[0][1]
    assert messages[-1] == ("/VMC/Ext/OK", [0]), "the session is over"
