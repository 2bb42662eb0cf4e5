"""The VMC protocol's performer: one session's person as an avatar program can show them.

OSC over UDP, as https://protocol.vmc.info has it. :class:`Performer` makes datagrams and knows no
socket; :class:`VmcSender` sends them.
"""

import logging
import socket
from collections.abc import Iterable
from dataclasses import dataclass, field

from pythonosc.osc_bundle_builder import IMMEDIATELY, OscBundleBuilder
from pythonosc.osc_message import OscMessage
from pythonosc.osc_message_builder import OscMessageBuilder

from agent_server.config import VmcSettings
from agent_server.domain.arrays import Float32, Float64
from agent_server.domain.face import ARKIT_BLENDSHAPES, Face, FaceBlendshapes
from agent_server.domain.motion import FRAME_NS, PREDICTED_FRAMES, Forecast
from agent_server.domain.skeleton import CoreFrame
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.errors import ConfigError
from agent_server.service.avatar import Avatar, NoAvatar
from agent_server.skeleton.humanoid import (
    HUMAN_BONE_NAMES,
    REST_OFFSETS,
    REST_ROTATIONS,
    human_rotations,
)

log = logging.getLogger(__name__)

MAX_DATAGRAM_BYTES = 1400
"""What an Ethernet frame carries without being cut up; faces are spread over several."""

_BUNDLE_BYTES = 16
_SIZE_BYTES = 4


@dataclass(slots=True)
class _Showing:
    """The session that is shown.

    Attributes:
        session_id: Which.
        start_ns: Stamp of its first body, from which the protocol's time is counted.
        rotations: Shape (11, 4), the bones as they were shown last.
        forecast: The latest one, or None.
        end_ns: Where the window of the forecast ends.
    """

    session_id: str
    start_ns: int
    rotations: Float64 = field(default_factory=lambda: REST_ROTATIONS)
    forecast: Forecast | None = None
    end_ns: int = 0


class Performer:
    """Turns what sessions see into datagrams, for one session at a time.

    A predicted body is played in time: with each observed frame goes the pose that the latest
    forecast has for ``lead_ms`` later. None is sent before the first forecast, nor after the
    end of the latest.

    Args:
        settings: What to show.
    """

    def __init__(self, settings: VmcSettings) -> None:
        self._settings = settings
        self._showing: _Showing | None = None

    def body(self, session_id: str, frame: CoreFrame) -> list[bytes]:
        """Take a body; the first one decides which session is shown.

        Args:
            session_id: Whose it is.
            frame: On the session's time line.

        Returns:
            Datagrams with time, root and bones; none where this session is not shown.
        """
        showing = self._showing
        if showing is None and self._settings.session in ("", session_id):
            showing = self._showing = _Showing(session_id, frame.stamp_ns)
        if showing is None or showing.session_id != session_id:
            return []
        positions = self._pose(showing, frame)
        if positions is None:
            return []
        showing.rotations = human_rotations(positions, showing.rotations)
        seconds = (frame.stamp_ns - showing.start_ns) / NS_PER_S
        return _datagrams(_body_messages(seconds, showing.rotations))

    def forecast(self, session_id: str, forecast: Forecast, end_ns: int) -> None:
        """Take a forecast, to be shown with the bodies that follow."""
        showing = self._showing
        if showing is not None and showing.session_id == session_id:
            showing.forecast, showing.end_ns = forecast, end_ns

    def face(self, session_id: str, face: Face) -> list[bytes]:
        """Take a face.

        Returns:
            Datagrams with the blendshapes; none for landmarks, nor where this session's body is
            not shown.
        """
        showing = self._showing
        if showing is None or showing.session_id != session_id:
            return []
        return _datagrams(_face_messages(face)) if isinstance(face, FaceBlendshapes) else []

    def forget(self, session_id: str) -> list[bytes]:
        """Stop showing a session; the next body of any decides anew.

        Returns:
            A datagram that says so; none where this session is not shown.
        """
        if self._showing is None or self._showing.session_id != session_id:
            return []
        self._showing = None
        return _datagrams([_message("/VMC/Ext/OK", 0)])

    def _pose(self, showing: _Showing, frame: CoreFrame) -> Float32 | None:
        """Core joints to show, shape (9, 3), or None."""
        if self._settings.show == "observed":
            return frame.positions
        if showing.forecast is None:
            return None
        ahead_ns = frame.stamp_ns + self._settings.lead_ms * NS_PER_MS - showing.end_ns
        # The forecast's first pose is one frame after the window's end.
        index = round(ahead_ns / FRAME_NS) - 1
        return showing.forecast.positions[index] if 0 <= index < PREDICTED_FRAMES else None


class VmcSender:
    """Sends a performer's datagrams; what cannot be sent is counted and dropped.

    Args:
        performer: What makes the datagrams.
        sender: A UDP socket that is connected to the avatar program and does not block; it is
            closed with the sender.

    Attributes:
        failures: Datagrams that could not be sent.
    """

    def __init__(self, performer: Performer, sender: socket.socket) -> None:
        self.failures = 0
        self._performer = performer
        self._socket = sender

    def show_body(self, session_id: str, frame: CoreFrame) -> None:
        """Send the body, or the predicted one in its place."""
        self._send(self._performer.body(session_id, frame))

    def show_forecast(self, session_id: str, forecast: Forecast, end_ns: int) -> None:
        """Keep the forecast for the bodies that follow."""
        self._performer.forecast(session_id, forecast, end_ns)

    def show_face(self, session_id: str, face: Face) -> None:
        """Send the face, where it is known by blendshapes."""
        self._send(self._performer.face(session_id, face))

    def forget(self, session_id: str) -> None:
        """Say that there is nobody to show, where it was this session."""
        self._send(self._performer.forget(session_id))

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()

    def _send(self, datagrams: list[bytes]) -> None:
        for datagram in datagrams:
            try:
                self._socket.send(datagram)
            except OSError as error:
                self.failures += 1
                if self.failures == 1:
                    log.warning("no avatar program can be reached (%s); this is said once", error)


def open_avatar(settings: VmcSettings) -> Avatar:
    """What the settings ask for: a sender, or nothing.

    Raises:
        ConfigError: If there is no way to the host.
    """
    if not settings.enabled:
        return NoAvatar()
    sender: socket.socket | None = None
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            settings.host, settings.port, type=socket.SOCK_DGRAM
        )[0]
        sender = socket.socket(family, kind, protocol)
        sender.setblocking(False)
        sender.connect(address)
    except (OSError, UnicodeError) as error:
        if sender is not None:
            sender.close()
        raise ConfigError(
            f"[vmc] host {settings.host!r} cannot be used ({error}): give the address of the "
            "avatar program's machine, for example 127.0.0.1"
        ) from error
    return VmcSender(Performer(settings), sender)


def _body_messages(seconds: float, rotations: Float64) -> list[OscMessage]:
    return [
        _message("/VMC/Ext/OK", 1),
        _message("/VMC/Ext/T", seconds),
        _message("/VMC/Ext/Root/Pos", "root", 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0),
        *(
            _message("/VMC/Ext/Bone/Pos", name, *offset.tolist(), *rotation.tolist())
            for name, offset, rotation in zip(
                HUMAN_BONE_NAMES, REST_OFFSETS, rotations, strict=True
            )
        ),
    ]


def _face_messages(face: FaceBlendshapes) -> list[OscMessage]:
    return [
        *(
            _message("/VMC/Ext/Blend/Val", name, value)
            for name, value in zip(ARKIT_BLENDSHAPES, face.values.tolist(), strict=True)
        ),
        _message("/VMC/Ext/Blend/Apply"),
    ]


def _message(address: str, *arguments: str | int | float) -> OscMessage:
    builder = OscMessageBuilder(address)
    for argument in arguments:
        builder.add_arg(argument)
    return builder.build()


def _datagrams(messages: Iterable[OscMessage]) -> list[bytes]:
    """Bundles of at most ``MAX_DATAGRAM_BYTES`` that hold the messages in order."""
    bundles: list[OscBundleBuilder] = []
    size = MAX_DATAGRAM_BYTES
    for message in messages:
        size += _SIZE_BYTES + message.size
        if size > MAX_DATAGRAM_BYTES:
            bundles.append(OscBundleBuilder(IMMEDIATELY))
            size = _BUNDLE_BYTES + _SIZE_BYTES + message.size
        bundles[-1].add_content(message)
    return [bundle.build().dgram for bundle in bundles]
