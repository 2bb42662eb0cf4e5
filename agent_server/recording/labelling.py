"""What the tags of other data sets are in terms of this product's gestures."""

from collections.abc import Mapping
from dataclasses import dataclass

from agent_server.domain.gesture import IDLE
from agent_server.domain.label import Label
from agent_server.domain.stamp import NS_PER_MS
from agent_server.skeleton.readers.source import Mark, SourceRecording

MSRC12_GESTURES = {"G4": "bright", "G9": "loud"}
MSRC12_QUIET = frozenset({"G2", "G3", "G6", "G7", "G8", "G12"})
MSRC12_AROUND_NS = 1500 * NS_PER_MS
"""A tag marks the moment at which a gesture has been performed: a label reaches this far
before and after it."""

UTD_MHAD_GESTURES = {"a3": "hello"}
UTD_MHAD_QUIET = frozenset(f"a{n}" for n in range(12, 28)) - {"a16", "a18", "a19"}


@dataclass(frozen=True, slots=True)
class TaggedLabel:
    """A label with the data set's own name of the gesture."""

    label: Label
    tag: str


def label_msrc12(recording: SourceRecording) -> list[TaggedLabel]:
    """A label from 1.5 s before to 1.5 s after each mark, within the recording.

    Goggles are ``bright``, had enough is ``loud``, all else is ``idle``; ``quiet`` are those
    that resemble none of the product's gestures.
    """
    return [
        _label(
            recording,
            mark,
            MSRC12_GESTURES,
            MSRC12_QUIET,
            max(mark.stamp_ns - MSRC12_AROUND_NS, 0),
            min(mark.stamp_ns + MSRC12_AROUND_NS, recording.end_ns),
        )
        for mark in recording.marks
    ]


def label_utd_mhad(recording: SourceRecording) -> list[TaggedLabel]:
    """One label over the whole recording: wave is ``hello``, all else is ``idle``.

    ``quiet`` are the actions that resemble none of the product's gestures.
    """
    return [
        _label(recording, mark, UTD_MHAD_GESTURES, UTD_MHAD_QUIET, 0, recording.end_ns)
        for mark in recording.marks
    ]


def _label(
    recording: SourceRecording,
    mark: Mark,
    gestures: Mapping[str, str],
    quiet: frozenset[str],
    onset_ns: int,
    offset_ns: int,
) -> TaggedLabel:
    label = Label(
        gesture=gestures.get(mark.tag, IDLE),
        onset_ns=onset_ns,
        offset_ns=offset_ns,
        subject=recording.subject,
        expected=None,
        quiet=mark.tag in quiet,
    )
    return TaggedLabel(label, mark.tag)
