"""Where a session is written down as it happens, or not.

:class:`agent_server.service.recorder.Recorder` is one.
"""

from typing import Protocol

from agent_server.domain.inputs import RawInput
from agent_server.recording.records import CoreEntry
from agent_server.recording.writer import Output


class Journal(Protocol):
    """Takes everything that enters and leaves a session, in the order in which it does."""

    def append_input(self, value: RawInput) -> None:
        """The core took what a client sent."""
        ...

    def append_image(self, jpeg: bytes, stamp_ns: int) -> None:
        """An image is looked at."""
        ...

    def append_core(self, entry: CoreEntry) -> None:
        """The core was told something else."""
        ...

    def append_output(self, message: Output, stamp_ns: int) -> None:
        """A decision was made, a command issued, or the room has changed."""
        ...

    def close(self) -> None:
        """The session is over."""
        ...


class NoJournal:
    """Writes nothing down."""

    def append_input(self, value: RawInput) -> None:
        """Do nothing."""

    def append_image(self, jpeg: bytes, stamp_ns: int) -> None:
        """Do nothing."""

    def append_core(self, entry: CoreEntry) -> None:
        """Do nothing."""

    def append_output(self, message: Output, stamp_ns: int) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing."""
