"""Where a session is written down as it happens, or not.

:class:`agent_server.service.recorder.Recorder` is one.
"""

from typing import Protocol

from agent_server.domain.inputs import RawInput
from agent_server.recording.records import CoreEntry
from agent_server.recording.writer import Output


class Journal(Protocol):
    """Takes everything that enters and leaves a session, in the order in which it does."""

    def append_input(self, value: RawInput, arrival_ns: int) -> None:
        """The core took what a client sent, which came when the server's clock showed this."""
        ...

    def append_image(self, jpeg: bytes, stamp_ns: int) -> None:
        """An image is looked at."""
        ...

    def append_core(self, entry: CoreEntry) -> None:
        """The core was told something else."""
        ...

    def append_output(self, message: Output, stamp_ns: int) -> None:
        """A decision was made, a command issued, its motion sent, or the room has changed."""
        ...

    def take_failure(self) -> str | None:
        """Why nothing is written any more, the first time that it is asked after that."""
        ...

    @property
    def lost(self) -> int:
        """How much was not written."""
        ...

    def close(self) -> None:
        """The session is over."""
        ...


class NoJournal:
    """Writes nothing down."""

    lost = 0

    def append_input(self, value: RawInput, arrival_ns: int) -> None:
        """Do nothing."""

    def append_image(self, jpeg: bytes, stamp_ns: int) -> None:
        """Do nothing."""

    def append_core(self, entry: CoreEntry) -> None:
        """Do nothing."""

    def append_output(self, message: Output, stamp_ns: int) -> None:
        """Do nothing."""

    def take_failure(self) -> str | None:
        """Nothing can fail."""
        return None

    def close(self) -> None:
        """Do nothing."""
