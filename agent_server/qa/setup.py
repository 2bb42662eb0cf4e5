"""What decides in a replay."""

from dataclasses import dataclass

from agent_server.config import Settings
from agent_server.qa.watch import WatchedCore
from agent_server.scene.rulebook import Rules
from agent_server.service.loading import load_models, load_room
from agent_server.service.models import Models


@dataclass(frozen=True, slots=True)
class Setup:
    """Settings, models and rules."""

    settings: Settings
    models: Models
    rules: Rules

    def core(self, session: str) -> WatchedCore:
        """A fresh core."""
        return WatchedCore(session, self.settings, self.rules, self.models)


def load_setup(settings: Settings) -> Setup:
    """Load what decides.

    Raises:
        AgentServerError: If models or rules are missing or wrong.
    """
    models = load_models(settings)
    return Setup(settings, models, load_room(settings, models))
