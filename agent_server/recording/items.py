"""The records of a recording as values that can be changed and written again."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from agent_server.domain.command import Ack
from agent_server.domain.inputs import RawInput, SensorInput
from agent_server.domain.label import Label
from agent_server.domain.scene import ObjectChanged
from agent_server.recording import topics
from agent_server.recording.inputs import from_record
from agent_server.recording.reader import Recording
from agent_server.recording.records import CompressedImage, CoreEntry, LabelRecord
from agent_server.recording.writer import Output, RecordingWriter

_RAW = frozenset(topic.name for topic in topics.RAW_INPUTS)


@dataclass(frozen=True, slots=True)
class Tagged:
    """A label with its data set's own name of the gesture."""

    label: Label
    tag: str


@dataclass(frozen=True, slots=True)
class Image:
    """A picture of the face, JPEG."""

    jpeg: bytes


Item = RawInput | CoreEntry | Output | Tagged | Image


@dataclass(frozen=True, slots=True)
class Entry:
    """A record.

    Attributes:
        stamp_ns: Its time.
        item: What it holds.
        times: When an input came and had been dealt with, as the recorder noted it.
    """

    stamp_ns: int
    item: Item
    times: tuple[int, int] | None = None

    @property
    def is_input(self) -> bool:
        """Whether a client sent it."""
        return isinstance(self.item, RawInput)

    @property
    def is_derived(self) -> bool:
        """Whether a replay makes it anew, or needs all that went before it."""
        return isinstance(self.item, CoreEntry | Output)

    def moved(self, by_ns: int) -> "Entry":
        """An input, image or label at another time; when it came is told no more."""
        item = self.item
        if isinstance(item, SensorInput):
            item = replace(item, originating_ns=item.originating_ns + by_ns)
        elif isinstance(item, Ack | ObjectChanged):
            item = replace(item, stamp_ns=item.stamp_ns + by_ns)
        elif isinstance(item, Tagged):
            label = item.label
            onset_ns, offset_ns = label.onset_ns + by_ns, label.offset_ns + by_ns
            item = Tagged(replace(label, onset_ns=onset_ns, offset_ns=offset_ns), item.tag)
        elif not isinstance(item, Image):
            raise AssertionError(f"{type(item).__name__} stays at its time")
        return Entry(self.stamp_ns + by_ns, item)


def read_entries(recording: Recording) -> Iterator[Entry]:
    """All records, in file order.

    Raises:
        RecordingError: If the recording cannot be read.
    """
    times = {sequence: (received, taken) for sequence, received, taken in recording.times()}
    for record in recording.records():
        if record.topic != topics.TIMES.name:
            item = _item(record.topic, record.message, record.stamp_ns)
            yield Entry(record.stamp_ns, item, times.get(record.sequence))


def write_entry(writer: RecordingWriter, entry: Entry) -> None:
    """Append a record."""
    item = entry.item
    if isinstance(item, RawInput):
        writer.append_input(item, entry.times)
    elif isinstance(item, CoreEntry):
        writer.append_core(item)
    elif isinstance(item, Tagged):
        writer.append_label(item.label, item.tag)
    elif isinstance(item, Image):
        writer.append_image(item.jpeg, entry.stamp_ns)
    else:
        writer.append_output(item, entry.stamp_ns)


def _item(topic: str, message: object, stamp_ns: int) -> Item:
    if topic in _RAW:
        return from_record(message, stamp_ns)
    if isinstance(message, LabelRecord):
        return Tagged(message.to_domain(), message.tag)
    if isinstance(message, CompressedImage):
        return Image(message.data)
    if isinstance(message, CoreEntry | Output):
        return message
    raise AssertionError(f"{topic} holds {type(message).__name__}, which nobody writes")
