"""A live session: one core, its clients, and the models in between."""

import asyncio
import logging
from collections import deque
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from agent_server.clock import Clock
from agent_server.config import Settings
from agent_server.domain.motion import BodyLost, ForecastFigures
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S, to_ns
from agent_server.errors import InferenceError
from agent_server.protocol import convert
from agent_server.protocol import messages as m
from agent_server.recording.records import BodyGone, ModelsChanged, Tick, WindowDone, WindowSkipped
from agent_server.scene.rulebook import Rules
from agent_server.service.audience import Audience, Client
from agent_server.service.avatar import Avatar
from agent_server.service.camera import Camera, Eyes
from agent_server.service.context import Context
from agent_server.service.core import Core, Job, PendingWindow
from agent_server.service.delivery import Delivery
from agent_server.service.face_reading import FaceReading
from agent_server.service.journal import Journal
from agent_server.service.load import Load, LoadGauge
from agent_server.service.reactions import Reactions
from agent_server.service.sensing import Sensing
from agent_server.service.store import Saved, SessionStore
from agent_server.service.telling import Telling
from agent_server.service.watching import Decided, Watcher
from agent_server.service.worker import Inference, InferenceWorker

log = logging.getLogger(__name__)

TICK_S = 0.25
RECENT = 25
"""So many of its last decisions, five seconds, a session keeps for those who look after it."""
QUIET_NS = NS_PER_S
"""Ticks let time pass only after this long without input; while input comes, it is the clock."""


@dataclass(frozen=True, slots=True)
class Opening:
    """How a session begins.

    Attributes:
        ledger: Within it, an id of a command means one command for good.
        epoch: Changes with every opening of the session.
        saved: What the session was when the server stopped, or None for a new one.
    """

    ledger: str
    epoch: str
    saved: Saved | None = None


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
        opening: How it begins.
        journal: Where the session is recorded.
        store: Where it is remembered over a restart.
        avatar: Where the person is shown.
        eyes: What finds faces in images, or None where images are not taken.
        watchers: Who is told of its decisions.
        gauge: How loaded the server is.
    """

    def __init__(
        self,
        session: str,
        settings: Settings,
        rules: Rules,
        worker: InferenceWorker,
        clock: Clock,
        opening: Opening,
        journal: Journal,
        store: SessionStore,
        avatar: Avatar,
        eyes: Eyes | None = None,
        watchers: Sequence[Watcher] = (),
        gauge: LoadGauge | None = None,
    ) -> None:
        self.id = session
        self._worker = worker
        self._clock = clock
        self._journal = journal
        self._avatar = avatar
        self._core = Core(session, settings, rules, worker.models)
        self._gauge = gauge or LoadGauge()
        self._context = Context(
            session, self._core, clock, journal, avatar, watchers, Audience(self._gauge)
        )
        self.audience = self._context.audience
        self.counters = self._context.counters
        self.recent: deque[Decided] = deque(maxlen=RECENT)
        self._reactions = Reactions(self._context, worker)
        self.delivery = Delivery(
            self._context,
            store,
            opening.ledger,
            opening.epoch,
            to_ns(settings.server.resume_s),
            self._reactions,
        )
        camera = None if eyes is None else Camera(eyes)
        self._faces = FaceReading(self._context, worker)
        self._sensing = Sensing(self._context, camera, self._faces, self._enqueue)
        self._jobs: deque[_Waiting] = deque()
        self._wake = asyncio.Event()
        self._is_inferring = False
        self._telling = Telling(self._context)
        if opening.saved is not None:
            self.delivery.restore(opening.saved)

    # ------------------------------------------------------------------ clients

    def join(self, client: Client) -> None:
        """Add a client.

        Raises:
            InvalidInput: If it wants to act as the renderer and another one does.
        """
        acts = client.role == "renderer" and not client.hello.mirror
        if acts:
            self._context.seats.claim_room(client)
        self.audience.clients.append(client)
        self.counters["resumes"] += client.hello.ledger == self.delivery.ledger
        if acts:
            self.delivery.hand_over(client)
        if client.role == "sensor":
            self._sensing.update_face(is_open=True)

    def leave(self, client: Client, *, for_good: bool) -> None:
        """Remove a client.

        Args:
            client: Whose connection is over.
            for_good: Whether it said goodbye; else it may come back and resume.
        """
        self.audience.clients.remove(client)
        if client.role == "monitor":
            self.counters["missed_telemetry"] += client.outbox.missed
        self._context.timeline.forget(id(client))
        if client.role == "sensor":
            self._sensing.update_face(is_open=False)
        if self._context.seats.leave(client):
            self.delivery.lose(for_good=for_good)

    def warn_of_jump(self, client: Client, jump_ns: int) -> None:
        """Tell the monitors that a client's clock, or this one, has jumped."""
        self.counters["clock_jumps"] += 1
        self.audience.show(
            "error",
            m.ErrorMessage(
                "clock_jump",
                f"the clock of {client.role} {client.hello.client!r} jumped by "
                f"{jump_ns / NS_PER_MS:.0f} ms: send times of a monotonic clock",
            ),
        )

    def receive(self, client: Client, message: m.Message) -> None:
        """Take a message of a client.

        Raises:
            InvalidInput: If it is refused; no stage has seen it then.
        """
        if client.role == "sensor":
            self._sensing.receive(client, message, self._clock.now_ns())
        else:
            self.delivery.receive(client, message)

    def change_object(self, name: str, state: str) -> None:
        """Set an object of the room by hand.

        Raises:
            InvalidInput: If the room has no such object or state.
        """
        self.delivery.change(ObjectChanged(self._context.now(), name, state))

    # ------------------------------------------------------------------ work

    async def run(self) -> None:
        """Deal with jobs until cancelled."""
        async with asyncio.TaskGroup() as group:
            group.create_task(self._work(), name=f"{self.id}: jobs")
            group.create_task(self._tick(), name=f"{self.id}: ticks")
            group.create_task(self._sensing.see(), name=f"{self.id}: images")
            group.create_task(self._reactions.run(), name=f"{self.id}: reactions")
            group.create_task(self._faces.run(), name=f"{self.id}: faces")

    @property
    def forecast_figures(self) -> ForecastFigures | None:
        """How good the last minute's forecasts were, or None where no truth has come."""
        return self._telling.forecast_figures

    def silent_ns(self, now_ns: int) -> int:
        """How long no sensor has sent anything; 0 before the first."""
        return self._context.timeline.idle_ns(now_ns)

    def close(self, code: int, reason: str) -> None:
        """Send all clients away; the recording is the owner's to end."""
        for client in self.audience.clients:
            client.outbox.close(code, reason)
        self._avatar.forget(self.id)

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
        self._avatar.forget(self.id)
        self._journal.append_core(BodyGone(lost.stamp_ns, lost.body_id))
        self.delivery.deliver(self._core.lose_body(lost), lost.stamp_ns)

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
        if inference.models != self._core.models:
            models = dict(inference.models)
            self._journal.append_core(ModelsChanged(window.end_ns, models))
            self._core.use_models(models)
        begin_ns = self._clock.now_ns()
        result = self._core.decide(pending, inference.forecast, inference.classification)
        end_ns = self._clock.now_ns()
        self._reactions.see(window, inference.forecast)
        self.delivery.deliver(result.commands, window.end_ns)
        failure = inference.forecast.failure
        self._journal.append_core(WindowDone(window.end_ns, window.index, failure))
        if result.commands:
            # The command leaves first; what monitors get can wait.
            await asyncio.sleep(0)
        seen = Decided(
            self.id,
            result.decision,
            arrival_ns,
            started_ns,
            begin_ns,
            end_ns,
            inference.predict_ms,
            inference.classify_ms,
        )
        self.recent.append(seen)
        for watcher in self._context.watchers:
            watcher.decided(seen)
        self._avatar.show_forecast(self.id, inference.forecast, window.end_ns)
        self._telling.score(window, inference.forecast)
        self.counters["decisions"] += 1
        self.counters["predictor_failures"] += failure is not None
        decided = m.DecisionMessage(
            convert.decision_body(result.decision),
            self._timing(inference, arrival_ns, started_ns, begin_ns, end_ns),
        )
        self._journal.append_output(decided, window.end_ns)
        self.audience.show("decision", decided)
        self._telling.look_at(result.decision.gate)
        if self.audience.wants("forecast"):
            forecast = convert.forecast_message(window.index, window.end_ns, inference.forecast)
            self.audience.show("forecast", forecast)
        if self.audience.wants("stats"):
            self.audience.show("stats", self._telling.stats())

    async def _tick(self) -> None:
        while True:
            await asyncio.sleep(TICK_S)
            self.delivery.wait_no_longer()
            self._telling.look_at_recording()
            arrival_ns = self._clock.now_ns()
            is_busy = self._jobs or self._is_inferring
            is_quiet = self._context.timeline.idle_ns(arrival_ns) >= QUIET_NS
            if is_busy or not is_quiet or not self._core.is_waiting:
                continue
            now_ns = self._context.timeline.now(arrival_ns)
            self._journal.append_core(Tick(now_ns))
            jobs, commands = self._core.tick(now_ns)
            self._enqueue(jobs, arrival_ns)
            self.delivery.deliver(commands, now_ns)

    def _enqueue(self, jobs: Iterable[Job], arrival_ns: int) -> None:
        for job in jobs:
            if isinstance(job, PendingWindow):
                self.counters["windows"] += 1
                self._skip_waiting_window()
                if self._gauge.load >= Load.WINDOWS and job.window.index % 2:
                    self.counters["windows_left_out"] += 1
                    self._journal.append_core(WindowSkipped(job.window.end_ns, job.window.index))
                    continue
            self._jobs.append(_Waiting(job, arrival_ns))
            self._wake.set()

    def _skip_waiting_window(self) -> None:
        """Of the windows that wait only the latest is worth the models' time."""
        if self._jobs and isinstance(skipped := self._jobs[-1].job, PendingWindow):
            self._jobs.pop()
            self.counters["skipped_windows"] += 1
            self._journal.append_core(WindowSkipped(skipped.window.end_ns, skipped.window.index))

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
