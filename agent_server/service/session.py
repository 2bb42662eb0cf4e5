"""A live session: one core, its clients, and the models in between."""

import asyncio
import logging
from collections import Counter, deque
from collections.abc import Iterable
from dataclasses import dataclass

from agent_server.clock import Clock
from agent_server.config import Settings
from agent_server.domain.affect import Calibrated
from agent_server.domain.command import Command
from agent_server.domain.decision import FacePairing, GateVerdict
from agent_server.domain.face import Face
from agent_server.domain.motion import BodyLost
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.errors import InferenceError, InvalidInput
from agent_server.protocol import convert, faces
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
from agent_server.service.camera import Camera, Eyes
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
        eyes: What finds faces in images, or None where images are not taken.
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
        eyes: Eyes | None = None,
    ) -> None:
        self.id = session
        self.audience = Audience()
        self.counters: Counter[str] = Counter()
        self.sequence = 0
        self.epoch = epoch
        self._worker = worker
        self._clock = clock
        self._journal = journal
        self._core = Core(session, settings, rules, worker.models)
        self._timeline = Timeline()
        self._seats = Seats()
        self._latest_command: m.CommandMessage | None = None
        self._shown_scene = self.scene()
        self._jobs: deque[_Waiting] = deque()
        self._wake = asyncio.Event()
        self._is_inferring = False
        self._is_skewed = False
        self._camera = None if eyes is None else Camera(eyes)

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
            case m.FacePoints() | m.PackedFacePoints() | m.Blendshapes():
                stamp_ns = self._stamp(client, "face", message.originating_ns, arrival_ns)
                self._look(faces.face_from_message(message, stamp_ns), client)
                self._accept(client, "face", message.originating_ns, stamp_ns, arrival_ns)
            case m.Image():
                self._take_image(client, message, arrival_ns)
            case m.Affect():
                self._take_affect(client, message, arrival_ns)
            case m.Gaze():
                self._take_gaze(client, message, arrival_ns)
            case m.Calibrate():
                self._take_calibration(client, message, arrival_ns)
            case m.AckMessage():
                self._take_ack(client, message)
            case m.SceneEvent():
                self._take_scene_event(client, message)

    def _take_skeleton(
        self, client: Client, message: m.Skeleton | m.PackedSkeleton, arrival_ns: int
    ) -> None:
        stamp_ns = self._stamp(client, "body", message.originating_ns, arrival_ns)
        frame = convert.skeleton_from_message(message, stamp_ns)
        shown = self._core.perception.latest
        jobs = self._core.observe(frame)
        self._accept(client, "body", message.originating_ns, stamp_ns, arrival_ns)
        self.counters["frames"] += 1
        self._journal.append_input(frame)
        self._enqueue(jobs, arrival_ns)
        latest = self._core.perception.latest
        if latest is not None and latest is not shown and self.audience.wants("pose"):
            self.audience.show("pose", convert.pose_message(latest))

    def _take_affect(self, client: Client, message: m.Affect, arrival_ns: int) -> None:
        stamp_ns = self._stamp(client, "face", message.originating_ns, arrival_ns)
        sample = convert.affect_from_message(message, stamp_ns)
        self._core.feel(sample)
        self._accept(client, "face", message.originating_ns, stamp_ns, arrival_ns)
        self.counters["affect_samples"] += 1
        self._journal.append_input(sample)
        self.audience.show("affect", convert.affect_telemetry(sample))

    def _take_gaze(self, client: Client, message: m.Gaze, arrival_ns: int) -> None:
        stamp_ns = self._stamp(client, "gaze", message.originating_ns, arrival_ns)
        sample = faces.gaze_from_message(message, stamp_ns)
        self._core.gaze(sample)
        self._accept(client, "gaze", message.originating_ns, stamp_ns, arrival_ns)
        self.counters["gazes"] += 1
        self._journal.append_input(sample)

    def _take_calibration(self, client: Client, message: m.Calibrate, arrival_ns: int) -> None:
        stamp_ns = self._stamp(client, "face", message.originating_ns, arrival_ns)
        calibration = faces.calibration_from_message(message, stamp_ns)
        calibrated = self._core.calibrate(calibration)
        self._accept(client, "face", message.originating_ns, stamp_ns, arrival_ns)
        self._journal.append_input(calibration)
        self._show_calibration(calibrated, client)

    def _take_image(self, client: Client, message: m.Image, arrival_ns: int) -> None:
        if self._camera is None:
            raise InvalidInput(
                "this server has no networks that find a face in an image: send landmarks, "
                "blendshapes or valence and arousal",
                field="type",
                code="no_model",
            )
        stamp_ns = self._stamp(client, "face", message.originating_ns, arrival_ns)
        self._accept(client, "face", message.originating_ns, stamp_ns, arrival_ns)
        self.counters["images"] += 1
        self.counters["skipped_images"] += self._camera.push(client, message.jpeg, stamp_ns)

    def _stamp(self, client: Client, kind: str, originating_ns: int, arrival_ns: int) -> int:
        """The stamp, on the session's time line, of what a sensor may send; changes nothing."""
        self._seats.require_stream(kind, client)
        return self._timeline.map(id(client), originating_ns, arrival_ns)

    def _accept(
        self, client: Client, kind: str, originating_ns: int, stamp_ns: int, arrival_ns: int
    ) -> None:
        """What came with this stamp was taken."""
        self._seats.take_stream(kind, client)
        self._timeline.accept(id(client), originating_ns, stamp_ns, arrival_ns)

    def _look(self, face: Face, client: Client) -> None:
        try:
            sample, calibrated = self._core.look(face)
        except InferenceError as error:
            self.counters["affect_failures"] += 1
            log.error("session %s: no affect from a face: %s", self.id, error)
            self.audience.show("error", m.ErrorMessage("affect_failed", str(error)))
            return
        self.counters["faces"] += 1
        self._journal.append_input(face)
        self.audience.show("affect", convert.affect_telemetry(sample))
        self._show_calibration(calibrated, client)

    def _show_calibration(self, calibrated: Calibrated | None, client: Client) -> None:
        """Tell the monitors and the sensor what a calibration came to."""
        if calibrated is None:
            return
        state = faces.calibrated_message(calibrated)
        self.audience.show("calibration", state)
        client.outbox.update("calibration", state)

    def _take_ack(self, client: Client, message: m.AckMessage) -> None:
        self._seats.require_room(client)
        ack = convert.ack_from_message(message, self._now())
        heard = self._core.acknowledge(ack)
        self.counters["acks" if heard.taken else "stale_acks"] += 1
        self._journal.append_input(ack)
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
        self._journal.append_input(event)
        self._deliver(commands, event.stamp_ns)

    # ------------------------------------------------------------------ work

    async def run(self) -> None:
        """Deal with jobs until cancelled."""
        async with asyncio.TaskGroup() as group:
            group.create_task(self._work(), name=f"{self.id}: jobs")
            group.create_task(self._tick(), name=f"{self.id}: ticks")
            if self._camera is not None:
                group.create_task(self._see(self._camera), name=f"{self.id}: images")

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

    async def _see(self, camera: Camera) -> None:
        """Look for the face in one image after the other, always the latest."""
        while True:
            image = await camera.take()
            self._journal.append_image(image.jpeg, image.stamp_ns)
            try:
                face = await camera.look(image)
                if face is None:
                    self.counters["images_without_face"] += 1
                elif image.client in self.audience.clients:
                    self._look(face, image.client)
            except InvalidInput as error:
                # The image was bad, or a face came in another way that is newer.
                self.counters["rejected_messages"] += 1
                image.client.outbox.update(
                    "image", m.ErrorMessage(error.code, str(error), error.field)
                )
            except InferenceError as error:
                self.counters["affect_failures"] += 1
                log.error("session %s: no face from an image: %s", self.id, error)
                self.audience.show("error", m.ErrorMessage("face_failed", str(error)))

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
        self._journal.append_output(decided, window.end_ns)
        self.audience.show("decision", decided)
        self._warn_of_skew(result.decision.gate)
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

    def _warn_of_skew(self, gate: GateVerdict) -> None:
        """Tell the monitors when body and face begin to be captured too far apart."""
        was_skewed, self._is_skewed = self._is_skewed, gate.face is FacePairing.SKEWED
        if self._is_skewed and not was_skewed:
            self.counters["face_skews"] += 1
            self.audience.show(
                "error",
                m.ErrorMessage(
                    "face_skew",
                    f"the face was captured {gate.age_ms:g} ms before the end of the window: send "
                    "faces more often, or let body and face be stamped by one clock",
                ),
            )

    def _deliver(self, commands: Iterable[Command], now_ns: int) -> None:
        """Send commands, and the room where it has changed."""
        for command in commands:
            self.sequence = command.sequence
            self.counters["commands"] += 1
            self._latest_command = message = convert.command_message(command, self.epoch)
            self.audience.order(message)
            self._journal.append_output(message, message.issued_ns)
        scene = self.scene()
        if scene != self._shown_scene:
            self._shown_scene = scene
            self.audience.show_scene(scene)
            self._journal.append_output(scene, now_ns)

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
        """A face is expected unless every sensor that is there has none, or the gaze instead."""
        said = {sensor.hello.face for sensor in self.audience.having("sensor")} or {"expected"}
        face: m.FaceKind = "expected" if "expected" in said else "gaze" if "gaze" in said else "none"
        self._core.set_face(face)
        self._journal.append_core(SensorChanged(self._now(), is_open, face))
