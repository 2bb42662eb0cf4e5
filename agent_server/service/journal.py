"""Where a session is written down as it happens, or not."""

from typing import Protocol

from agent_server.domain.affect import AffectSample
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.protocol.messages import AckMessage, CommandMessage, DecisionMessage, SceneEvent
from agent_server.recording.records import CoreEntry

JournalMessage = AckMessage | SceneEvent | CommandMessage | DecisionMessage


class Journal(Protocol):
    """Takes everything that enters and leaves a session, in the order in which it does."""

    def skeleton(self, frame: SkeletonFrame) -> None:
        """A frame was taken."""
        ...

    def affect(self, sample: AffectSample) -> None:
        """A sample was taken."""
        ...

    def message(self, stamp_ns: int, message: JournalMessage) -> None:
        """A renderer said something, or a decision or command was made."""
        ...

    def entry(self, entry: CoreEntry) -> None:
        """The core was told something."""
        ...


class NoJournal:
    """Writes nothing down."""

    def skeleton(self, frame: SkeletonFrame) -> None:
        """Do nothing."""

    def affect(self, sample: AffectSample) -> None:
        """Do nothing."""

    def message(self, stamp_ns: int, message: JournalMessage) -> None:
        """Do nothing."""

    def entry(self, entry: CoreEntry) -> None:
        """Do nothing."""
