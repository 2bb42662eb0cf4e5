"""What a recording says about itself."""

import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path

from agent_server.errors import RecordingError

FORMAT_VERSION = 1
"""Counts the layouts of recordings. Every older one stays readable."""

METADATA_NAME = "agent_server"
_BUNDLE = "bundle."
_CHECKSUM = "checksum"
_WORDS = {True: "yes", False: "no"}


@dataclass(frozen=True, slots=True)
class RecordingMetadata:
    """The metadata record ``agent_server`` of a recording.

    Attributes:
        session: Id of the recorded session.
        server_version: Version of the server or converter that wrote it.
        face: What the sensor's hello said of the face, ``expected`` or ``none``; None where
            the recording began before a hello.
        joint_format: Joint table of the skeletons, or None where it was not known yet.
        bundles: Name of a model bundle -> its hash.
        created: Wall time in ISO 8601, or None for a generated file, which is the same in
            every run.
        description: What it shows, in a sentence.
        licence: Under which terms it may be used.
        origin: Where it comes from.
        config: Hash of the settings that decisions depend on.
        rules: Hash of the room's rule file.
        participant: Pseudonym of the person; the name itself belongs nowhere near.
        consent: Whether the person has agreed to be recorded; None where nobody said so.
        part: Counts the files of one recording from 1; one that has become too large or too old
            goes on in the next. A later part begins in the middle.
        format_version: Layout of the recording.
    """

    session: str
    server_version: str
    face: str | None = None
    joint_format: str | None = None
    bundles: Mapping[str, str] = field(default_factory=dict)
    created: str | None = None
    description: str | None = None
    licence: str | None = None
    origin: str | None = None
    config: str | None = None
    rules: str | None = None
    participant: str | None = None
    consent: bool | None = None
    part: int = 1
    format_version: int = FORMAT_VERSION

    def to_strings(self) -> dict[str, str]:
        """As MCAP stores it: text by name, a bundle as ``bundle.NAME``, and a checksum."""
        strings = {"format_version": str(self.format_version)}
        for name in _TEXTS:
            value = getattr(self, name)
            if value is not None:
                strings[name] = value
        if self.consent is not None:
            strings["consent"] = _WORDS[self.consent]
        if self.part > 1:
            strings["part"] = str(self.part)
        strings.update({_BUNDLE + name: self.bundles[name] for name in sorted(self.bundles)})
        return {**strings, _CHECKSUM: _checksum(strings)}

    @classmethod
    def from_strings(
        cls, strings: Mapping[str, str], path: Path, offset: int
    ) -> "RecordingMetadata":
        """Read what :meth:`to_strings` gave; names that are not known are passed over.

        Raises:
            RecordingError: If the version is not one of this server's, a name is missing, or the
                checksum, which older files lack, is another.
        """
        version = strings.get("format_version", "")
        if not version.isdecimal() or not 1 <= int(version) <= FORMAT_VERSION:
            raise RecordingError(
                f"{path}, byte {offset}: format version {version or 'none'}, this server reads 1 "
                f"to {FORMAT_VERSION}: use a newer server"
            )
        part, said = strings.get("part", "1"), strings.get(_CHECKSUM)
        if said not in (None, _checksum(strings)) or not part.isdecimal():
            raise RecordingError(
                f"{path}, byte {offset}: its metadata are corrupt, their checksum is wrong"
            )
        missing = [name for name in ("session", "server_version") if name not in strings]
        if missing:
            raise RecordingError(
                f"{path}, byte {offset}: its metadata lack {' and '.join(missing)}"
            )
        return cls(
            **{name: strings[name] for name in _TEXTS if name in strings},
            bundles={
                name.removeprefix(_BUNDLE): value
                for name, value in strings.items()
                if name.startswith(_BUNDLE)
            },
            consent={word: value for value, word in _WORDS.items()}.get(strings.get("consent", "")),
            part=int(part),
            format_version=int(version),
        )


def _checksum(strings: Mapping[str, str]) -> str:
    """Of everything but itself: names and values do not stand in a chunk, whose CRC would tell."""
    lines = (f"{name}={strings[name]}\n" for name in sorted(strings) if name != _CHECKSUM)
    return f"{zlib.crc32(''.join(lines).encode()):08x}"


_TEXTS = tuple(
    field.name
    for field in fields(RecordingMetadata)
    if field.name not in ("bundles", "format_version", "consent", "part")
)
