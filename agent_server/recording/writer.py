"""Writing a session to disk as it happens."""

from pathlib import Path
from types import TracebackType
from typing import Self

import msgspec

from agent_server.domain.inputs import RawInput
from agent_server.domain.label import Label
from agent_server.domain.stamp import NS_PER_S
from agent_server.protocol import messages as m
from agent_server.recording import topics
from agent_server.recording.inputs import to_record
from agent_server.recording.metadata import METADATA_NAME, RecordingMetadata
from agent_server.recording.records import (
    CompressedImage,
    CoreEntry,
    InputTimes,
    LabelRecord,
    Time,
)
from agent_server.recording.schema import json_schema
from agent_server.recording.sink import LIVE, ChunkLimits, McapSink
from agent_server.recording.topics import Topic

Output = m.DecisionMessage | m.CommandMessage | m.PoseStreamMessage | m.SceneState
"""What a session gives, beside telemetry that can be made anew."""

_OUTPUTS: dict[type[Output], Topic] = {
    m.DecisionMessage: topics.DECISION,
    m.CommandMessage: topics.COMMAND,
    m.PoseStreamMessage: topics.MOTION,
    m.SceneState: topics.SCENE,
}


TIMES_AT_ONCE = 64
"""So many inputs share a record of their times."""


class RecordingWriter:
    """One recording that is being written.

    Records stand in the file in the order in which they are appended; what enters the core is
    appended when it enters it. Sequence numbers count the records of the file from 0. A chunk
    closes at its limits, by default 256 KiB or 500 ms of stamps; the owner calls :meth:`flush` so
    that it also does when no more records come. Use it as a context manager, or call
    :meth:`close`.

    Args:
        path: File to create; it must not exist.
        metadata: What the recording says about itself.
        limits: Of a chunk.

    Raises:
        RecordingError: If the file cannot be created or, from any method, written. It then
            holds the records up to its last whole chunk, and ``recover`` makes it readable.
    """

    def __init__(self, path: Path, metadata: RecordingMetadata, limits: ChunkLimits = LIVE) -> None:
        self._sink = McapSink(path, limits)
        self._sink.metadata(METADATA_NAME, metadata.to_strings())
        self._encoder = msgspec.json.Encoder()
        self._channels: dict[str, int] = {}
        self._sequence = 0
        self._latest_ns = 0
        self._times: list[tuple[int, int, int]] = []

    @property
    def size(self) -> int:
        """Bytes in the file so far."""
        return self._sink.size

    def append_input(self, value: RawInput, times: tuple[int, int] | None = None) -> None:
        """What a client sent, as it entered the core.

        Args:
            value: What it sent.
            times: When it came and when it had been dealt with, in nanoseconds since the
                recording began; None where nobody knows.
        """
        topic, stamp_ns, record = to_record(value)
        if times is not None:
            self._times.append((self._sequence, *times))
        self._append(topic, stamp_ns, record)
        if len(self._times) >= TIMES_AT_ONCE:
            self._append_times()

    def append_image(self, jpeg: bytes, stamp_ns: int) -> None:
        """An image that a face was looked for in, at its capture time."""
        time = Time(*divmod(stamp_ns, NS_PER_S))
        self._append(topics.IMAGE, stamp_ns, CompressedImage(time, "face", jpeg))

    def append_core(self, entry: CoreEntry) -> None:
        """What else entered the core, at the time that the core was given."""
        self._append(topics.CORE, entry.stamp_ns, entry)

    def append_output(self, message: Output, stamp_ns: int) -> None:
        """What came of it, at the time of the window or event that it came of."""
        self._append(_OUTPUTS[type(message)], stamp_ns, message)

    def append_label(self, label: Label, tag: str = "") -> None:
        """Ground truth, at its onset; ``tag`` is the data set's own name of the gesture."""
        record = LabelRecord(
            gesture=label.gesture,
            onset_ns=label.onset_ns,
            offset_ns=label.offset_ns,
            subject=label.subject,
            expected=label.expected,
            quiet=label.quiet,
            tag=tag,
        )
        self._append(topics.LABEL, label.onset_ns, record)

    def flush(self) -> None:
        """Close the chunk in progress, so that a crash from here on does not lose it."""
        self._append_times()
        self._sink.flush()

    def close(self) -> None:
        """Finish the file with its index and summary. Does nothing the second time."""
        if self._sink.is_open:
            self._append_times()
        self._sink.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def _append_times(self) -> None:
        if self._times:
            sequences, received, taken = map(list, zip(*self._times, strict=True))
            self._times = []
            self._append(topics.TIMES, self._latest_ns, InputTimes(sequences, received, taken))

    def _append(self, topic: Topic, stamp_ns: int, record: msgspec.Struct) -> None:
        channel = self._channels.get(topic.name)
        if channel is None:
            schema = (topic.schema, "jsonschema", json_schema(topic.record))
            channel = self._channels[topic.name] = self._sink.channel(topic.name, "json", schema)
        self._sink.message(channel, stamp_ns, self._sequence, self._encoder.encode(record))
        self._sequence += 1
        self._latest_ns = stamp_ns
