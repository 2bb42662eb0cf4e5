"""When the arms leave their rest and come back, on small bodies and on synthetic people."""

import numpy as np
import pytest

from agent_server.domain.skeleton import CoreJoint
from agent_server.skeleton.movement import find_movement
from agent_server.synthetic.clips import sample_clip
from agent_server.synthetic.corpus import corpus, people, resample, subject_names
from agent_server.synthetic.sensors import KINECT_V2, MOCAP, observe_core
from tests.support.bodies import core_joints

RESTING = 13


def body(raised):
    """Both hands at the ears as far as ``raised``, shape (T,), says: 0 is down, 1 is up."""
    down, up = core_joints()[:, :3], core_joints(hands_up=True)[:, :3]
    share = np.asarray(raised, dtype=np.float32)[:, None, None]
    return (1 - share) * down + share * up


def ramp(frames, rise, fall, takes=10):
    """0 until ``rise``, up in ``takes`` frames, held, and down from ``fall`` on."""
    at = np.arange(frames)
    return np.clip((at - rise) / takes, 0, 1) - np.clip((at - fall) / takes, 0, 1)


def found(positions, confidence=None):
    if confidence is None:
        confidence = np.ones(positions.shape[:2], np.float32)
    return find_movement(positions, confidence, RESTING)


def test_a_movement_lasts_from_leaving_rest_to_being_back_and_a_hold_belongs_to_it():
    movement = found(body(ramp(100, rise=30, fall=70)))
    assert movement.onset == pytest.approx(30, abs=2)
    assert movement.offset == pytest.approx(80, abs=2)
    assert movement.is_over


def test_hands_that_are_not_back_at_the_end_are_told():
    movement = found(body(ramp(60, rise=30, fall=200)))
    assert (movement.offset, movement.is_over) == (59, False)


def test_a_movement_that_began_during_the_rest_starts_right_after_it():
    assert found(body(ramp(100, rise=8, fall=40))).onset == RESTING


@pytest.mark.parametrize(
    "raised",
    [
        np.zeros(80),
        0.01 * np.sin(np.arange(80)),
        ramp(80, 40, 42, takes=1),  # a wrong frame or two
        0.2 * ramp(80, 20, 60, takes=30),  # leaning a little
    ],
    ids=["still", "trembling", "one jump", "sway"],
)
def test_rest_is_no_movement(raised):
    assert found(body(raised)) is None


def test_wrists_that_the_sensor_only_guesses_start_no_movement():
    positions = body(ramp(80, rise=30, fall=50, takes=2))
    confidence = np.ones((80, 9), np.float32)
    confidence[28:54, [CoreJoint.LEFT_WRIST, CoreJoint.RIGHT_WRIST]] = 0.5
    assert found(positions) is not None
    assert found(positions, confidence) is None


def test_where_the_body_stands_does_not_matter():
    positions = body(ramp(100, rise=30, fall=70))
    assert found(positions + np.float32([1.5, -0.4, 1.0])) == found(positions)


def test_gestures_of_synthetic_people_are_found_where_they_are():
    errors = []
    for item in corpus(5, 60, subjects=subject_names(10), idle_share=0.0):
        start = item.onset_frame - 25
        movement = find_movement(item.positions[start:], item.confidence[start:], RESTING)
        if movement is not None:
            errors.append((movement.onset - 25, movement.offset + start - item.offset_frame))
    assert len(errors) >= 58
    onset, offset = np.abs(np.array(errors)).T
    assert np.median(onset) <= 2
    assert np.quantile(onset, 0.9) <= 5
    assert np.median(offset) <= 3


@pytest.mark.parametrize("sensor", [KINECT_V2, MOCAP], ids=lambda sensor: sensor.name)
def test_synthetic_people_who_rest_do_not_move(sensor):
    rng = np.random.default_rng(3)
    wrong = 0
    for person in people(9, subject_names(30)).values():
        clip = sample_clip(rng, "idle", person, "still")
        positions, confidence = resample(observe_core(clip, sensor, rng))
        wrong += find_movement(positions[:88], confidence[:88], RESTING) is not None
    assert wrong <= 1
