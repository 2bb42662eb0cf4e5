"""Whole sessions with ground truth: frames, affect and labels of people in front of a sensor."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from agent_server.domain.affect import AffectSample
from agent_server.domain.face import Face
from agent_server.domain.gesture import HELLO, IDLE
from agent_server.domain.label import Label
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import to_ns
from agent_server.errors import ConfigError
from agent_server.synthetic.face import FaceKind, SyntheticFace
from agent_server.synthetic.mood import Expression, Look, affect_track
from agent_server.synthetic.passer_by import walk_through
from agent_server.synthetic.person import Person, Placement
from agent_server.synthetic.script import Script
from agent_server.synthetic.sensors import KINECT_V1, KINECT_V2, Sensor, observe_frames
from agent_server.synthetic.timeline import Stretch, Timeline

Sight = Literal["expected", "none"]
"""What a sensor's hello says of the face."""
BODY_ID = 3
PASSER_BY_ID = 5
LATE_REACTION_S = 2.0
"""How long after a gesture its reaction may still come; only then does quiet begin."""
DUTIES: dict[str, tuple[str, str, str, str]] = {
    "cold": ("close_window", "window", "open", "closed"),
    "hot": ("open_window", "window", "closed", "open"),
    "loud": ("turn_down_hifi", "hifi", "high", "low"),
    "smell": ("put_out_cigarette", "cigarette", "lit", "out"),
    "bright": ("close_curtain", "curtain", "open", "closed"),
}
"""Discomfort -> reaction, object, state that it needs, state that it leaves."""
GREETING = "greet"
INITIAL_ROOM: dict[str, str] = {
    "window": "open",
    "hifi": "high",
    "cigarette": "lit",
    "curtain": "open",
}


@dataclass(frozen=True, slots=True)
class Part:
    """One gesture of a scenario.

    Attributes:
        gesture: Its label.
        variant: Which way of doing it.
        start_s: When it starts.
        expression: What the face shows meanwhile.
    """

    gesture: str
    variant: str
    start_s: float
    expression: Expression = "unpleasant"


@dataclass(frozen=True, slots=True)
class Scenario:
    """A session to be played.

    Attributes:
        name: Its name.
        description: What happens, for people.
        seed: Where all variation comes from.
        sensor: Who looks on.
        duration_s: Length of the session.
        parts: Gestures in order of time; idle motion fills the rest.
        face: ``none`` for a headset that hides the face, of which nothing is sent then.
        face_as: How the face is sent: as landmarks or blendshapes, or as ``affect``, which some
            other program has read.
        seated: Whether the person sits.
        lively: Whether the idle motion has hard negatives; otherwise the hands stay at rest.
        dropouts_s: Starts and lengths of gaps without frames.
        passers_by_s: When somebody else walks through the picture.

    Raises:
        ConfigError: If the sensor has no native frames or the parts do not fit.
    """

    name: str
    description: str
    seed: int
    sensor: Sensor
    duration_s: float
    parts: tuple[Part, ...] = ()
    face: Sight = "expected"
    face_as: FaceKind | Literal["affect"] = "mesh478"
    seated: bool = False
    lively: bool = False
    dropouts_s: tuple[tuple[float, float], ...] = ()
    passers_by_s: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if self.sensor.format is None:
            raise ConfigError(
                f"sensor of scenario '{self.name}' is '{self.sensor.name}', which has no native "
                "frames here; use kinect_v1 or kinect_v2"
            )
        starts = [part.start_s for part in self.parts]
        if starts != sorted(starts) or (starts and starts[-1] >= self.duration_s):
            raise ConfigError(
                f"parts of scenario '{self.name}' start at {starts} s, they must ascend and "
                f"stay below duration_s = {self.duration_s}"
            )


@dataclass(frozen=True, slots=True)
class Session:
    """What a scenario comes to.

    Attributes:
        events: Frames and faces or affect, ascending by ``originating_ns``.
        labels: Ground truth, ascending by onset; idle stretches are quiet.
        format: Joint table of the frames.
        face: What the sensor's hello says of the face.
    """

    events: list[SkeletonFrame | Face | AffectSample]
    labels: list[Label]
    format: str
    face: Sight


def play(scenario: Scenario) -> Session:
    """Plays a scenario; the same scenario gives the same session, bit by bit.

    Raises:
        ConfigError: If a gesture starts before the one before it is over, or ends too late.
    """
    rng = np.random.default_rng([scenario.seed, 23])
    person = Person.sample(rng, subject=f"s{scenario.seed:02d}")
    place = place_before(rng, seated=scenario.seated)
    timeline = Timeline(rng, person, place)
    scripts: list[Script] = []
    for part in scenario.parts:
        if part.start_s < timeline.now_s:
            raise ConfigError(
                f"part '{part.gesture}' of scenario '{scenario.name}' starts at {part.start_s} s, "
                f"but the part before it ends at {timeline.now_s:.1f} s; start it later"
            )
        timeline.idle_until(part.start_s, calm=not scenario.lively)
        scripts.append(timeline.act(part.gesture, part.variant))
    if timeline.now_s > scenario.duration_s:
        raise ConfigError(
            f"the last part of scenario '{scenario.name}' ends at {timeline.now_s:.1f} s; raise "
            f"duration_s = {scenario.duration_s}"
        )
    timeline.idle_until(scenario.duration_s, calm=not scenario.lively)
    motion = Stretch(timeline.performance(), scenario.duration_s)
    frames = observe_frames(motion, scenario.sensor, rng, BODY_ID, 0)
    for start_s in scenario.passers_by_s:
        frames += _passer_by(rng, scenario, place, start_s)
    gaps = [(to_ns(start), to_ns(start + length)) for start, length in scenario.dropouts_s]
    events: list[SkeletonFrame | Face | AffectSample] = [
        frame for frame in frames if not any(a <= frame.originating_ns < b for a, b in gaps)
    ]
    if scenario.face == "expected":
        looks = [
            Look(script.onset_s, script.offset_s, part.expression)
            for part, script in zip(scenario.parts, scripts, strict=True)
        ]
        events += _faces(scenario, affect_track(rng, looks, scenario.duration_s))
    events.sort(key=lambda event: event.originating_ns)
    labels = _labels(scenario, scripts, person.subject)
    return Session(events, labels, frames[0].format, scenario.face)


def _faces(scenario: Scenario, moods: list[AffectSample]) -> Sequence[Face | AffectSample]:
    """The moods as the scenario sends them; faces vary apart from everything else."""
    if scenario.face_as == "affect":
        return moods
    person = SyntheticFace(np.random.default_rng([scenario.seed, 29]))
    return [person.show(mood, scenario.face_as) for mood in moods]


def place_before(rng: np.random.Generator, *, seated: bool) -> Placement:
    """Somewhere sensible: recorded sessions have a person who roughly faces the sensor."""
    place = Placement.sample(rng, seated=seated)
    return replace(
        place,
        heading_rad=float(np.radians(rng.normal(0, 6))),
        distance_m=float(rng.uniform(1.6, 2.4)),
        lateral_m=float(rng.uniform(-0.3, 0.3)),
        sensor_height_m=float(rng.uniform(0.9, 1.3)),
        sensor_tilt_rad=float(np.radians(rng.normal(0, 2))),
    )


def _passer_by(
    rng: np.random.Generator, scenario: Scenario, place: Placement, start_s: float
) -> list[SkeletonFrame]:
    walk = walk_through(
        rng,
        Person.sample(rng, subject="passer_by"),
        distance_m=place.distance_m + 1.1,
        half_width_m=1.7,
        sensor_height_m=place.sensor_height_m,
    )
    return observe_frames(walk, scenario.sensor, rng, PASSER_BY_ID, to_ns(start_s))


def _labels(scenario: Scenario, scripts: list[Script], subject: str) -> list[Label]:
    """Gestures with the reaction that ought to follow, and the quiet stretches between."""
    room = dict(INITIAL_ROOM)
    labels = []
    quiet_from = 0.0
    for part, script in zip(scenario.parts, scripts, strict=True):
        labels.append(_quiet(quiet_from, script.onset_s, subject))
        expected = _expected(part, scenario.face, room)
        labels.append(
            Label(
                part.gesture,
                to_ns(script.onset_s),
                to_ns(script.offset_s),
                subject,
                expected,
                quiet=expected is None,
            )
        )
        quiet_from = script.offset_s + (LATE_REACTION_S if expected else 0.0)
    labels.append(_quiet(quiet_from, scenario.duration_s, subject))
    return [label for label in labels if label.offset_ns > label.onset_ns]


def _expected(part: Part, face: Sight, room: dict[str, str]) -> str | None:
    """The reaction to a gesture, which changes the room; None where there is none."""
    if part.gesture == HELLO:
        return GREETING
    reaction, thing, needed, left = DUTIES[part.gesture]
    gated = face == "expected" and part.expression != "unpleasant"
    if gated or room[thing] != needed:
        return None
    room[thing] = left
    return reaction


def _quiet(start_s: float, stop_s: float, subject: str) -> Label:
    return Label(IDLE, to_ns(start_s), to_ns(stop_s), subject, expected=None, quiet=True)


SCENARIOS: tuple[Scenario, ...] = (
    Scenario(
        name="cold",
        description="Rubs both arms twice; the second time the window is closed already.",
        seed=1,
        sensor=KINECT_V2,
        duration_s=26.0,
        face_as="mesh468",
        parts=(Part("cold", "upper_arms", 4.0), Part("cold", "one_arm", 16.0)),
    ),
    Scenario(
        name="hot",
        description="Is cold first, which closes the window, then fans the face, twice.",
        seed=2,
        sensor=KINECT_V2,
        duration_s=38.0,
        face_as="dlib68",
        seated=True,
        parts=(
            Part("cold", "upper_arms", 4.0),
            Part("hot", "fan_one", 16.0),
            Part("hot", "fan_both", 28.0),
        ),
    ),
    Scenario(
        name="loud",
        description="Covers both ears, twice.",
        seed=3,
        sensor=KINECT_V2,
        duration_s=26.0,
        face_as="dlib68",
        parts=(Part("loud", "palms", 4.0), Part("loud", "clutch", 16.0)),
    ),
    Scenario(
        name="smell",
        description="Pinches the nose, later covers mouth and nose; a headset reads the face.",
        seed=24,
        sensor=KINECT_V2,
        duration_s=26.0,
        face_as="blendshapes",
        seated=True,
        parts=(Part("smell", "pinch", 4.0), Part("smell", "mouth_both", 16.0)),
    ),
    Scenario(
        name="bright",
        description="Covers the eyes with both hands, later shields them with one; Kinect v1.",
        seed=5,
        sensor=KINECT_V1,
        duration_s=26.0,
        face_as="affect",
        parts=(Part("bright", "eyes_both", 4.0), Part("bright", "visor", 16.0)),
    ),
    Scenario(
        name="hello",
        description="Waves with one hand, later with both, with a neutral face; Kinect v1.",
        seed=6,
        sensor=KINECT_V1,
        duration_s=26.0,
        face_as="affect",
        parts=(
            Part("hello", "beside_head", 4.0, "neutral"),
            Part("hello", "both", 16.0, "neutral"),
        ),
    ),
    Scenario(
        name="pleasant_face",
        description="All discomfort gestures with a pleasant face: nothing is to happen.",
        seed=7,
        sensor=KINECT_V2,
        duration_s=52.0,
        parts=(
            Part("cold", "upper_arms", 4.0, "pleasant"),
            Part("loud", "palms", 14.0, "pleasant"),
            Part("bright", "eyes_both", 24.0, "pleasant"),
            Part("smell", "pinch", 34.0, "pleasant"),
            Part("hot", "fan_one", 44.0, "pleasant"),
        ),
    ),
    Scenario(
        name="headset",
        description="Waves and is cold; a headset hides the face, and nothing is sent of it.",
        seed=8,
        sensor=KINECT_V2,
        duration_s=28.0,
        face="none",
        parts=(Part("hello", "beside_head", 4.0), Part("cold", "upper_arms", 16.0)),
    ),
    Scenario(
        name="dropouts_and_passer_by",
        description="Frames fail in bursts and somebody walks through the picture behind.",
        seed=9,
        sensor=KINECT_V2,
        duration_s=44.0,
        face_as="dlib68",
        parts=(
            Part("loud", "palms", 5.0),
            Part("bright", "eyes_both", 19.0),
            Part("hello", "beside_head", 33.0, "neutral"),
        ),
        dropouts_s=((2.0, 0.5), (12.5, 1.0), (16.0, 0.3), (20.6, 0.3), (28.0, 0.8), (40.5, 0.6)),
        passers_by_s=(5.5, 24.0),
    ),
    Scenario(
        name="idle_12_minutes",
        description="Twelve minutes of idle motion with hard negatives: nothing is to happen.",
        seed=10,
        sensor=KINECT_V2,
        duration_s=720.0,
        face_as="blendshapes",
        lively=True,
    ),
    Scenario(
        name="demo",
        description="A tour: hello, cold, loud, bright, smell and hot.",
        seed=31,
        sensor=KINECT_V2,
        duration_s=66.0,
        parts=(
            Part("hello", "beside_head", 4.0, "neutral"),
            Part("cold", "upper_arms", 12.0),
            Part("loud", "palms", 24.0),
            Part("bright", "eyes_both", 35.0),
            Part("smell", "pinch", 46.0),
            Part("hot", "fan_one", 55.0),
        ),
    ),
)
"""What ``recorded_streams`` is made of."""
