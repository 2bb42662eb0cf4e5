"""Faces of one session on their way through the models, which read them for all sessions at once.

A face enters the core when it has been read, in the order of their capture. What the core is
given, and when, is what the journal holds, so a replay sees the same.
"""

import asyncio
import logging
from collections import deque
from dataclasses import dataclass

from agent_server.domain.affect import Calibrated
from agent_server.domain.arrays import Float64
from agent_server.domain.face import Face
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import InferenceError, InvalidInput
from agent_server.protocol import convert, faces
from agent_server.protocol import messages as m
from agent_server.service.audience import Client
from agent_server.service.context import Context
from agent_server.service.worker import InferenceWorker
from agent_server.stages.gate import require_later

log = logging.getLogger(__name__)

MAX_WAITING = 64
"""Faces of one session, two seconds of them; more than that are left out and counted."""


@dataclass(frozen=True, slots=True)
class _Waiting:
    face: Face
    client: Client
    arrival_ns: int
    asked_ns: int
    estimate: asyncio.Future[Float64]


class FaceReading:
    """Reads the affect of one session's faces.

    Args:
        context: The session.
        worker: What runs the models.
    """

    def __init__(self, context: Context, worker: InferenceWorker) -> None:
        self._context = context
        self._worker = worker
        self._waiting: deque[_Waiting] = deque()
        self._wake = asyncio.Event()

    def push(self, face: Face, client: Client, arrival_ns: int) -> None:
        """Take a face.

        Args:
            face: The face.
            client: Who is told what became of it.
            arrival_ns: When it came, or the image that shows it, on the server's clock.

        Raises:
            InvalidInput: If it is out of order, or no model reads its kind.
        """
        context = self._context
        context.core.require(face)
        if self._waiting:
            require_later(face.originating_ns, self._waiting[-1].face.originating_ns)
        if len(self._waiting) >= MAX_WAITING:
            context.counters["skipped_faces"] += 1
            return
        asked_ns = context.clock.now_ns()
        estimate = self._worker.read(face)
        self._waiting.append(_Waiting(face, client, arrival_ns, asked_ns, estimate))
        self._wake.set()

    async def run(self) -> None:
        """Let faces enter the core as they have been read, until cancelled."""
        while True:
            await self._wake.wait()
            while self._waiting:
                one = self._waiting[0]
                await asyncio.wait([one.estimate])
                self._enter(one)
                self._waiting.popleft()
            self._wake.clear()

    def _enter(self, one: _Waiting) -> None:
        context = self._context
        try:
            sample, calibrated = context.core.look(one.face, one.estimate.result())
        except InvalidInput as error:
            # The points are no face, or one came in another way that is newer.
            context.counters["rejected_messages"] += 1
            one.client.outbox.update("face", m.ErrorMessage(error.code, str(error), error.field))
            return
        except InferenceError as error:
            context.counters["affect_failures"] += 1
            log.error("session %s: no affect from a face: %s", context.id, error)
            context.audience.show("error", m.ErrorMessage("affect_failed", str(error)))
            return
        for watcher in context.watchers:
            watcher.read_affect((context.clock.now_ns() - one.asked_ns) / NS_PER_S)
        context.counters["faces"] += 1
        context.journal.append_input(one.face, one.arrival_ns)
        context.avatar.show_face(context.id, one.face)
        context.audience.show("affect", convert.affect_telemetry(sample))
        if calibrated is not None:
            tell_calibration(context, calibrated, one.client)


def tell_calibration(context: Context, calibrated: Calibrated, client: Client) -> None:
    """Tell the monitors and the sensor what a calibration came to."""
    state = faces.calibrated_message(calibrated)
    context.audience.show("calibration", state)
    client.outbox.update("calibration", state)
