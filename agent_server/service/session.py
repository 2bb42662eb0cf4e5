"""A live session: one core, its clients, and the models in between."""

import asyncio
import logging
from collections import Counter, deque
from collections.abc import Iterable
from dataclasses import dataclass

from agent_server.clock import Clock
from agent_server.config import Settings
from agent_server.domain.command import Command
from agent_server.domain.motion import BodyLost
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.errors import InferenceError
from agent_server.protocol import convert
from agent_server.protocol import messages as m
from agent_server.recording.records import (
    BodyGone,
    RendererChanged,
    SensorChanged,
    Tick,
    WindowDone,
    WindowSkipped,
)
from agent_server.scene.rulebook import Rules
from agent_server.service.audience import Audience, Client
from agent_server.service.core import Core, Job, PendingWindow
from agent_server.service.journal import Journal
from agent_server.service.seats import Seats
from agent_server.service.timeline import Timeline
from agent_server.service.worker import Inference, InferenceWorker

log = logging.getLogger(__name__)

TICK_S = 0.25
QUIET_NS = NS_PER_S
"""Ticks let time pass only after this long without input; while input comes, it is the clock."""


@dataclass(frozen=True, slots=True)
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
        epoch: Changes with every opening of the session.
        journal: Where the session is recorded.
    """

    def __init__(
        self,
        session: str,
        settings: Settings,
        rules: Rules,
        worker: InferenceWorker,
        clock: Clock,
        epoch: str,
        journal: Journal,
    ) -> None:
        self.id = session
        self.audience = Audience()
        self.counters: Counter[str] = Counter()
        self.sequence = 0
        self.epoch = epoch
        self._worker = worker
        self._clock = clock
        self._journal = journal
        self._core = Core(session, settings, rules, worker.models.hashes)
        self._timeline = Timeline()
        self._seats = Seats()
        self._latest_command: m.CommandMessage | None = None
        self._shown_scene = self.scene()
        self._jobs: deque[_Waiting] = deque()
        self._wake = asyncio.Event()
        self._is_inferring = False

    # ------------------------------------------------------------------ clients

    def join(self, client: Client) -> None:
        """Add a client.

        Raises:
            InvalidInput: If it wants to act as the renderer and another one does.
        """
        acts = client.role == "renderer" and not client.hello.mirror
        if acts:
            self._seats.claim_room(client)
        self.audience.clients.append(client)
        if acts:
            self._hand_over(client)
        if client.role == "sensor":
            self._update_face(is_open=True)

    def leave(self, client: Client) -> None:
        """Remove a client."""
        self.audience.clients.remove(client)
        self._timeline.forget(id(client))
        if client.role == "sensor":
            self._update_face(is_open=False)
        if self._seats.leave(client):
            now_ns = self._now()
            self._journal.append_core(RendererChanged(now_ns, attached=False))
            self._deliver(self._core.set_renderer(False, now_ns), now_ns)

    def scene(self) -> m.SceneState:
        """The room as it is."""
        return convert.scene_message(self._core.scene())

    # ------------------------------------------------------------------ input

    def receive(self, client: Client, message: m.Message) -> None:
        """Take a message of a client.

        Raises:
            InvalidInput: If it is refused; no stage has seen it then.
        """
        arrival_ns = self._clock.now_ns()
        match message:
            case m.Skeleton() | m.PackedSkeleton():
                self._take_skeleton(client, message, arrival_ns)
            case m.Affect():
                self._take_affect(client, message, arrival_ns)
            case m.AckMessage():
                self._take_ack(client, message)
            case m.SceneEvent():
                self._take_scene_event(client, message)

    def _take_skeleton(
        self, client: Client, message: m.Skeleton | m.PackedSkeleton, arrival_ns: int
    ) -> None:
        self._seats.require_stream("body", client)
        stamp_ns = self._timeline.map(id(client), message.originating_ns, arrival_ns)
        frame = convert.skeleton_from_message(message, stamp_ns)
        shown = self._core.perception.latest
        jobs = self._core.observe(frame)
        self._seats.take_stream("body", client)
        self._timeline.accept(id(client), message.originating_ns, stamp_ns, arrival_ns)
        self.counters["frames"] += 1
        self._journal.append_skeleton(frame)
        self._enqueue(jobs, arrival_ns)
        latest = self._core.perception.latest
        if latest is not None and latest is not shown and self.audience.wants("pose"):
            self.audience.show("pose", convert.pose_message(latest))

    def _take_affect(self, client: Client, message: m.Affect, arrival_ns: int) -> None:
        self._seats.require_stream("face", client)
        stamp_ns = self._timeline.map(id(client), message.originating_ns, arrival_ns)
        sample = convert.affect_from_message(message, stamp_ns)
        self._core.feel(sample)
        self._seats.take_stream("face", client)
        self._timeline.accept(id(client), message.originating_ns, stamp_ns, arrival_ns)
        self.counters["affect_samples"] += 1
        self._journal.append_affect(sample)
        self.audience.show(
            "affect", m.AffectTelemetry(sample.originating_ns, sample.valence, sample.arousal)
        )

    def _take_ack(self, client: Client, message: m.AckMessage) -> None:
        self._seats.require_room(client)
        ack = convert.ack_from_message(message, self._now())
        heard = self._core.acknowledge(ack)
        self.counters["acks" if heard.taken else "stale_acks"] += 1
        self._journal.append_ack(ack)
        self._deliver(heard.commands, ack.stamp_ns)
        self.audience.show(
            "ack",
            m.AckTelemetry(message.command_id, message.status, message.step, message.reason),
        )

    def _take_scene_event(self, client: Client, message: m.SceneEvent) -> None:
        self._seats.require_room(client)
        event = ObjectChanged(self._now(), message.object, message.state)
        commands = self._core.change_object(event)
        self.counters["scene_events"] += 1
        self._journal.append_scene_event(event)
        self._deliver(commands, event.stamp_ns)

    # ------------------------------------------------------------------ work

    async def run(self) -> None:
        """Deal with jobs until cancelled."""
        async with asyncio.TaskGroup() as group:
            group.create_task(self._work(), name=f"{self.id}: jobs")
            group.create_task(self._tick(), name=f"{self.id}: ticks")

    def close(self, code: int, reason: str) -> None:
        """Send all clients away and end the recording."""
        for client in self.audience.clients:
            client.outbox.close(code, reason)
        self._journal.close()

    async def _work(self) -> None:
        while True:
            await self._wake.wait()
            self._wake.clear()
            while self._jobs:
                waiting = self._jobs.popleft()
                if isinstance(waiting.job, BodyLost):
                    self._lose_body(waiting.job)
                else:
                    await self._decide(waiting.job, waiting.arrival_ns)

    def _lose_body(self, lost: BodyLost) -> None:
        self.counters["bodies_lost"] += 1
        self._journal.append_core(BodyGone(lost.stamp_ns, lost.body_id))
        self._deliver(self._core.lose_body(lost), lost.stamp_ns)

    async def _decide(self, pending: PendingWindow, arrival_ns: int) -> None:
        window = pending.window
        started_ns = self._clock.now_ns()
        self._is_inferring = True
        try:
            inference = await self._worker.infer(window)
        except InferenceError as error:
            self.counters["classifier_failures"] += 1
            self._journal.append_core(WindowSkipped(window.end_ns, window.index))
            log.error("session %s: no decision on window %d: %s", self.id, window.index, error)
            self.audience.show("error", m.ErrorMessage("classifier_failed", str(error)))
            return
        finally:
            self._is_inferring = False
        begin_ns = self._clock.now_ns()
        result = self._core.decide(pending, inference.forecast, inference.classification)
        end_ns = self._clock.now_ns()
        # The command leaves first; what monitors and the recording get can wait.
        self._deliver(result.commands, window.end_ns)
        self.counters["decisions"] += 1
        failure = inference.forecast.failure
        self.counters["predictor_failures"] += failure is not None
        self._journal.append_core(WindowDone(window.end_ns, window.index, failure))
        decided = m.DecisionMessage(
            convert.decision_body(result.decision),
            self._timing(inference, arrival_ns, started_ns, begin_ns, end_ns),
        )
        self._journal.append_decision(decided, window.end_ns)
        self.audience.show("decision", decided)
        if self.audience.wants("forecast"):
            forecast = convert.forecast_message(window.index, window.end_ns, inference.forecast)
            self.audience.show("forecast", forecast)
        if self.audience.wants("stats"):
            self.audience.show("stats", self._stats())

    async def _tick(self) -> None:
        while True:
            await asyncio.sleep(TICK_S)
            arrival_ns = self._clock.now_ns()
            is_busy = self._jobs or self._is_inferring
            is_quiet = self._timeline.idle_ns(arrival_ns) >= QUIET_NS
            if is_busy or not is_quiet or not self._core.is_waiting:
                continue
            now_ns = self._timeline.now(arrival_ns)
            self._journal.append_core(Tick(now_ns))
            jobs, commands = self._core.tick(now_ns)
            self._enqueue(jobs, arrival_ns)
            self._deliver(commands, now_ns)

    def _enqueue(self, jobs: Iterable[Job], arrival_ns: int) -> None:
        for job in jobs:
            if isinstance(job, PendingWindow):
                self.counters["windows"] += 1
                self._skip_waiting_window()
            self._jobs.append(_Waiting(job, arrival_ns))
            self._wake.set()

    def _skip_waiting_window(self) -> None:
        """Of the windows that wait only the latest is worth the models' time."""
        if self._jobs and isinstance(skipped := self._jobs[-1].job, PendingWindow):
            self._jobs.pop()
            self.counters["skipped_windows"] += 1
            self._journal.append_core(WindowSkipped(skipped.window.end_ns, skipped.window.index))

    # ------------------------------------------------------------------ output

    def _deliver(self, commands: Iterable[Command], now_ns: int) -> None:
        """Send commands, and the room where it has changed."""
        for command in commands:
            self.sequence = command.sequence
            self.counters["commands"] += 1
            self._latest_command = message = convert.command_message(command, self.epoch)
            self.audience.order(message)
            self._journal.append_command(message)
        scene = self.scene()
        if scene != self._shown_scene:
            self._shown_scene = scene
            self.audience.show_scene(scene)
            self._journal.append_scene(scene, now_ns)

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
            missed_telemetry=self.audience.missed,
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

    def _hand_over(self, renderer: Client) -> None:
        """Let a renderer act for the room, from the command on that is being carried out."""
        now_ns = self._now()
        latest = self._latest_command
        if latest is not None and latest.id == self.scene().command_id:
            renderer.outbox.post(latest)
        self._journal.append_core(RendererChanged(now_ns, attached=True))
        self._deliver(self._core.set_renderer(True, now_ns), now_ns)

    def _update_face(self, *, is_open: bool) -> None:
        """A face is expected unless every sensor that is there has none."""
        faces = [sensor.hello.face for sensor in self.audience.having("sensor")]
        face: m.Face = "expected" if "expected" in faces or not faces else "none"
        self._core.set_face(face == "expected")
        self._journal.append_core(SensorChanged(self._now(), is_open, face))
