"""Recordings of other tools and data sets as recordings of this product."""

import heapq
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from operator import itemgetter
from pathlib import Path
from typing import Literal

from agent_server import __version__
from agent_server.domain.affect import AFFECT_LIMIT, AffectSample
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import NS_PER_S, to_ns
from agent_server.errors import InvalidInput
from agent_server.protocol.convert import skeleton_from_message, skeleton_to_message
from agent_server.recording.labelling import TaggedLabel, label_msrc12, label_utd_mhad
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.whole import whole_file
from agent_server.recording.writer import RecordingWriter
from agent_server.skeleton.readers.kinect_json import read_kinect_json
from agent_server.skeleton.readers.msrc12 import read_msrc12
from agent_server.skeleton.readers.ntu import read_ntu
from agent_server.skeleton.readers.source import SourceRecording
from agent_server.skeleton.readers.utd_mhad import read_utd_mhad

Source = Literal["msrc12", "ntu", "kinect-json", "utd-mhad"]


@dataclass(frozen=True, slots=True)
class ConstantAffect:
    """An invented face that never changes, so that a body-only recording can pass the gate.

    Attributes:
        valence: In [-10, 10].
        arousal: In [-10, 10].
        rate_hz: Estimates a second.

    Raises:
        InvalidInput: If a value is out of range.
    """

    valence: float
    arousal: float
    rate_hz: float = 10.0

    def __post_init__(self) -> None:
        for name in ("valence", "arousal"):
            value = getattr(self, name)
            if not abs(value) <= AFFECT_LIMIT:
                raise InvalidInput(
                    f"{name} is {value:g}: it lies in [-{AFFECT_LIMIT:g}, {AFFECT_LIMIT:g}]",
                    field=name,
                    code="out_of_range",
                )
        if not 0 < self.rate_hz <= 1000:
            raise InvalidInput(
                f"rate_hz is {self.rate_hz:g}: it lies in (0, 1000]",
                field="rate_hz",
                code="out_of_range",
            )


@dataclass(frozen=True, slots=True)
class ConversionReport:
    """What came into a converted recording.

    Attributes:
        format: Joint table of the skeletons.
        subject: Who moves.
        frames: Number of skeletons.
        bodies: Number of different bodies.
        labels: Gesture -> number of labels.
        duration_s: Time of the last skeleton.
        dropped: Reason -> how many frames or marks of the source were left out.
    """

    format: str
    subject: str
    frames: int
    bodies: int
    labels: Mapping[str, int]
    duration_s: float
    dropped: Mapping[str, int]


@dataclass(frozen=True, slots=True)
class _Kind:
    """How one kind of source is read, labelled and described."""

    read: Callable[[Path], SourceRecording]
    title: str
    licence: str | None = None
    label: Callable[[SourceRecording], list[TaggedLabel]] = lambda _: []


_KINDS: Mapping[str, _Kind] = {
    "msrc12": _Kind(read_msrc12, "MSRC-12", "non-commercial research only", label_msrc12),
    "ntu": _Kind(read_ntu, "NTU RGB+D", "academic research only"),
    "kinect-json": _Kind(read_kinect_json, "JSON lines"),
    "utd-mhad": _Kind(read_utd_mhad, "UTD-MHAD", "research only", label_utd_mhad),
}


def convert(
    source: Source, path: Path, output: Path, *, affect: ConstantAffect | None = None
) -> ConversionReport:
    """Convert one recording; the same input gives the same bytes.

    Skeletons are checked and rounded as the server does with those that come in live. Without
    ``affect`` the recording says that its sensor has no face.

    Args:
        source: What kind of recording it is.
        path: The recording.
        output: File to create; it must not exist.
        affect: A constant affect track to add.

    Raises:
        InvalidInput: If the source is not one of the known kinds, or its content is wrong.
        RecordingError: If a file cannot be read or written.
    """
    kind = _KINDS.get(source)
    if kind is None:
        raise InvalidInput(
            f"source is {source!r}: it is one of {', '.join(_KINDS)}", field="source"
        )
    recording = kind.read(path)
    if not recording.frames:
        raise InvalidInput(f"{path} shows no tracked body, so there is nothing to convert")
    frames = _ingested(path, recording)
    labels = kind.label(recording)
    faces = [] if affect is None else _constant(affect, recording.end_ns)
    metadata = _metadata(kind, path, recording, affect)
    with whole_file(output) as part, RecordingWriter(part, metadata) as writer:
        appends = heapq.merge(
            ((t.label.onset_ns, partial(writer.append_label, t.label, t.tag)) for t in labels),
            ((f.originating_ns, partial(writer.append_input, f)) for f in faces),
            ((f.originating_ns, partial(writer.append_input, f)) for f in frames),
            key=itemgetter(0),
        )
        for _, append in appends:
            append()
    return ConversionReport(
        format=recording.format,
        subject=recording.subject,
        frames=len(frames),
        bodies=len({frame.body_id for frame in frames}),
        labels=Counter(tagged.label.gesture for tagged in labels),
        duration_s=recording.end_ns / NS_PER_S,
        dropped=recording.dropped,
    )


def _ingested(path: Path, recording: SourceRecording) -> list[SkeletonFrame]:
    frames = []
    for index, frame in enumerate(recording.frames):
        try:
            frames.append(skeleton_from_message(skeleton_to_message(frame)))
        except InvalidInput as error:
            raise InvalidInput(
                f"{path}, skeleton {index}: {error}", field=error.field, code=error.code
            ) from error
    return frames


def _constant(affect: ConstantAffect, end_ns: int) -> list[AffectSample]:
    count = int(end_ns / NS_PER_S * affect.rate_hz) + 1
    return [
        AffectSample(to_ns(index / affect.rate_hz), affect.valence, affect.arousal)
        for index in range(count)
    ]


def _metadata(
    kind: _Kind, path: Path, recording: SourceRecording, affect: ConstantAffect | None
) -> RecordingMetadata:
    tags = ", ".join(dict.fromkeys(mark.tag for mark in recording.marks))
    shown = f"{recording.subject} shows {tags}" if tags else f"{recording.subject} moves"
    added = "" if affect is None else "; the constant affect is invented"
    return RecordingMetadata(
        session=path.name.split(".")[0],
        server_version=__version__,
        face="none" if affect is None else "expected",
        joint_format=recording.format,
        description=f"{shown}{added}.",
        licence=kind.licence,
        origin=f"{kind.title}, {path.name}",
    )
