"""Where sessions show the person to an avatar program, or do not.

:class:`agent_server.service.vmc.VmcSender` is one that does.
"""

from typing import Protocol

from agent_server.domain.face import Face
from agent_server.domain.motion import Forecast
from agent_server.domain.skeleton import CoreFrame


class Avatar(Protocol):
    """Takes what all sessions see of their persons; it never waits and never fails."""

    def show_body(self, session_id: str, frame: CoreFrame) -> None:
        """The followed person was seen."""
        ...

    def show_forecast(self, session_id: str, forecast: Forecast, end_ns: int) -> None:
        """The person's motion was predicted from a window that ends at ``end_ns``."""
        ...

    def show_face(self, session_id: str, face: Face) -> None:
        """The person's face was seen."""
        ...

    def forget(self, session_id: str) -> None:
        """The session is over, or its person has left."""
        ...

    def close(self) -> None:
        """The server stops."""
        ...


class NoAvatar:
    """Shows nothing."""

    def show_body(self, session_id: str, frame: CoreFrame) -> None:
        """Do nothing."""

    def show_forecast(self, session_id: str, forecast: Forecast, end_ns: int) -> None:
        """Do nothing."""

    def show_face(self, session_id: str, face: Face) -> None:
        """Do nothing."""

    def forget(self, session_id: str) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing."""
