import pytest

from agent_server.domain.command import Ack, AckStatus
from agent_server.domain.motion import BodyLost
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.stamp import to_ns
from agent_server.scene.room import Room
from agent_server.scene.rules import default_rules


class Stage:
    """A room told about in seconds, and everything it has sent."""

    def __init__(self, rules=None, renderer=False):
        self.room = Room(rules or default_rules(), "s")
        self.sent = []
        if renderer:
            self.take(self.room.attach_renderer(0))

    def take(self, commands):
        self.sent.extend(commands)
        return commands

    def gesture(self, gesture, at_s):
        considered = self.room.consider(gesture, to_ns(at_s) - 7, to_ns(at_s))
        self.take(considered.commands)
        return considered

    def ack(self, command, status, at_s):
        answer = self.room.acknowledge(Ack(to_ns(at_s), command.id, AckStatus(status)))
        self.take(answer.commands)
        return answer.taken

    def hand(self, thing, state, at_s=0):
        self.take(self.room.change(ObjectChanged(to_ns(at_s), thing, state)))

    def leave(self, at_s):
        self.take(self.room.lose_body(BodyLost(to_ns(at_s), 1)))

    def attach(self, at_s):
        self.take(self.room.attach_renderer(to_ns(at_s)))

    def detach(self, at_s):
        self.take(self.room.detach_renderer(to_ns(at_s)))

    def at(self, at_s):
        self.take(self.room.advance(to_ns(at_s)))
        return self.room.snapshot()

    def mode(self, at_s):
        return self.at(at_s).mode.value

    @property
    def story(self):
        return [(c.reaction, c.cause, c.issued_ns / 1e9) for c in self.sent]


@pytest.fixture
def new_stage():
    return Stage
