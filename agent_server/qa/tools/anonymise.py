"""A recording that no longer says whose it is, as far as that can be done.

What stays is motion: the lengths of bones and the way somebody moves can tell a person from
others, so the result is still to be treated as personal data.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import msgspec

from agent_server.config import FaceSettings
from agent_server.domain.affect import AffectSample, Calibration
from agent_server.domain.command import Ack, Command
from agent_server.domain.face import FaceBlendshapes, FaceLandmarks
from agent_server.domain.model import AffectModel
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.protocol import messages as m
from agent_server.recording.items import Entry, Image, Item, Tagged, read_entries, write_entry
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.reader import open_recording
from agent_server.recording.records import BodyGone, Restored, SensorChanged
from agent_server.recording.sink import AT_ONCE
from agent_server.recording.whole import whole_file
from agent_server.recording.writer import RecordingWriter
from agent_server.stages.affect import AffectEstimator

FaceKept = Literal["affect", "none"]


@dataclass(frozen=True, slots=True)
class AnonymiseReport:
    """What was taken out.

    Attributes:
        records: Records written.
        faces: Landmarks and blendshapes that were taken out.
        images: Pictures that were taken out.
        bodies: Bodies with a new number.
        subjects: People of labels with a new name.
        outputs: Decisions, commands and scenes that were left out; a replay makes them again.
    """

    records: int
    faces: int
    images: int
    bodies: int
    subjects: int
    outputs: int


def anonymise(
    source: Path,
    output: Path,
    pseudonym: str,
    affect: Mapping[str, AffectModel],
    settings: FaceSettings,
    *,
    face: FaceKept = "affect",
) -> AnonymiseReport:
    """Write a recording again without what names or shows a person.

    Pictures, landmarks and blendshapes go. With ``face="affect"`` the valence and arousal that
    the models read from them take their place, so that the gate opens and closes as before.
    Bodies are numbered from 1, people of labels p1, p2, ...; session and commands are named
    after the pseudonym. Of the metadata only what a replay needs stays: no wall time, no
    description, no origin. Decisions and commands, which hold wall times and the session's
    name, are left out.

    Args:
        source: A recording.
        output: File to create; it must not exist.
        pseudonym: New name of the session.
        affect: Models that read affect, by input kind.
        settings: How affect is averaged.
        face: What stays of the face: ``affect`` or ``none``.

    Raises:
        InferenceError: If affect cannot be read from a face.
        RecordingError: If a file cannot be read or written.
    """
    recording = open_recording(source)
    old = recording.metadata
    veil = _Veil(old.session, pseudonym, AffectEstimator(affect, settings), face)
    metadata = RecordingMetadata(
        session=pseudonym,
        server_version=old.server_version,
        face="none" if face == "none" and old.face is not None else old.face,
        joint_format=old.joint_format,
        bundles=old.bundles,
        config=old.config,
        rules=old.rules,
        licence=old.licence,
        consent=old.consent,
        description="Anonymised: faces, names and wall times were taken out.",
    )
    records = 0
    with whole_file(output) as path, RecordingWriter(path, metadata, AT_ONCE) as writer:
        for entry in read_entries(recording):
            veiled = veil.cover(entry)
            if veiled is not None:
                write_entry(writer, veiled)
                records += 1
    return AnonymiseReport(
        records, veil.faces, veil.images, len(veil.bodies), len(veil.subjects), veil.outputs
    )


class _Veil:
    """Changes records one by one, and remembers who is who."""

    def __init__(
        self, session: str, pseudonym: str, estimator: AffectEstimator, face: FaceKept
    ) -> None:
        self.faces = self.images = self.outputs = 0
        self.bodies: dict[int, int] = {}
        self.subjects: dict[str, str] = {}
        self._session, self._pseudonym = session, pseudonym
        self._estimator = estimator
        self._keeps_affect = face == "affect"

    def cover(self, entry: Entry) -> Entry | None:
        """The record without what tells who it is, or None where nothing is left."""
        changed = self._changed(entry.item)
        return None if changed is None else replace(entry, item=changed)

    def _changed(self, item: Item) -> Item | None:
        changed: Item | None = item
        match item:
            case SkeletonFrame():
                changed = replace(item, body_id=self._body(item.body_id))
            case FaceLandmarks() | FaceBlendshapes():
                self.faces += 1
                sample, _ = self._estimator.push(item)
                changed = sample if self._keeps_affect else None
            case Calibration():
                self._estimator.calibrate(item)
                changed = None
            case AffectSample():
                changed = item if self._keeps_affect else None
            case Image():
                self.images += 1
                changed = None
            case Tagged(label=label):
                changed = Tagged(replace(label, subject=self._subject(label.subject)), item.tag)
            case Ack():
                # The words of a failure are the renderer's own and may say anything.
                changed = replace(item, command_id=self._command(item.command_id), reason=None)
            case BodyGone():
                changed = msgspec.structs.replace(item, body_id=self._body(item.body_id))
            case SensorChanged() if not self._keeps_affect:
                changed = msgspec.structs.replace(item, face="none")
            case Restored():
                room = replace(item.room, command=self._renamed(item.room.command))
                changed = msgspec.structs.replace(item, room=room)
            case m.DecisionMessage() | m.CommandMessage() | m.SceneState():
                self.outputs += 1
                changed = None
        return changed

    def _body(self, body_id: int) -> int:
        return self.bodies.setdefault(body_id, len(self.bodies) + 1)

    def _subject(self, subject: str) -> str:
        return self.subjects.setdefault(subject, f"p{len(self.subjects) + 1}")

    def _command(self, command_id: str) -> str:
        own = f"{self._session}/"
        if command_id.startswith(own):
            return f"{self._pseudonym}/{command_id.removeprefix(own)}"
        return f"{self._pseudonym}/unknown"

    def _renamed(self, command: Command | None) -> Command | None:
        if command is None:
            return None
        preempts = None if command.preempts is None else self._command(command.preempts)
        return replace(command, id=self._command(command.id), preempts=preempts)
