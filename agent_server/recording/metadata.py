"""What a recording says about itself."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path

from agent_server.errors import RecordingError

FORMAT_VERSION = 1
"""Counts the layouts of recordings. Every older one stays readable."""

METADATA_NAME = "agent_server"
_BUNDLE = "bundle."


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
    format_version: int = FORMAT_VERSION

    def to_strings(self) -> dict[str, str]:
        """As MCAP stores it: text by name, a bundle as ``bundle.NAME``."""
        strings = {"format_version": str(self.format_version)}
        for name in _TEXTS:
            value = getattr(self, name)
            if value is not None:
                strings[name] = value
        strings.update({_BUNDLE + name: self.bundles[name] for name in sorted(self.bundles)})
        return strings

    @classmethod
    def from_strings(cls, strings: Mapping[str, str], path: Path) -> "RecordingMetadata":
        """Read what :meth:`to_strings` gave; names that are not known are passed over.

        Raises:
            RecordingError: If the version is not one of this server's, or a name is missing.
        """
        version = strings.get("format_version", "")
        if not version.isdecimal() or not 1 <= int(version) <= FORMAT_VERSION:
            raise RecordingError(
                f"{path} has format version {version or 'none'}, this server reads 1 to "
                f"{FORMAT_VERSION}: use a newer server"
            )
        missing = [name for name in ("session", "server_version") if name not in strings]
        if missing:
            raise RecordingError(f"{path}: its metadata lack {' and '.join(missing)}")
        return cls(
            **{name: strings[name] for name in _TEXTS if name in strings},
            bundles={
                name.removeprefix(_BUNDLE): value
                for name, value in strings.items()
                if name.startswith(_BUNDLE)
            },
            format_version=int(version),
        )


_TEXTS = tuple(
    field.name
    for field in fields(RecordingMetadata)
    if field.name not in ("bundles", "format_version")
)
