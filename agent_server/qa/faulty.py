"""A replay of inputs that come in as a fault lets them."""

from collections.abc import Sequence

from agent_server.domain.affect import AffectSample, Calibrated
from agent_server.domain.arrays import Float64
from agent_server.domain.command import Command
from agent_server.domain.decision import Decision
from agent_server.domain.face import Face, GazeSample
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import InvalidInput
from agent_server.qa.faults.base import Arrival
from agent_server.qa.setup import Setup
from agent_server.qa.watch import WatchedCore
from agent_server.service.core import Job, PendingWindow
from agent_server.service.replay import replay_stream


class PatientCore(WatchedCore):
    """A core that passes over what it refuses, as a live server does, and knows when windows came.

    Args:
        session: Id of the session.
        setup: What decides.
        arrivals: All inputs, in the order in which they come in.

    Attributes:
        refused: How many inputs were refused.
        came_ns: Window -> when what completed it came in.
    """

    def __init__(self, session: str, setup: Setup, arrivals: Sequence[Arrival]) -> None:
        super().__init__(session, setup.settings, setup.rules, setup.models)
        self.refused = 0
        self.came_ns: dict[int, int] = {}
        self._bodies = (arrival.at_ns for arrival in arrivals if arrival.is_body)

    def observe(self, frame: SkeletonFrame) -> list[Job]:
        """Take a skeleton frame, or pass over it."""
        at_ns = next(self._bodies)
        try:
            jobs = super().observe(frame)
        except InvalidInput:
            self.refused += 1
            return []
        windows = (job.window.index for job in jobs if isinstance(job, PendingWindow))
        self.came_ns.update((index, at_ns) for index in windows)
        return jobs

    def feel(self, sample: AffectSample) -> None:
        """Take an affect sample, or pass over it."""
        try:
            super().feel(sample)
        except InvalidInput:
            self.refused += 1

    def look(
        self, face: Face, estimate: Float64 | None = None
    ) -> tuple[AffectSample, Calibrated | None]:
        """Take a face, or pass over it: then what was read last still holds."""
        try:
            return super().look(face, estimate)
        except InvalidInput:
            self.refused += 1
            return self.affect[-1], None

    def gaze(self, sample: GazeSample) -> None:
        """Take a gaze, or pass over it."""
        try:
            super().gaze(sample)
        except InvalidInput:
            self.refused += 1

    def change_object(self, event: ObjectChanged) -> tuple[Command, ...]:
        """Take a change in the room, or pass over it."""
        try:
            return super().change_object(event)
        except InvalidInput:
            self.refused += 1
            return ()


def replay_arrivals(
    session: str, setup: Setup, face: str, arrivals: Sequence[Arrival]
) -> tuple[list[tuple[int, Decision]], int]:
    """Decisions on inputs that come in at given times.

    Args:
        session: Id of the session.
        setup: What decides.
        face: What the sensor says of the face.
        arrivals: The inputs, in the order in which they come in.

    Returns:
        Each decision with the time at which what completed its window came in; and how many
        inputs were refused.
    """
    core = PatientCore(session, setup, arrivals)
    core.set_face(face)
    decisions = list(replay_stream(core, setup.models, (arrival.value for arrival in arrivals)))
    return [(core.came_ns[decision.window], decision) for decision in decisions], core.refused
