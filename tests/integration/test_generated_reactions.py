"""A rule whose motion is generated, in a live session with a real websocket."""

import asyncio
import threading
from dataclasses import replace
from functools import partial

import msgspec
import numpy as np
import pytest

from agent_server.client import Options, Renderer
from agent_server.client.once import send_paced
from agent_server.clock import SystemClock
from agent_server.config import GateSettings, Settings
from agent_server.domain.command import Motion
from agent_server.protocol import messages as m
from agent_server.protocol.codec import CODECS
from agent_server.recording.reader import open_recording
from agent_server.scene.rules import default_rules
from agent_server.service.core import Core
from agent_server.service.recorder import recorder
from agent_server.service.replay import log_line, replay
from tests.support.bodies import stream
from tests.support.live import all_decisions, live, next_of
from tests.support.models import fake_models
from tests.support.reactor import HandReactor

SETTINGS = Settings(gate=GateSettings(mode="off"))
PACKED = m.SUBPROTOCOL_MSGPACK
PLAYS = m.Hello("1.0", "t", capabilities=["pose_stream"])
generated = partial(replace, motion=Motion.GENERATED)


def reacting(reactor):
    return replace(fake_models(), reactor=reactor)


async def streams(client, into):
    async for message in client:
        if isinstance(message, m.PoseStreamMessage | m.PackedPoseStreamMessage | m.CommandMessage):
            into.append(message)


async def listen(renderer, into):
    async for event in renderer:
        into.append(event)


async def send_ears(sensor, seconds=2.5):
    await send_paced(sensor, stream(seconds, hands_up=lambda t: t > 0.3), 2.0)


async def test_a_motion_follows_its_command_to_those_who_play_it():
    told, mirrored, plain = [], [], []
    mirror_hello = msgspec.structs.replace(PLAYS, mirror=True)
    async with (
        live(reacting(HandReactor()), SETTINGS, alter_rule=generated) as server,
        server.join("renderer", hello=PLAYS) as renderer,
        server.join("renderer", hello=mirror_hello, subprotocol=PACKED) as mirror,
        server.join("renderer", hello=m.Hello("1.0", "t", mirror=True)) as other,
        server.join("sensor") as sensor,
        asyncio.TaskGroup() as group,
    ):
        pairs = ((renderer, told), (mirror, mirrored), (other, plain))
        tasks = [group.create_task(streams(*pair)) for pair in pairs]
        await send_ears(sensor)
        await asyncio.sleep(0.3)
        for task in tasks:
            task.cancel()
    command, *stretches = told
    assert (command.reaction, command.motion) == ("turn_down_hifi", "generated")
    assert {stretch.command_id for stretch in stretches} == {command.id}
    assert sum(len(stretch.positions) for stretch in stretches) == 50
    assert [stretch.is_last for stretch in stretches] == [False] * (len(stretches) - 1) + [True]
    assert stretches[0].rate_hz == 25
    assert len(stretches[0].positions[0]) == len(stretches[0].joints) == 15
    assert sum(len(stretch.positions) for stretch in mirrored[1:]) == 50 * 15 * 12
    assert [type(message) for message in plain] == [m.CommandMessage]


@pytest.mark.parametrize("subprotocol", CODECS)
async def test_the_python_client_hands_on_the_motion_of_the_command_under_way(subprotocol):
    events = []
    async with (
        live(reacting(HandReactor()), SETTINGS, alter_rule=generated) as server,
        Renderer(
            Options(server.url, "s", subprotocol=subprotocol), capabilities=("pose_stream",)
        ) as renderer,
        server.join("sensor") as sensor,
        asyncio.TaskGroup() as group,
    ):
        listening = group.create_task(listen(renderer, events))
        await send_ears(sensor)
        await asyncio.sleep(0.3)
        listening.cancel()
    at = next(i for i, one in enumerate(events) if isinstance(one, m.CommandMessage))
    stretches = [one for one in events[at:] if isinstance(one, m.PoseStreamMessage)]
    assert len([one for one in events if isinstance(one, m.PoseStreamMessage)]) == len(stretches)
    assert {one.command_id for one in stretches} == {events[at].id}
    assert sum(len(one.positions) for one in stretches) == 50
    assert np.array(stretches[0].positions).shape[1:] == (15, 3)
    # In tenths of a millimetre, whatever the coding.
    heights = [joints[stretches[0].joints.index("head")][1] for joints in stretches[0].positions]
    assert heights == [round(height, 4) for height in heights]
    assert 1.0 < heights[0] < 2.0


async def test_a_motion_that_is_no_good_says_why_and_monitors_hear_of_it():
    async with (
        live(reacting(HandReactor(speed=9.0)), SETTINGS, alter_rule=generated) as server,
        server.join("renderer", hello=PLAYS) as renderer,
        server.join("monitor") as monitor,
        server.join("sensor") as sensor,
    ):
        await send_ears(sensor)
        stretch = await next_of(renderer, m.PoseStreamMessage)
        assert stretch.is_last
        assert "too fast" in stretch.fallback
        told = await next_of(monitor, m.ErrorMessage)
        assert told.code == "reaction_refused"
        assert server.hub.sessions["s"].counters["reactions_refused"] == 1


async def test_decisions_go_on_while_a_motion_is_made_and_its_end_stops_the_making():
    going = threading.Event()
    going.set()
    reactor = HandReactor(waits=lambda: going.wait(5.0))
    decisions = []
    async with (
        live(reacting(reactor), SETTINGS, alter_rule=generated) as server,
        server.join("renderer", hello=PLAYS) as renderer,
        server.join("monitor") as monitor,
        server.join("sensor") as sensor,
        asyncio.TaskGroup() as group,
    ):
        listening = group.create_task(all_decisions(monitor, decisions))
        going.clear()  # the generator stands still from its first pose on
        await send_ears(sensor, 4.0)
        command = await next_of(renderer, m.CommandMessage)
        await asyncio.sleep(0.2)
        commanded = next(i for i, one in enumerate(decisions) if one.decision.command)
        assert len(decisions) > commanded + 5
        reactor.made = 0
        for status in ("started", "failed"):
            await renderer.send(m.AckMessage(command.id, status))
        await asyncio.sleep(0.1)
        going.set()
        await asyncio.sleep(0.3)
        assert 0 < reactor.made < 30  # the stretch that was under way, and no other
        assert server.hub.sessions["s"].counters["reactions_generated"] == 0
        listening.cancel()


async def test_a_replay_writes_the_same_log_whatever_became_of_the_motion(tmp_path):
    decisions = []
    models = reacting(HandReactor())
    open_journal = partial(
        recorder, tmp_path, models=models, clock=SystemClock(), settings=SETTINGS, rules=b""
    )
    async with (
        live(models, SETTINGS, open_journal, alter_rule=generated) as server,
        server.join("renderer", hello=PLAYS),
        server.join("monitor") as monitor,
        server.join("sensor") as sensor,
        asyncio.TaskGroup() as group,
    ):
        listening = group.create_task(all_decisions(monitor, decisions))
        await send_ears(sensor)
        await asyncio.sleep(0.3)
        listening.cancel()
    (path,) = tmp_path.glob("s-*.mcap")
    rules = default_rules(models.classifier.labels)
    for gesture, own in rules.rules.items():
        rules.rules[gesture] = tuple(map(generated, own))
    again = reacting(HandReactor(speed=9.0))
    core = Core("s", SETTINGS, rules, again)
    replayed = [log_line(decision) for decision in replay(open_recording(path), core, again)]
    assert replayed == [msgspec.json.encode(message.decision) for message in decisions]
    assert any(b'"motion":"generated"' in line for line in replayed)
    motion = [one.message for one in open_recording(path).records() if one.topic == "/motion"]
    assert sum(len(stretch.positions) for stretch in motion) == 50
    assert {stretch.command_id for stretch in motion} == {
        message.decision.command.id for message in decisions if message.decision.command
    }
