"""A live session: one core, its clients, and the models in between."""

import asyncio
import logging
from collections import Counter, deque
from collections.abc import Iterable
from dataclasses import dataclass, field

from agent_server.clock import Clock
from agent_server.config import Settings
from agent_server.domain.command import Command
from agent_server.domain.motion import BodyLost
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.errors import InferenceError, InvalidInput
from agent_server.protocol import convert
from agent_server.protocol import messages as m
from agent_server.protocol.connection import CLOSE_REPLACED, CLOSE_TOO_SLOW
from agent_server.scene.rules import Rules
from agent_server.service.core import Core, Job, PendingWindow
from agent_server.service.mailbox import Outbox, Overflow
from agent_server.service.timeline import Timeline
from agent_server.service.worker import Inference, InferenceWorker

log = logging.getLogger(__name__)

TICK_S = 0.25
QUIET_NS = NS_PER_S
"""Ticks let time pass only after this long without input; while input comes, it is the clock."""


@dataclass(eq=False, slots=True)
class Client:
    """One connection of a session.

    Attributes:
        role: What it came as.
        hello: What it said of itself.
        outbox: What waits for it.
        streams: Kinds of stream that it sends: ``body``, ``face``.
    """

    role: m.Role
    hello: m.Hello
    outbox: Outbox
    streams: set[str] = field(default_factory=set)


@dataclass(slots=True)
class _Waiting:
    job: Job
    arrival_ns: int


class Session:
    """Runs one person's stream through the core.

    Args:
        session: Its id.
        settings: All settings.
        rules: The room's rules.
        worker: The models.
        clock: Where to read the time.
        epoch: Changes with every start of the server.
    """

    def __init__(
        self,
        session: str,
        settings: Settings,
        rules: Rules,
        worker: InferenceWorker,
        clock: Clock,
        epoch: str,
    ) -> None:
        self.id = session
        self.clients: list[Client] = []
        self.counters: Counter[str] = Counter()
        self.sequence = 0
        self._epoch = epoch
        self._worker = worker
        self._clock = clock
        self._core = Core(session, settings, rules, worker.models.hashes)
        self._timeline = Timeline()
        self._owners: dict[str, Client] = {}
        self._renderer: Client | None = None
        self._jobs: deque[_Waiting] = deque()
        self._wake = asyncio.Event()
        self._is_inferring = False

    # ------------------------------------------------------------------ clients

    def join(self, client: Client) -> None:
        """Add a client.

        Raises:
            InvalidInput: If it wants to act as the renderer and another one does.
        """
        if client.role == "renderer" and not client.hello.mirror:
            self._seat_renderer(client)
        self.clients.append(client)
        if client.role == "sensor":
            self._update_face()

    def leave(self, client: Client) -> None:
        """Remove a client."""
        self.clients.remove(client)
        self._timeline.forget(id(client))
        for kind in client.streams:
            if self._owners.get(kind) is client:
                del self._owners[kind]
        if client.role == "sensor":
            self._update_face()
        if self._renderer is client:
            self._renderer = None
            self._deliver(self._core.set_renderer(False, self._now()))

    def scene(self) -> m.SceneState:
        """The room as it is."""
        return convert.scene_message(self._core.scene())

    @property
    def has_sensor(self) -> bool:
        """Whether a sensor is connected."""
        return any(client.role == "sensor" for client in self.clients)

    # ------------------------------------------------------------------ input

    def receive(self, client: Client, message: m.Message) -> None:
        """Take a message of a client.

        Raises:
            InvalidInput: If it is refused; nothing has changed then.
        """
        arrival_ns = self._clock.now_ns()
        match message:
            case m.Skeleton() | m.PackedSkeleton():
                self._own("body", client)
                frame = convert.skeleton_from_message(
                    message, self._timeline.map(id(client), message.originating_ns, arrival_ns)
                )
                self.counters["frames"] += 1
                self._enqueue(self._core.observe(frame), arrival_ns)
                self._show_pose()
            case m.Affect():
                self._own("face", client)
                sample = convert.affect_from_message(
                    message, self._timeline.map(id(client), message.originating_ns, arrival_ns)
                )
                self.counters["affect_samples"] += 1
                self._core.feel(sample)
                self._show(
                    "affect",
                    m.AffectTelemetry(sample.originating_ns, sample.valence, sample.arousal),
                )
            case m.AckMessage():
                self._require_acting(client)
                ack = convert.ack_from_message(message, self._now())
                self.counters["acks"] += 1
                self._deliver(self._core.acknowledge(ack))
                self._show(
                    "ack",
                    m.AckTelemetry(
                        message.command_id, message.status, message.step, message.reason
                    ),
                )
            case m.SceneEvent():
                self._require_acting(client)
                event = ObjectChanged(self._now(), message.object, message.state)
                self._deliver(self._core.change_object(event))
                self._show_scene()

    # ------------------------------------------------------------------ work

    async def run(self) -> None:
        """Deal with jobs until cancelled."""
        async with asyncio.TaskGroup() as group:
            group.create_task(self._work(), name=f"{self.id}: jobs")
            group.create_task(self._tick(), name=f"{self.id}: ticks")

    async def _work(self) -> None:
        while True:
            await self._wake.wait()
            self._wake.clear()
            while self._jobs:
                waiting = self._jobs.popleft()
                if isinstance(waiting.job, BodyLost):
                    self.counters["bodies_lost"] += 1
                    self._deliver(self._core.lose_body(waiting.job).commands)
                else:
                    await self._decide(waiting.job, waiting.arrival_ns)

    async def _decide(self, pending: PendingWindow, arrival_ns: int) -> None:
        started_ns = self._clock.now_ns()
        self._is_inferring = True
        try:
            inference = await self._worker.infer(pending.window)
        except InferenceError as error:
            self.counters["classifier_failures"] += 1
            log.error("session %s: no decision on a window: %s", self.id, error)
            self._show("error", m.ErrorMessage("classifier_failed", str(error)))
            return
        finally:
            self._is_inferring = False
        if inference.forecast.failure is not None:
            self.counters["predictor_failures"] += 1
        begin_ns = self._clock.now_ns()
        result = self._core.decide(pending, inference.forecast, inference.classification)
        end_ns = self._clock.now_ns()
        self.counters["decisions"] += 1
        # The command leaves first; what monitors see can wait.
        self._deliver(result.commands)
        if result.decision is not None:
            timing = self._timing(inference, arrival_ns, started_ns, begin_ns, end_ns)
            body = convert.decision_body(result.decision)
            self._show("decision", m.DecisionMessage(body, timing))
        window = pending.window
        self._show(
            "forecast", convert.forecast_message(window.index, window.end_ns, inference.forecast)
        )
        self._show("stats", self._stats())

    async def _tick(self) -> None:
        while True:
            await asyncio.sleep(TICK_S)
            arrival_ns = self._clock.now_ns()
            busy = self._jobs or self._is_inferring
            if busy or self._timeline.idle_ns(arrival_ns) < QUIET_NS:
                continue
            now_ns = self._timeline.now(arrival_ns)
            self._enqueue(self._core.notice_absence(now_ns), arrival_ns)
            if not self._jobs:
                self._deliver(self._core.advance(now_ns))

    def _enqueue(self, jobs: Iterable[Job], arrival_ns: int) -> None:
        for job in jobs:
            if isinstance(job, PendingWindow):
                self.counters["windows"] += 1
                self._skip_waiting_window()
            self._jobs.append(_Waiting(job, arrival_ns))
            self._wake.set()

    def _skip_waiting_window(self) -> None:
        """Of the windows that wait only the latest is worth the models' time."""
        if self._jobs and isinstance(self._jobs[-1].job, PendingWindow):
            self._jobs.pop()
            self.counters["skipped_windows"] += 1

    # ------------------------------------------------------------------ output

    def _deliver(self, commands: Iterable[Command]) -> None:
        changed = False
        for command in commands:
            changed = True
            self.sequence = command.sequence
            self.counters["commands"] += 1
            message = convert.command_message(command, self._epoch)
            for client in self._renderers():
                try:
                    client.outbox.post(message)
                except Overflow:
                    client.outbox.close(CLOSE_TOO_SLOW, "too many commands wait; read faster")
            self._show("command", message)
        if changed:
            self._show_scene()

    def _show(self, topic: str, message: m.Message) -> None:
        for client in self._monitors():
            client.outbox.update(topic, message)

    def _show_scene(self) -> None:
        scene = self.scene()
        for client in (*self._monitors(), *self._renderers()):
            client.outbox.update("scene", scene)

    def _show_pose(self) -> None:
        frame = self._core.perception.latest
        if frame is not None and any(True for _ in self._monitors()):
            self._show("pose", convert.pose_message(frame))

    def _monitors(self) -> Iterable[Client]:
        return (client for client in self.clients if client.role == "monitor")

    def _renderers(self) -> Iterable[Client]:
        return (client for client in self.clients if client.role == "renderer")

    def _stats(self) -> m.StatsMessage:
        c = self.counters
        return m.StatsMessage(
            frames=c["frames"],
            windows=c["windows"],
            decisions=c["decisions"],
            commands=c["commands"],
            skipped_windows=c["skipped_windows"],
            predictor_failures=c["predictor_failures"],
            rejected_messages=c["rejected_messages"],
            missed_telemetry=sum(client.outbox.missed for client in self._monitors()),
            counters={**c, **self._core.perception.counters},
        )

    def _timing(
        self, inference: Inference, arrival_ns: int, started_ns: int, begin_ns: int, end_ns: int
    ) -> m.Timing:
        return m.Timing(
            wall=self._clock.wall(),
            wait_ms=round((started_ns - arrival_ns) / NS_PER_MS, 3),
            predict_ms=round(inference.predict_ms, 3),
            classify_ms=round(inference.classify_ms, 3),
            decide_ms=round((end_ns - begin_ns) / NS_PER_MS, 3),
            total_ms=round((end_ns - arrival_ns) / NS_PER_MS, 3),
        )

    # ------------------------------------------------------------------ within

    def _now(self) -> int:
        return self._timeline.now(self._clock.now_ns())

    def _own(self, kind: str, client: Client) -> None:
        owner = self._owners.get(kind)
        if owner is client:
            return
        if owner is not None:
            if not client.hello.take_over:
                raise InvalidInput(
                    f"another sensor already sends this session's {kind}: say hello with "
                    "take_over = true to replace it",
                    code="stream_taken",
                )
            owner.outbox.close(CLOSE_REPLACED, f"another sensor took over the {kind}")
        self._owners[kind] = client
        client.streams.add(kind)

    def _seat_renderer(self, client: Client) -> None:
        if self._renderer is not None:
            if not client.hello.take_over:
                raise InvalidInput(
                    "another renderer acts for this session: say hello with mirror = true to "
                    "watch, or with take_over = true to replace it",
                    code="renderer_taken",
                )
            self._renderer.outbox.close(CLOSE_REPLACED, "another renderer took over")
        self._renderer = client
        self._deliver(self._core.set_renderer(True, self._now()))

    def _require_acting(self, client: Client) -> None:
        if self._renderer is not client:
            raise InvalidInput(
                "only the acting renderer speaks for the room; a mirror watches",
                code="not_acting",
            )

    def _update_face(self) -> None:
        sensors = [client for client in self.clients if client.role == "sensor"]
        if sensors:
            self._core.set_face(any(client.hello.face == "expected" for client in sensors))
