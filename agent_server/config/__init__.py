"""Settings: frozen values that refuse contradictions with a sentence.

Defaults are sane; a TOML file may override any of them, section by section, and the environment
any of the file's: ``AGENT_SERVER__SERVER__PORT=9000`` is ``port = 9000`` under ``[server]``.
Secrets are no settings: they come from files or environment variables of their own.
"""

from agent_server.config.explain import explain
from agent_server.config.load import load_settings, mistakes_in
from agent_server.config.recording import RecordingSettings
from agent_server.config.server import AccessSettings, ServerSettings, VmcSettings
from agent_server.config.settings import Settings
from agent_server.config.stages import (
    DecideSettings,
    FaceSettings,
    GateSettings,
    GazeSettings,
    ModelSettings,
    SubjectSettings,
    WindowSettings,
)

__all__ = [
    "AccessSettings",
    "DecideSettings",
    "FaceSettings",
    "GateSettings",
    "GazeSettings",
    "ModelSettings",
    "RecordingSettings",
    "ServerSettings",
    "Settings",
    "SubjectSettings",
    "VmcSettings",
    "WindowSettings",
    "explain",
    "load_settings",
    "mistakes_in",
]
