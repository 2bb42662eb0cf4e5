"""Writing a session to disk as it happens."""

from pathlib import Path
from types import TracebackType
from typing import Self

import msgspec

from agent_server.domain.affect import AffectSample
from agent_server.domain.command import Ack
from agent_server.domain.label import Label
from agent_server.domain.scene import ObjectChanged
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.protocol import messages as m
from agent_server.protocol.convert import affect_to_message, skeleton_to_message
from agent_server.recording import topics
from agent_server.recording.metadata import METADATA_NAME, RecordingMetadata
from agent_server.recording.records import CoreEntry, LabelRecord
from agent_server.recording.schema import json_schema
from agent_server.recording.sink import McapSink
from agent_server.recording.topics import Topic


class RecordingWriter:
    """One recording that is being written.

    Records stand in the file in the order in which they are appended; what enters the core is
    appended when it enters it. Sequence numbers count the records of the file from 0. A chunk
    closes at 32 KiB or after 500 ms of stamps; the owner calls :meth:`flush` so that it also
    does when no more records come. Use it as a context manager, or call :meth:`close`.

    Args:
        path: File to create; it must not exist.
        metadata: What the recording says about itself.

    Raises:
        RecordingError: If the file cannot be created or, from any method, written. It then
            holds the records up to its last whole chunk, and ``recover`` makes it readable.
    """

    def __init__(self, path: Path, metadata: RecordingMetadata) -> None:
        self._sink = McapSink(path)
        self._sink.metadata(METADATA_NAME, metadata.to_strings())
        self._encoder = msgspec.json.Encoder()
        self._channels: dict[str, int] = {}
        self._sequence = 0

    def append_skeleton(self, frame: SkeletonFrame) -> None:
        """A frame as it entered the core, at its capture time."""
        self._append(topics.SKELETON, frame.originating_ns, skeleton_to_message(frame))

    def append_affect(self, sample: AffectSample) -> None:
        """An affect estimate as it entered the core, at its capture time."""
        self._append(topics.AFFECT, sample.originating_ns, affect_to_message(sample))

    def append_ack(self, ack: Ack) -> None:
        """The renderer's word on a command, at its arrival."""
        message = m.AckMessage(ack.command_id, ack.status.value, ack.step, ack.reason)
        self._append(topics.ACK, ack.stamp_ns, message)

    def append_scene_event(self, event: ObjectChanged) -> None:
        """An object changed by hand, at its arrival."""
        message = m.SceneEvent(event.object, event.state)
        self._append(topics.SCENE_EVENT, event.stamp_ns, message)

    def append_core(self, entry: CoreEntry) -> None:
        """What else entered the core, at the time that the core was given."""
        self._append(topics.CORE, entry.stamp_ns, entry)

    def append_scene(self, state: m.SceneState, stamp_ns: int) -> None:
        """The room after a change, at the time of the change."""
        self._append(topics.SCENE, stamp_ns, state)

    def append_decision(self, decision: m.DecisionMessage, stamp_ns: int) -> None:
        """A decision and its timing, at the time of the decision."""
        self._append(topics.DECISION, stamp_ns, decision)

    def append_command(self, command: m.CommandMessage) -> None:
        """A command, at the time at which it was issued."""
        self._append(topics.COMMAND, command.issued_ns, command)

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
        self._sink.flush()

    def close(self) -> None:
        """Finish the file with its index and summary. Does nothing the second time."""
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

    def _append(self, topic: Topic, stamp_ns: int, record: msgspec.Struct) -> None:
        channel = self._channels.get(topic.name)
        if channel is None:
            schema = (topic.schema, "jsonschema", json_schema(topic.record))
            channel = self._channels[topic.name] = self._sink.channel(topic.name, "json", schema)
        self._sink.message(channel, stamp_ns, self._sequence, self._encoder.encode(record))
        self._sequence += 1
