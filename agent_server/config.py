"""Settings: frozen values that refuse contradictions with a sentence.

Defaults are sane; a TOML file may override any of them, section by section.
"""

import tomllib
from math import isfinite
from pathlib import Path
from typing import Literal

import msgspec

from agent_server.errors import ConfigError


class _Section(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Base of every section: unknown keys are refused."""


def _check_finite(section: _Section) -> None:
    for name in section.__struct_fields__:
        value = getattr(section, name)
        _require(not isinstance(value, float) or isfinite(value), f"{name} must be finite")


def _require(condition: bool, sentence: str) -> None:
    if not condition:
        raise ValueError(sentence)


class WindowSettings(_Section, frozen=True):
    """When a second of motion is handed to the models.

    Attributes:
        mode: ``sliding`` (a window every ``hop_frames``) or ``thesis`` (every 25 frames, no
            overlap, and one window is enough for a decision).
        hop_frames: Frames at 25 Hz between two windows in sliding mode.
        max_gap_ms: A longer gap between two frames empties the window.
    """

    mode: Literal["sliding", "thesis"] = "sliding"
    hop_frames: int = 5
    max_gap_ms: int = 250

    def __post_init__(self) -> None:
        _check_finite(self)
        _require(1 <= self.hop_frames <= 25, "hop_frames must lie in 1..25")
        _require(40 <= self.max_gap_ms <= 2000, "max_gap_ms must lie in 40..2000")

    @property
    def hop(self) -> int:
        """Frames between two windows."""
        return 25 if self.mode == "thesis" else self.hop_frames


class SubjectSettings(_Section, frozen=True):
    """Which body is followed.

    Attributes:
        policy: ``nearest`` to the sensor, ``first`` seen, or ``explicit``.
        body_id: The body to follow when the policy is ``explicit``.
        release_s: After this long without a frame another body may be followed.
        lost_s: After this long without a frame the body counts as gone.
    """

    policy: Literal["nearest", "first", "explicit"] = "nearest"
    body_id: int | None = None
    release_s: float = 1.0
    lost_s: float = 2.0

    def __post_init__(self) -> None:
        _check_finite(self)
        _require(
            (self.policy == "explicit") == (self.body_id is not None),
            "body_id goes with policy = 'explicit' and with no other",
        )
        _require(0 < self.release_s <= self.lost_s, "release_s must lie in 0..lost_s")


class GateSettings(_Section, frozen=True):
    """When a discomfort gesture may pass, on the [-10, 10] scale (thesis, section 5).

    Attributes:
        mode: ``required`` (no usable face: closed), ``optional`` (no usable face: open),
            ``off`` (always open), ``thesis`` (required, without hysteresis) or ``gaze`` (open
            while the person looks at the agent; see ``[gaze]``).
        enter_valence: Opens below this valence ...
        enter_arousal: ... and above this absolute arousal.
        leave_valence: Closes above this valence ...
        leave_arousal: ... or below this absolute arousal.
        pleasant_valence: Never open above this valence.
        pair_tolerance_ms: A face and a window that are captured farther apart are skewed: the
            face is used still, and monitors are warned.
        max_age_ms: A face that is captured farther from the window is stale: it is not used.
    """

    mode: Literal["required", "optional", "off", "thesis", "gaze"] = "required"
    enter_valence: float = -3.0
    enter_arousal: float = 3.0
    leave_valence: float = -2.0
    leave_arousal: float = 2.0
    pleasant_valence: float = 0.0
    pair_tolerance_ms: int = 250
    max_age_ms: int = 1000

    def __post_init__(self) -> None:
        _check_finite(self)
        _require(
            self.enter_valence <= self.leave_valence <= self.pleasant_valence,
            "enter_valence <= leave_valence <= pleasant_valence must hold",
        )
        _require(
            0 <= self.leave_arousal <= self.enter_arousal,
            "0 <= leave_arousal <= enter_arousal must hold",
        )
        _require(
            0 < self.pair_tolerance_ms <= self.max_age_ms,
            "0 < pair_tolerance_ms <= max_age_ms must hold",
        )


class GazeSettings(_Section, frozen=True):
    """When a person counts as looking at the agent, for the gate's mode ``gaze``.

    Attributes:
        agent: Where the agent's head is: x, y, z in metres, in the frame of the skeletons. The
            default is the sensor's place, where a screen with the agent usually stands.
        enter_deg: The gaze is on the agent within this angle ...
        leave_deg: ... and leaves it beyond this one.
        dwell_ms: It must rest there for this long.
        max_age_ms: A gaze older than this is not used.
    """

    agent: tuple[float, float, float] = (0.0, 0.0, 0.0)
    enter_deg: float = 12.0
    leave_deg: float = 18.0
    dwell_ms: int = 400
    max_age_ms: int = 500

    def __post_init__(self) -> None:
        _check_finite(self)
        _require(all(map(isfinite, self.agent)), "agent must be finite")
        _require(
            0 < self.enter_deg <= self.leave_deg < 90, "0 < enter_deg <= leave_deg < 90 must hold"
        )
        _require(self.dwell_ms >= 0, "dwell_ms must not be negative")
        _require(self.max_age_ms > 0, "max_age_ms must be positive")


class FaceSettings(_Section, frozen=True):
    """How valence and arousal are read from a face.

    Attributes:
        mesh: Which network finds the landmarks in images: ``full`` (478 points) or ``fast``
            (468 points, a third of the time, not as fine about eyes and lips).
        window_ms: Estimates of this long are averaged, 1 s as in the thesis; 0 takes each as it
            is. The average lags behind the face by half of it.
        record_images: Whether recordings hold the images too. A face is personal data.
    """

    mesh: Literal["full", "fast"] = "full"
    window_ms: int = 1000
    record_images: bool = False

    def __post_init__(self) -> None:
        _require(0 <= self.window_ms <= 5000, "window_ms must lie in 0..5000")


class DecideSettings(_Section, frozen=True):
    """How probabilities become one decision a gesture.

    Attributes:
        enter: A gesture is a candidate from this probability on ...
        enter_ungated: ... or from this one on, if no face has to confirm it.
        leave: A gesture that is going on ends below this probability.
        enter_windows: Windows in a row that a candidate needs.
        leave_windows: Windows in a row below ``leave`` that end a gesture.
        cooldown_s: The same gesture cannot start again for this long after its end.
    """

    enter: float = 0.65
    enter_ungated: float = 0.69
    leave: float = 0.4
    enter_windows: int = 3
    leave_windows: int = 2
    cooldown_s: float = 2.0

    def __post_init__(self) -> None:
        _check_finite(self)
        _require(
            0 < self.leave <= self.enter <= self.enter_ungated < 1,
            "0 < leave <= enter <= enter_ungated < 1 must hold",
        )
        _require(self.enter_windows >= 1, "enter_windows must be at least 1")
        _require(self.leave_windows >= 1, "leave_windows must be at least 1")
        _require(self.cooldown_s >= 0, "cooldown_s must not be negative")


class ModelSettings(_Section, frozen=True):
    """Which models run.

    Attributes:
        predictor: Folder of the bundle that continues motion; None takes the one that ships.
        classifier: Folder of the bundle that names it; None takes the one that ships.
    """

    predictor: str | None = None
    classifier: str | None = None

    def __post_init__(self) -> None:
        for name in self.__struct_fields__:
            _require(getattr(self, name) != "", f"{name} must name the folder of a bundle")


class ServerSettings(_Section, frozen=True):
    """The process and what it takes from clients.

    Attributes:
        host: Address to listen on.
        port: Port to listen on; 0 lets the system choose.
        max_sessions: Sessions at once; more are refused.
        max_message_bytes: A longer message is refused ...
        max_image_bytes: ... but for an image, which may have this many.
        max_errors: Bad messages that a connection may have open; good ones pay them back.
        hello_timeout_s: A client that has not said hello by then is sent away.
        heartbeat_s: How often either side pings.
        command_queue: Commands that may wait for a slow renderer.
        session_linger_s: A session without connections is kept this long.
        resume_s: A renderer whose connection broke keeps its place this long.
        state: Folder in which sessions are remembered over a restart; None keeps them in memory.
    """

    host: str = "127.0.0.1"
    port: int = 8765
    max_sessions: int = 256
    max_message_bytes: int = 64 * 1024
    max_image_bytes: int = 512 * 1024
    max_errors: int = 20
    hello_timeout_s: float = 10.0
    heartbeat_s: float = 4.0
    command_queue: int = 64
    session_linger_s: float = 60.0
    resume_s: float = 10.0
    state: str | None = None

    def __post_init__(self) -> None:
        _check_finite(self)
        _require(0 <= self.port <= 65535, "port must lie in 0..65535")
        _require(self.max_message_bytes >= 4096, "max_message_bytes must be at least 4096")
        _require(
            self.max_image_bytes >= self.max_message_bytes,
            "max_image_bytes must be at least max_message_bytes",
        )
        for name in ("max_sessions", "max_errors", "hello_timeout_s", "heartbeat_s"):
            _require(getattr(self, name) > 0, f"{name} must be positive")
        _require(self.command_queue >= 1, "command_queue must be at least 1")
        for name in ("session_linger_s", "resume_s"):
            _require(getattr(self, name) >= 0, f"{name} must not be negative")
        _require(self.state != "", "state must name a folder")


class VmcSettings(_Section, frozen=True):
    """Whether and where an avatar program gets a body to show, by the VMC protocol.

    Attributes:
        enabled: Whether anything is sent.
        host: Address of the program, best as a number. What is sent is personal data, not
            encrypted.
        port: UDP port at which it listens.
        show: The body as it is ``observed``, or as it is ``predicted`` to be a moment later.
        lead_ms: How much later, where it is predicted.
        session: Which session is shown; empty takes the first that has a body, until it has
            none any more.
    """

    enabled: bool = False
    host: str = "127.0.0.1"
    port: int = 39539
    show: Literal["observed", "predicted"] = "observed"
    lead_ms: int = 500
    session: str = ""

    def __post_init__(self) -> None:
        _require(self.host != "", "host must name the machine of the avatar program")
        _require(1 <= self.port <= 65535, "port must lie in 1..65535")
        _require(40 <= self.lead_ms <= 1000, "lead_ms must lie in 40..1000")


class Settings(_Section, frozen=True):
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
    vmc: VmcSettings = VmcSettings()
    rules: str | None = None


def load_settings(path: Path | None) -> Settings:
    """Read settings from a TOML file; None gives the defaults.

    Raises:
        ConfigError: If the file cannot be read or a setting is refused; the text names it.
    """
    if path is None:
        return Settings()
    try:
        table = tomllib.loads(path.read_text("utf-8"))
    except OSError as error:
        raise ConfigError(f"cannot read {path}: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path} is not valid TOML: {error}") from error
    try:
        return msgspec.convert(table, Settings)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{path}: {error}") from error
