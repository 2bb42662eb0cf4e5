"""How a person is read and when the agent reacts."""

from collections.abc import Iterator
from math import isfinite
from typing import Literal

from agent_server.config.section import Section, unless

MOST_FUTURES = 16
"""As many rows are known to have the same bits in a batch as alone."""


class WindowSettings(Section, frozen=True):
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

    def contradictions(self) -> Iterator[str]:
        """What these values break."""
        yield from unless(1 <= self.hop_frames <= 25, "hop_frames must lie in 1..25")
        yield from unless(40 <= self.max_gap_ms <= 2000, "max_gap_ms must lie in 40..2000")

    @property
    def hop(self) -> int:
        """Frames between two windows."""
        return 25 if self.mode == "thesis" else self.hop_frames


class SubjectSettings(Section, frozen=True):
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

    def contradictions(self) -> Iterator[str]:
        """What these values break."""
        yield from unless(
            (self.policy == "explicit") == (self.body_id is not None),
            "body_id goes with policy = 'explicit' and with no other",
        )
        yield from unless(0 < self.release_s <= self.lost_s, "release_s must lie in 0..lost_s")


class GateSettings(Section, frozen=True):
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

    def contradictions(self) -> Iterator[str]:
        """What these values break."""
        yield from unless(
            self.enter_valence <= self.leave_valence <= self.pleasant_valence,
            "enter_valence <= leave_valence <= pleasant_valence must hold",
        )
        yield from unless(
            0 <= self.leave_arousal <= self.enter_arousal,
            "0 <= leave_arousal <= enter_arousal must hold",
        )
        yield from unless(
            0 < self.pair_tolerance_ms <= self.max_age_ms,
            "0 < pair_tolerance_ms <= max_age_ms must hold",
        )


class GazeSettings(Section, frozen=True):
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

    def contradictions(self) -> Iterator[str]:
        """What these values break."""
        yield from unless(all(map(isfinite, self.agent)), "agent must be finite")
        yield from unless(
            0 < self.enter_deg <= self.leave_deg < 90, "0 < enter_deg <= leave_deg < 90 must hold"
        )
        yield from unless(self.dwell_ms >= 0, "dwell_ms must not be negative")
        yield from unless(self.max_age_ms > 0, "max_age_ms must be positive")


class FaceSettings(Section, frozen=True):
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

    def contradictions(self) -> Iterator[str]:
        """What these values break."""
        yield from unless(0 <= self.window_ms <= 5000, "window_ms must lie in 0..5000")


class DecideSettings(Section, frozen=True):
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

    def contradictions(self) -> Iterator[str]:
        """What these values break."""
        yield from unless(
            0 < self.leave <= self.enter <= self.enter_ungated < 1,
            "0 < leave <= enter <= enter_ungated < 1 must hold",
        )
        yield from unless(self.enter_windows >= 1, "enter_windows must be at least 1")
        yield from unless(self.leave_windows >= 1, "leave_windows must be at least 1")
        yield from unless(self.cooldown_s >= 0, "cooldown_s must not be negative")


class ModelSettings(Section, frozen=True):
    """Which models run.

    Attributes:
        predictor: Folder of the bundle that continues motion; None takes the one that ships.
        classifier: Folder of the bundle that names it; None takes the one that ships.
        futures: How many futures a window is classified with: 1 is the forecast alone, more are
            the forecast and others that are drawn beside it.
        sampler: Folder of the bundle that draws them; None takes the one that ships.
        futures_quality: A drawn future that is less probably real than this is left out.
        reactions: Folder of the bundle that makes reactions for rules with motion = "generated";
            None makes none. None ships: the weights may be used for research alone.
        folder: Folder within which a running server may be told to take bundles from; None lets
            nobody change its models.
    """

    predictor: str | None = None
    classifier: str | None = None
    futures: int = 1
    sampler: str | None = None
    futures_quality: float = 0.5
    reactions: str | None = None
    folder: str | None = None

    def contradictions(self) -> Iterator[str]:
        """What these values break."""
        for name in ("predictor", "classifier", "sampler", "reactions", "folder"):
            yield from unless(getattr(self, name) != "", f"{name} must name a folder")
        yield from unless(
            1 <= self.futures <= MOST_FUTURES, f"futures must lie in 1..{MOST_FUTURES}"
        )
        yield from unless(0 <= self.futures_quality < 1, "futures_quality must lie in 0..1")
