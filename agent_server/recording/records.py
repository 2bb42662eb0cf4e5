"""The records that only a recording has: labels, and the log of what entered the core."""

from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from agent_server.domain.label import Label
from agent_server.domain.scene import RoomState
from agent_server.protocol.messages import Message, Nanoseconds

Index = Annotated[int, Meta(ge=0)]


class LabelRecord(Message, frozen=True, tag="label"):
    """Ground truth: what the person does from onset to offset, and what ought to follow.

    ``expected`` names the reaction; ``quiet`` says that none at all may happen. ``tag`` is the
    data set's own name of the gesture, for a converted recording.
    """

    gesture: str
    onset_ns: Nanoseconds
    offset_ns: Nanoseconds
    subject: str
    expected: str | None = None
    quiet: bool = False
    tag: str = ""

    def to_domain(self) -> Label:
        """The label without its tag."""
        return Label(
            self.gesture, self.onset_ns, self.offset_ns, self.subject, self.expected, self.quiet
        )


class Time(msgspec.Struct, frozen=True):
    """A stamp as Foxglove has it."""

    sec: int
    nsec: int


class CompressedImage(msgspec.Struct, frozen=True):
    """An image of the face, in the layout that Foxglove shows; ``data`` is Base64 in JSON."""

    timestamp: Time
    frame_id: str
    data: bytes
    format: str = "jpeg"


class InputTimes(Message, frozen=True, tag="times"):
    """When inputs came and were dealt with, some inputs a record, column by column.

    Times are those of the clock of whoever recorded, 0 when the recording began (``created``).
    A capture time is on the sensor's clock; only differences of the two mean anything.
    """

    sequences: list[Index]
    received_ns: list[Nanoseconds]
    taken_ns: list[Nanoseconds]


class CoreRecord(msgspec.Struct, frozen=True, omit_defaults=True, tag_field="kind"):
    """Base of what entered the synchronous core beside the sensor's and renderer's messages.

    Fed to the core in file order together with those messages, these records make a replay
    come to the same decisions. ``stamp_ns`` is the time that the core was given.
    """

    stamp_ns: Nanoseconds


class WindowDone(CoreRecord, frozen=True, tag="window"):
    """The models were done with a window and it was decided on; ``failure`` is the predictor's."""

    index: Index
    failure: str | None = None


class WindowSkipped(CoreRecord, frozen=True, tag="skipped"):
    """A newer window took the place of this one before the models got to it."""

    index: Index


class Tick(CoreRecord, frozen=True, tag="tick"):
    """Time passed."""


class RendererChanged(CoreRecord, frozen=True, tag="renderer"):
    """The acting renderer came or went."""

    attached: bool


class SensorChanged(CoreRecord, frozen=True, tag="sensor"):
    """The sensor came or went; ``face`` is what its hello said."""

    open: bool
    face: Literal["expected", "none", "gaze"] = "expected"


class BodyGone(CoreRecord, frozen=True, tag="body_lost"):
    """The followed body counted as lost."""

    body_id: Index


class Restored(CoreRecord, frozen=True, tag="restored"):
    """The session goes on after a restart of the server, with the room as it was."""

    room: RoomState


class ModelsChanged(CoreRecord, frozen=True, tag="models"):
    """Other models decide from the next window on; ``models`` is all of them, name to hash."""

    models: dict[str, str]


CoreEntry = (
    WindowDone
    | WindowSkipped
    | Tick
    | RendererChanged
    | SensorChanged
    | BodyGone
    | Restored
    | ModelsChanged
)
