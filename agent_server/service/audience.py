"""Who listens to a session, and what each of them gets."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from agent_server.domain.stamp import NS_PER_MS
from agent_server.protocol import messages as m
from agent_server.protocol.clock_estimate import ClockEstimate
from agent_server.protocol.codes import CLOSE_TOO_SLOW
from agent_server.service.load import Load, LoadGauge
from agent_server.service.mailbox import Outbox, Overflow


@dataclass(eq=False, slots=True)
class Client:
    """One connection of a session.

    Attributes:
        role: What it came as.
        hello: What it said of itself.
        outbox: What waits for it.
        clock: Its clock and how far away it is.
        differences: On what its objects and the room did not agree when it came.
    """

    role: m.Role
    hello: m.Hello
    outbox: Outbox
    clock: ClockEstimate = field(default_factory=ClockEstimate)
    differences: list[m.Difference] = field(default_factory=list)

    def wants(self, topic: m.Topic) -> bool:
        """Whether it asked for this kind of telemetry."""
        return self.hello.topics is None or topic in self.hello.topics

    def stats(self) -> m.ClientStats:
        """What monitors are told about it."""
        round_trip_ns, offset_ns = self.clock.round_trip_ns, self.clock.offset_ns
        return m.ClientStats(
            self.role,
            self.hello.client,
            None if round_trip_ns is None else round(round_trip_ns / NS_PER_MS, 3),
            None if offset_ns is None else round(offset_ns / NS_PER_MS, 3),
            self.outbox.missed,
        )


POSE_STREAM = "pose_stream"
"""Capability of a renderer that plays motion which is made while it plays."""
LEFT_OUT_FIRST: frozenset[m.Topic] = frozenset(("pose", "forecast", "affect", "stats"))
"""Telemetry that nobody is told while the server is loaded: the next of it makes it up."""


class Audience:
    """The clients of one session.

    Args:
        gauge: How loaded the server is.
    """

    def __init__(self, gauge: LoadGauge | None = None) -> None:
        self.clients: list[Client] = []
        self._gauge = gauge or LoadGauge()

    def having(self, role: m.Role) -> Iterator[Client]:
        """The clients that came as ``role``."""
        return (client for client in self.clients if client.role == role)

    @property
    def missed(self) -> int:
        """Telemetry messages that monitors were too slow for."""
        return sum(client.outbox.missed for client in self.having("monitor"))

    def wants(self, topic: m.Topic) -> bool:
        """Whether any monitor wants this kind of telemetry, and there is time for it."""
        if self._leaves_out(topic):
            self._skip(topic)
            return False
        return any(client.wants(topic) for client in self.having("monitor"))

    def show(self, topic: m.Topic, message: m.Message, key: str = "") -> None:
        """Give telemetry to the monitors; only the latest of a topic waits for a slow one.

        Args:
            topic: Kind of telemetry.
            message: The latest of it.
            key: Of what it is the latest, where a topic speaks of several things.
        """
        if self._leaves_out(topic):
            self._skip(topic)
            return
        for client in self.having("monitor"):
            if client.wants(topic):
                client.outbox.show(topic, message, key)

    def _leaves_out(self, topic: m.Topic) -> bool:
        return self._gauge.load >= Load.TELEMETRY and topic in LEFT_OUT_FIRST

    def _skip(self, topic: m.Topic) -> None:
        for client in self.having("monitor"):
            if client.wants(topic):
                client.outbox.skip(topic)

    @property
    def wants_motion(self) -> bool:
        """Whether any renderer plays motion that is made while it plays."""
        return any(POSE_STREAM in client.hello.capabilities for client in self.having("renderer"))

    def move(self, stretch: m.PoseStreamMessage) -> None:
        """Give a stretch of a motion to the renderers that play it.

        Of the stretches that wait for one that is slow, a newer command's take the place of an
        older one's.
        """
        for client in self.having("renderer"):
            if POSE_STREAM in client.hello.capabilities:
                client.outbox.update(f"pose_stream {stretch.first_frame}", stretch)

    def show_scene(self, scene: m.SceneState) -> None:
        """Give the room's state to monitors and renderers."""
        self.show("scene", scene)
        for client in self.having("renderer"):
            client.outbox.update("scene", scene)

    def order(self, command: m.CommandMessage) -> None:
        """Give a command to the renderers, mirrors included; one that is too slow is closed."""
        for client in self.having("renderer"):
            try:
                client.outbox.post(command)
            except Overflow:
                client.outbox.close(CLOSE_TOO_SLOW, "too many commands wait; read faster")
        self.show("command", command, command.id)
