"""What sensors send, on its way into the core."""

import logging
from collections.abc import Callable, Iterable

from agent_server.errors import InferenceError, InvalidInput
from agent_server.protocol import convert, faces
from agent_server.protocol import messages as m
from agent_server.recording.records import SensorChanged
from agent_server.service.audience import Client
from agent_server.service.camera import Camera
from agent_server.service.context import Context
from agent_server.service.core import Job
from agent_server.service.face_reading import FaceReading, tell_calibration

log = logging.getLogger(__name__)


class Sensing:
    """Takes a session's sensors' messages.

    Args:
        context: The session.
        camera: Where images wait to be looked at, or None where they are not taken.
        reading: Where faces are read.
        enqueue: What becomes of the jobs that a frame gives, with its arrival.
    """

    def __init__(
        self,
        context: Context,
        camera: Camera | None,
        reading: FaceReading,
        enqueue: Callable[[Iterable[Job], int], None],
    ) -> None:
        self._context = context
        self._camera = camera
        self._faces = reading
        self._enqueue = enqueue

    def update_face(self, *, is_open: bool) -> None:
        """A face is expected unless every sensor that is there has none, or the gaze instead."""
        context = self._context
        said = {one.hello.face for one in context.audience.having("sensor")} or {"expected"}
        face: m.FaceKind = (
            "expected" if "expected" in said else "gaze" if "gaze" in said else "none"
        )
        context.core.set_face(face)
        context.journal.append_core(SensorChanged(context.now(), is_open, face))

    def receive(self, client: Client, message: m.Message, arrival_ns: int) -> None:
        """Take a sensor's message.

        Raises:
            InvalidInput: If it is refused; no stage has seen it then.
        """
        match message:
            case m.Skeleton() | m.PackedSkeleton():
                self._take_skeleton(client, message, arrival_ns)
            case m.FacePoints() | m.PackedFacePoints() | m.Blendshapes():
                stamp_ns = self._stamp(client, "face", message.originating_ns, arrival_ns)
                face = faces.face_from_message(message, stamp_ns)
                self._faces.push(face, client, arrival_ns)
                self._accept(client, "face", message.originating_ns, stamp_ns, arrival_ns)
            case m.Image():
                self._take_image(client, message, arrival_ns)
            case m.Affect():
                self._take_affect(client, message, arrival_ns)
            case m.Gaze():
                self._take_gaze(client, message, arrival_ns)
            case m.Calibrate():
                self._take_calibration(client, message, arrival_ns)

    async def see(self) -> None:
        """Look for the face in one image after the other, always the latest, until cancelled."""
        context, camera = self._context, self._camera
        if camera is None:
            return
        while True:
            image = await camera.take()
            context.journal.append_image(image.jpeg, image.stamp_ns)
            try:
                face = await camera.look(image)
                if face is None:
                    context.counters["images_without_face"] += 1
                elif image.client in context.audience.clients:
                    self._faces.push(face, image.client, image.arrival_ns)
            except InvalidInput as error:
                # The image was bad, or a face came in another way that is newer.
                context.counters["rejected_messages"] += 1
                image.client.outbox.update(
                    "image", m.ErrorMessage(error.code, str(error), error.field)
                )
            except InferenceError as error:
                context.counters["affect_failures"] += 1
                log.error("session %s: no face from an image: %s", context.id, error)
                context.audience.show("error", m.ErrorMessage("face_failed", str(error)))

    def _take_skeleton(
        self, client: Client, message: m.Skeleton | m.PackedSkeleton, arrival_ns: int
    ) -> None:
        context = self._context
        stamp_ns = self._stamp(client, "body", message.originating_ns, arrival_ns)
        frame = convert.skeleton_from_message(message, stamp_ns)
        perception = context.core.perception
        shown = perception.latest
        jobs = context.core.observe(frame)
        self._accept(client, "body", message.originating_ns, stamp_ns, arrival_ns)
        context.counters["frames"] += 1
        context.journal.append_input(frame, arrival_ns)
        self._enqueue(jobs, arrival_ns)
        latest = perception.latest
        if latest is None or latest is shown:
            return
        context.avatar.show_body(context.id, latest)
        if context.audience.wants("pose"):
            context.audience.show("pose", convert.pose_message(latest))

    def _take_affect(self, client: Client, message: m.Affect, arrival_ns: int) -> None:
        context = self._context
        stamp_ns = self._stamp(client, "face", message.originating_ns, arrival_ns)
        sample = convert.affect_from_message(message, stamp_ns)
        context.core.feel(sample)
        self._accept(client, "face", message.originating_ns, stamp_ns, arrival_ns)
        context.counters["affect_samples"] += 1
        context.journal.append_input(sample, arrival_ns)
        context.audience.show("affect", convert.affect_telemetry(sample))

    def _take_gaze(self, client: Client, message: m.Gaze, arrival_ns: int) -> None:
        context = self._context
        stamp_ns = self._stamp(client, "gaze", message.originating_ns, arrival_ns)
        sample = faces.gaze_from_message(message, stamp_ns)
        context.core.gaze(sample)
        self._accept(client, "gaze", message.originating_ns, stamp_ns, arrival_ns)
        context.counters["gazes"] += 1
        context.journal.append_input(sample, arrival_ns)

    def _take_calibration(self, client: Client, message: m.Calibrate, arrival_ns: int) -> None:
        stamp_ns = self._stamp(client, "face", message.originating_ns, arrival_ns)
        calibration = faces.calibration_from_message(message, stamp_ns)
        calibrated = self._context.core.calibrate(calibration)
        self._accept(client, "face", message.originating_ns, stamp_ns, arrival_ns)
        self._context.journal.append_input(calibration, arrival_ns)
        if calibrated is not None:
            tell_calibration(self._context, calibrated, client)

    def _take_image(self, client: Client, message: m.Image, arrival_ns: int) -> None:
        if self._camera is None:
            raise InvalidInput(
                "this server has no networks that find a face in an image: send landmarks, "
                "blendshapes or valence and arousal",
                field="type",
                code="no_model",
            )
        counters = self._context.counters
        stamp_ns = self._stamp(client, "face", message.originating_ns, arrival_ns)
        self._accept(client, "face", message.originating_ns, stamp_ns, arrival_ns)
        counters["images"] += 1
        counters["skipped_images"] += self._camera.push(client, message.jpeg, stamp_ns, arrival_ns)

    def _stamp(self, client: Client, kind: str, originating_ns: int, arrival_ns: int) -> int:
        """The stamp, on the session's time line, of what a sensor may send; changes nothing."""
        self._context.seats.require_stream(kind, client)
        return self._context.timeline.map(id(client), originating_ns, arrival_ns)

    def _accept(
        self, client: Client, kind: str, originating_ns: int, stamp_ns: int, arrival_ns: int
    ) -> None:
        """What came with this stamp was taken."""
        self._context.seats.take_stream(kind, client)
        self._context.timeline.accept(id(client), originating_ns, stamp_ns, arrival_ns)
