"""Where a session is written down as it happens, or not.

:class:`agent_server.service.recorder.Recorder` is one.
"""

from typing import Protocol

from agent_server.domain.affect import AffectSample
from agent_server.domain.command import Ack
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.protocol.messages import CommandMessage, DecisionMessage, SceneState
from agent_server.recording.records import CoreEntry


class Journal(Protocol):
    """Takes everything that enters and leaves a session, in the order in which it does."""

    def append_skeleton(self, frame: SkeletonFrame) -> None:
        """A frame was taken."""
        ...

    def append_affect(self, sample: AffectSample) -> None:
        """A sample was taken."""
        ...

    def append_ack(self, ack: Ack) -> None:
        """The renderer spoke of a command."""
        ...

    def append_scene_event(self, event: ObjectChanged) -> None:
        """Somebody changed an object."""
        ...

    def append_core(self, entry: CoreEntry) -> None:
        """The core was told something else."""
        ...

    def append_decision(self, decision: DecisionMessage, stamp_ns: int) -> None:
        """A decision was made."""
        ...

    def append_command(self, command: CommandMessage) -> None:
        """A command was issued."""
        ...

    def append_scene(self, state: SceneState, stamp_ns: int) -> None:
        """The room has changed."""
        ...

    def close(self) -> None:
        """The session is over."""
        ...


class NoJournal:
    """Writes nothing down."""

    def append_skeleton(self, frame: SkeletonFrame) -> None:
        """Do nothing."""

    def append_affect(self, sample: AffectSample) -> None:
        """Do nothing."""

    def append_ack(self, ack: Ack) -> None:
        """Do nothing."""

    def append_scene_event(self, event: ObjectChanged) -> None:
        """Do nothing."""

    def append_core(self, entry: CoreEntry) -> None:
        """Do nothing."""

    def append_decision(self, decision: DecisionMessage, stamp_ns: int) -> None:
        """Do nothing."""

    def append_command(self, command: CommandMessage) -> None:
        """Do nothing."""

    def append_scene(self, state: SceneState, stamp_ns: int) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing."""
