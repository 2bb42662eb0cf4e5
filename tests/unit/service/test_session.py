"""A session's shell, without a network: seats, time, hand-over, what is shown."""

import asyncio
from contextlib import asynccontextmanager, suppress

import msgspec
import pytest

from agent_server.clock import ManualClock
from agent_server.config import GateSettings, Settings
from agent_server.errors import InvalidInput
from agent_server.protocol import messages as m
from agent_server.protocol.convert import skeleton_to_message
from agent_server.scene.rules import default_rules
from agent_server.service.audience import Client
from agent_server.service.avatar import NoAvatar
from agent_server.service.journal import NoJournal
from agent_server.service.mailbox import Outbox
from agent_server.service.session import Opening, Session
from agent_server.service.store import MemoryStore
from agent_server.service.worker import InferenceWorker
from tests.support.bodies import stream
from tests.support.models import fake_models

S = 1_000_000_000
GESTURE = stream(4, hands_up=lambda t: t >= 1.5)


class Room:
    """A session with fake models and a clock that stands still."""

    def __init__(self):
        self.clock = ManualClock(1000 * S)
        self.worker = InferenceWorker(fake_models())
        settings = Settings(gate=GateSettings(mode="off"))
        self.session = Session(
            "s",
            settings,
            default_rules(),
            self.worker,
            self.clock,
            Opening("ledger", "epoch"),
            NoJournal(),
            MemoryStore(),
            NoAvatar(),
        )

    def join(self, role, **hello):
        client = Client(role, m.Hello(m.PROTOCOL, "t", **hello), Outbox(64))
        self.session.join(client)
        return client

    async def send(self, sensor, frames):
        for frame in frames:
            self.session.receive(sensor, skeleton_to_message(frame))
            self.clock.advance(33_333_333)
            await asyncio.sleep(0.002)


@asynccontextmanager
async def room():
    made = Room()
    tasks = [asyncio.create_task(made.worker.run()), asyncio.create_task(made.session.run())]
    yield made
    for task in tasks:
        task.cancel()
    for task in tasks:
        with suppress(asyncio.CancelledError):
            await task


async def posted(client, kind):
    """What waits for a client of one type."""
    client.outbox.update("error", m.Ping(0))  # there is always something to take
    return [message for message in await client.outbox.take() if isinstance(message, kind)]


async def test_a_refused_frame_neither_moves_time_nor_takes_a_seat():
    async with room() as r:
        first, second = r.join("sensor"), r.join("sensor", take_over=True)
        await r.send(first, GESTURE[:3])
        good = skeleton_to_message(GESTURE[5])
        for sender, bad in (
            (second, m.Skeleton(7, 0, "core9", good.joints[:4])),
            (first, m.Skeleton(10**15, 0, "core9", good.joints)),
            (first, m.Skeleton(10**12, 0, "core9", good.joints[:4])),
            (first, m.Skeleton(GESTURE[1].originating_ns, 0, "core9", good.joints)),
        ):
            with pytest.raises(InvalidInput):
                r.session.receive(sender, bad)
        assert first.outbox.close_code is None
        assert r.session.counters["frames"] == 3
        r.session.receive(first, good)
        assert r.session._context.now() == GESTURE[5].originating_ns


async def test_a_renderer_that_comes_back_gets_the_command_that_is_being_carried_out():
    async with room() as r:
        sensor, renderer = r.join("sensor"), r.join("renderer")
        await r.send(sensor, GESTURE)
        (command,) = await posted(renderer, m.CommandMessage)
        r.session.leave(renderer, for_good=True)
        again = r.join("renderer")
        (sent_again,) = await posted(again, m.CommandMessage)
        assert sent_again.age_ms == (r.session._context.now() - command.issued_ns) // 1_000_000 > 0
        assert msgspec.structs.replace(sent_again, age_ms=0) == command
        r.session.receive(again, m.AckMessage(command.id, "done"))
        assert r.session.delivery.scene().objects["hifi"] == "low"
        r.session.leave(again, for_good=True)
        assert await posted(r.join("renderer"), m.CommandMessage) == []


async def test_a_word_that_comes_too_late_does_not_hide_how_the_command_ended():
    async with room() as r:
        sensor, renderer = r.join("sensor"), r.join("renderer")
        monitor = r.join("monitor", topics=["command", "ack"])
        await r.send(sensor, GESTURE)
        (command,) = await posted(renderer, m.CommandMessage)
        r.clock.advance(command.ttl_ms * 1_000_000)
        # It is this very word that makes the session notice what time it is.
        r.session.receive(renderer, m.AckMessage(command.id, "started"))
        assert r.session.counters["stale_acks"] == 1
        told = await posted(monitor, m.AckTelemetry)
        assert [(one.command_id, one.status) for one in told] == [
            (command.id, "expired"),
            (command.id, "started"),
        ]


async def test_the_end_of_a_reaction_is_shown_although_no_command_follows():
    async with room() as r:
        sensor, monitor = r.join("sensor"), r.join("monitor", topics=["scene"])
        # Seven seconds are the nominal time of the reaction; the hands stay where they are.
        frames = stream(12, hands_up=lambda t: t >= 1.5)
        shown = []
        for begin in range(0, len(frames), 10):
            await r.send(sensor, frames[begin : begin + 10])
            shown += await posted(monitor, m.SceneState)
        assert [(scene.mode, scene.objects["hifi"]) for scene in shown] == [
            ("reacting", "high"),
            ("attention", "low"),
        ]


async def test_affect_that_comes_again_or_late_is_refused():
    async with room() as r:
        sensor = r.join("sensor")
        r.session.receive(sensor, m.Affect(2 * S, -6.0, 5.0))
        for stamp_ns in (2 * S, S):
            with pytest.raises(InvalidInput) as refused:
                r.session.receive(sensor, m.Affect(stamp_ns, 6.0, 5.0))
            assert refused.value.code == "out_of_order"
        assert r.session.counters["affect_samples"] == 1


async def test_a_pose_is_shown_once():
    async with room() as r:
        sensor, monitor = r.join("sensor"), r.join("monitor", topics=["pose"])
        stamps = []
        for frame in stream(2):
            await r.send(sensor, [frame])
            stamps += [pose.originating_ns for pose in await posted(monitor, m.PoseMessage)]
        assert len(stamps) == len(set(stamps)) > 40
