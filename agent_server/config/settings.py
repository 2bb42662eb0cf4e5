"""All settings."""

from collections.abc import Iterator

from agent_server.config.recording import RecordingSettings
from agent_server.config.section import Section, unless
from agent_server.config.server import AccessSettings, ServerSettings, VmcSettings
from agent_server.config.stages import (
    DecideSettings,
    FaceSettings,
    GateSettings,
    GazeSettings,
    ModelSettings,
    SubjectSettings,
    WindowSettings,
)


class Settings(Section, frozen=True):
    """All settings. Paths are relative to the folder in which the server is started.

    Attributes:
        rules: Path of the room's rule file; None takes the one that ships.
    """

    window: WindowSettings = WindowSettings()
    subject: SubjectSettings = SubjectSettings()
    face: FaceSettings = FaceSettings()
    gate: GateSettings = GateSettings()
    gaze: GazeSettings = GazeSettings()
    decide: DecideSettings = DecideSettings()
    models: ModelSettings = ModelSettings()
    server: ServerSettings = ServerSettings()
    access: AccessSettings = AccessSettings()
    vmc: VmcSettings = VmcSettings()
    recording: RecordingSettings = RecordingSettings()
    rules: str | None = None

    def contradictions(self) -> Iterator[str]:
        """What these values break."""
        yield from unless(self.rules != "", "rules must name a file")
