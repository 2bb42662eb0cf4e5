"""What is in a recording, without replaying it."""

from collections import Counter, defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from agent_server.domain.affect import AffectSample
from agent_server.domain.face import FaceBlendshapes, FaceLandmarks, GazeSample
from agent_server.domain.label import Label
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.qa.result import Stretch
from agent_server.recording import topics
from agent_server.recording.reader import open_recording


@dataclass(frozen=True, slots=True)
class BodyInfo:
    """One body.

    Attributes:
        body_id: As its sensor calls it.
        format: Its joint table.
        frames: Number of skeletons.
        from_s: First one, in seconds ...
        to_s: ... and last one.
        rate_hz: Frames a second, from the median time between two; None with a single frame.
        longest_gap_s: Longest time between two.
    """

    body_id: int
    format: str
    frames: int
    from_s: float
    to_s: float
    rate_hz: float | None
    longest_gap_s: float


@dataclass(frozen=True, slots=True)
class RecordingInfo:
    """A recording in short.

    Attributes:
        file: Its path.
        metadata: What it says about itself.
        duration_s: Time of the last record.
        size_bytes: Size of the file.
        topics: Topic -> number of records.
        has_core_log: Whether a replay follows a log of the core to the letter.
        bodies: In the order in which they come.
        faces: What kinds of faces there are -> how many.
        labels: Ground truth.
        expected: Reaction -> how many labels expect it.
    """

    file: str
    metadata: Mapping[str, str]
    duration_s: float
    size_bytes: int
    topics: Mapping[str, int]
    has_core_log: bool
    bodies: tuple[BodyInfo, ...]
    faces: Mapping[str, int]
    labels: tuple[Stretch, ...]
    expected: Mapping[str, int]


def describe(path: Path) -> RecordingInfo:
    """Read a recording's records.

    Raises:
        RecordingError: If it cannot be read.
    """
    recording = open_recording(path)
    stamps: dict[int, list[int]] = defaultdict(list)
    formats: dict[int, str] = {}
    faces: Counter[str] = Counter()
    for event in recording.events():
        if isinstance(event, SkeletonFrame):
            stamps[event.body_id].append(event.originating_ns)
            formats[event.body_id] = event.format
        else:
            kind = _face_kind(event)
            if kind is not None:
                faces[kind] += 1
    labels = recording.labels()
    return RecordingInfo(
        file=str(path),
        metadata=recording.metadata.to_strings(),
        duration_s=recording.summary.end_ns / NS_PER_S,
        size_bytes=recording.summary.size_bytes,
        topics=recording.summary.topics,
        has_core_log=topics.CORE.name in recording.summary.topics,
        bodies=tuple(_body(body_id, formats[body_id], at) for body_id, at in stamps.items()),
        faces=faces,
        labels=tuple(_stretch(label) for label in labels),
        expected=Counter(label.expected for label in labels if label.expected is not None),
    )


def _body(body_id: int, name: str, stamps: list[int]) -> BodyInfo:
    steps = np.diff(np.sort(stamps)) / NS_PER_S
    moving = steps[steps > 0]
    return BodyInfo(
        body_id=body_id,
        format=name,
        frames=len(stamps),
        from_s=min(stamps) / NS_PER_S,
        to_s=max(stamps) / NS_PER_S,
        rate_hz=round(float(1 / np.median(moving)), 1) if len(moving) else None,
        longest_gap_s=round(float(steps.max()), 3) if len(steps) else 0.0,
    )


def _face_kind(event: object) -> str | None:
    match event:
        case FaceLandmarks(layout=layout):
            return layout.value
        case FaceBlendshapes():
            return "blendshapes"
        case AffectSample():
            return "valence and arousal"
        case GazeSample():
            return "gaze"
    return None


def _stretch(label: Label) -> Stretch:
    return Stretch(
        label.gesture,
        round(label.onset_ns / NS_PER_MS),
        round(label.offset_ns / NS_PER_MS),
        label.expected,
        label.quiet,
    )
