from dataclasses import replace

import numpy as np
import pytest

from agent_server.domain.affect import AffectSample
from agent_server.domain.face import Face, FaceBlendshapes, FaceLandmarks
from agent_server.domain.gesture import DISCOMFORTS, GESTURES
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import to_ns
from agent_server.errors import ConfigError
from agent_server.scene.rules import default_rules
from agent_server.synthetic.face import FaceKind
from agent_server.synthetic.scenario import (
    BODY_ID,
    DUTIES,
    GREETING,
    INITIAL_ROOM,
    PASSER_BY_ID,
    SCENARIOS,
    Part,
    Scenario,
    Session,
    play,
)
from agent_server.synthetic.sensors import KINECT_V2, MOCAP

BY_NAME = {scenario.name: scenario for scenario in SCENARIOS}
SHORT = [scenario for scenario in SCENARIOS if scenario.duration_s < 100]


def frames_of(session: Session, body_id: int = BODY_ID) -> list[SkeletonFrame]:
    return [
        event
        for event in session.events
        if isinstance(event, SkeletonFrame) and event.body_id == body_id
    ]


def affect_of(scenario: Scenario) -> list[AffectSample]:
    """The moods behind a scenario's faces."""
    events = play(replace(scenario, face_as="affect")).events
    return [event for event in events if isinstance(event, AffectSample)]


def faces_of(session: Session) -> list[Face]:
    kinds = (FaceLandmarks, FaceBlendshapes)
    return [event for event in session.events if isinstance(event, kinds)]


@pytest.mark.parametrize("scenario", SHORT, ids=lambda scenario: scenario.name)
def test_a_session_is_in_order_and_labelled(scenario: Scenario) -> None:
    session = play(scenario)
    stamps = [event.originating_ns for event in session.events]
    assert stamps == sorted(stamps) and stamps[0] >= 0
    assert stamps[-1] > to_ns(scenario.duration_s - 0.5)
    assert session.format == scenario.sensor.format
    assert all(np.isfinite(frame.joints).all() for frame in frames_of(session))
    onsets = [label.onset_ns for label in session.labels]
    assert onsets == sorted(onsets)
    for label, following in zip(session.labels, session.labels[1:], strict=False):
        assert label.onset_ns < label.offset_ns <= following.onset_ns
    shown = [label.gesture for label in session.labels if label.gesture != "idle"]
    assert shown == [part.gesture for part in scenario.parts]
    assert all(label.quiet == (label.expected is None) for label in session.labels)
    assert all(label.quiet for label in session.labels if label.gesture == "idle")


def test_playing_again_gives_the_same_session() -> None:
    first, second = play(BY_NAME["smell"]), play(BY_NAME["smell"])
    assert first.labels == second.labels
    for one, other in zip(faces_of(first), faces_of(second), strict=True):
        np.testing.assert_array_equal(one.values, other.values)
    for one, other in zip(frames_of(first), frames_of(second), strict=True):
        assert one.originating_ns == other.originating_ns
        np.testing.assert_array_equal(one.joints, other.joints)
    assert affect_of(replace(BY_NAME["smell"], seed=99)) != affect_of(BY_NAME["smell"])


def test_expected_reactions_follow_the_rules_of_the_room() -> None:
    rules = default_rules()
    for gesture, (reaction, thing, needed, left) in DUTIES.items():
        (rule,) = rules.rules[gesture]
        assert rule.reaction.name == reaction
        assert [str(condition) for condition in rule.when] == [f"{thing} = {needed}"]
        assert [str(effect) for effect in rule.reaction.effects] == [f"{thing} = {left}"]
    assert rules.rules["hello"][0].reaction.name == GREETING
    assert {
        name: thing.initial for name, thing in rules.objects.items() if thing.states
    } == INITIAL_ROOM


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("cold", ["close_window", None]),
        ("hot", ["close_window", "open_window", None]),
        ("hello", ["greet", "greet"]),
        ("pleasant_face", [None] * 5),
        ("headset", ["greet", "close_window"]),
    ],
)
def test_a_reaction_is_expected_once_and_only_when_there_is_something_to_do(
    name: str, expected: list[str | None]
) -> None:
    labels = play(BY_NAME[name]).labels
    assert [label.expected for label in labels if label.gesture != "idle"] == expected


def test_the_set_covers_what_recordings_need() -> None:
    for gesture in GESTURES[:-1]:
        assert sum(part.gesture == gesture for part in BY_NAME[gesture].parts) == 2
        variants = [part.variant for part in BY_NAME[gesture].parts if part.gesture == gesture]
        assert len(set(variants)) == 2
    assert {part.gesture for part in BY_NAME["demo"].parts} == set(GESTURES) - {"idle"}
    assert 3.5 <= BY_NAME["demo"].parts[0].start_s <= 4.5
    assert len(BY_NAME) == len(SCENARIOS)
    assert {scenario.sensor.name for scenario in SCENARIOS} == {"kinect_v1", "kinect_v2"}


def test_the_face_shows_what_the_person_feels() -> None:
    for name, unpleasant in (("cold", True), ("pleasant_face", False)):
        session = play(BY_NAME[name])
        for label in session.labels:
            inside = [
                sample
                for sample in affect_of(BY_NAME[name])
                if label.onset_ns + to_ns(0.6) < sample.originating_ns < label.offset_ns
            ]
            if label.gesture in DISCOMFORTS and unpleasant:
                assert all(s.valence < -3 and abs(s.arousal) > 3 for s in inside) and inside
            elif label.gesture in DISCOMFORTS:
                assert all(s.valence > 0 for s in inside) and inside
    steps = np.diff([sample.originating_ns for sample in affect_of(BY_NAME["cold"])])
    np.testing.assert_allclose(steps, 1e8, atol=10)


def test_a_headset_sends_no_affect() -> None:
    session = play(BY_NAME["headset"])
    assert session.face == "none" and not faces_of(session)
    assert not affect_of(BY_NAME["headset"])
    assert play(BY_NAME["cold"]).face == "expected"


def test_dropouts_are_gaps_and_the_passer_by_is_another_body() -> None:
    scenario = BY_NAME["dropouts_and_passer_by"]
    session = play(scenario)
    stamps = np.array([f.originating_ns for f in session.events if isinstance(f, SkeletonFrame)])
    for start, length in scenario.dropouts_s:
        assert not ((stamps >= to_ns(start)) & (stamps < to_ns(start + length))).any()
    other = frames_of(session, PASSER_BY_ID)
    crossings = [f for f in other if f.originating_ns < to_ns(scenario.passers_by_s[1])]
    lateral = [frame.joints[0, 0] for frame in crossings]
    assert max(lateral) - min(lateral) > 2.5
    mine = np.median([frame.joints[0, 2] for frame in frames_of(session)])
    assert np.median([frame.joints[0, 2] for frame in other]) > mine + 0.5


def test_motion_is_not_cut_between_gestures() -> None:
    noiseless = replace(KINECT_V2, fit_m=0, wander_m=0, jitter_m=0, weakness=None, lost_frames=0)
    session = play(replace(BY_NAME["demo"], sensor=noiseless))
    frames = frames_of(session)
    positions = np.stack([frame.joints[:12, :3] for frame in frames])
    seconds = np.diff([frame.originating_ns for frame in frames]) / 1e9
    speed = np.linalg.norm(np.diff(positions, axis=0), axis=2) / seconds[:, None]
    assert speed.max() < 8.0


def test_twelve_minutes_of_idleness_are_quiet_and_lively() -> None:
    scenario = BY_NAME["idle_12_minutes"]
    session = play(scenario)
    (label,) = session.labels
    assert label.quiet and label.offset_ns - label.onset_ns == to_ns(720)
    frames = frames_of(session)
    assert len(frames) > 0.97 * 720 * 30
    wrists = np.stack([frame.joints[[6, 10], 1] - frame.joints[1, 1] for frame in frames])
    raised = wrists.max(axis=1) > 0.15
    assert np.count_nonzero(np.diff(raised.astype(int)) == 1) > 20


def test_contradictions_are_refused() -> None:
    with pytest.raises(ConfigError, match="must ascend"):
        Scenario("x", "", 0, KINECT_V2, 20.0, (Part("cold", "elbows", 9), Part("hot", "neck", 4)))
    with pytest.raises(ConfigError, match="no native frames"):
        Scenario("x", "", 0, MOCAP, 20.0)
    crowded = Scenario(
        "x", "", 0, KINECT_V2, 20.0, (Part("cold", "elbows", 3), Part("hot", "neck", 3.5))
    )
    with pytest.raises(ConfigError, match="start it later"):
        play(crowded)
    late = Scenario("x", "", 0, KINECT_V2, 5.0, (Part("cold", "elbows", 4.0),))
    with pytest.raises(ConfigError, match="raise duration_s"):
        play(late)


@pytest.mark.parametrize("kind", ["mesh478", "mesh468", "dlib68", "blendshapes"])
def test_a_scenario_sends_the_same_motion_whatever_it_sends_of_the_face(kind: FaceKind) -> None:
    moods = play(replace(BY_NAME["cold"], face_as="affect"))
    faces = play(replace(BY_NAME["cold"], face_as=kind))
    for one, other in zip(frames_of(moods), frames_of(faces), strict=True):
        np.testing.assert_array_equal(one.joints, other.joints)
    stamps = [face.originating_ns for face in faces_of(faces)]
    assert stamps == [s.originating_ns for s in moods.events if isinstance(s, AffectSample)]
