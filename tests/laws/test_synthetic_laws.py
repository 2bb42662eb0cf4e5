"""Laws of synthetic motion: rigid bones, joint limits, human speeds, determinism."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from agent_server.domain.gesture import GESTURES
from agent_server.domain.skeleton import CoreJoint
from agent_server.synthetic.body import BodyJoint, BodyMotion
from agent_server.synthetic.clips import Clip, sample_clip
from agent_server.synthetic.gestures import VARIANTS
from agent_server.synthetic.idle import ACTIONS
from agent_server.synthetic.limbs import MAX_FLEXION_RAD, elbow_direction
from agent_server.synthetic.person import Person
from agent_server.synthetic.sensors import SENSORS, observe_core

law = settings(derandomize=True, deadline=None, max_examples=120)
seeds = st.integers(0, 2**32 - 1)
whats = st.sampled_from(
    [(gesture, variant) for gesture, ways in VARIANTS.items() for variant in ways]
    + [("idle", action) for action in ACTIONS]
)
J = BodyJoint
BONES = (
    *((J.PELVIS, J.NAVEL), (J.NAVEL, J.NECK_BASE), (J.NECK_BASE, J.NECK), (J.NECK, J.HEAD)),
    *((J.NECK_BASE, J.LEFT_SHOULDER), (J.LEFT_SHOULDER, J.LEFT_ELBOW)),
    *((J.LEFT_ELBOW, J.LEFT_WRIST), (J.LEFT_WRIST, J.LEFT_HAND), (J.LEFT_HAND, J.LEFT_TIP)),
    *((J.LEFT_WRIST, J.LEFT_THUMB), (J.NECK_BASE, J.RIGHT_SHOULDER)),
    *((J.RIGHT_SHOULDER, J.RIGHT_ELBOW), (J.RIGHT_ELBOW, J.RIGHT_WRIST)),
    *((J.RIGHT_WRIST, J.RIGHT_HAND), (J.RIGHT_HAND, J.RIGHT_TIP), (J.RIGHT_WRIST, J.RIGHT_THUMB)),
    *((J.PELVIS, J.LEFT_HIP), (J.LEFT_HIP, J.LEFT_KNEE), (J.LEFT_KNEE, J.LEFT_ANKLE)),
    *((J.LEFT_ANKLE, J.LEFT_FOOT), (J.PELVIS, J.RIGHT_HIP), (J.RIGHT_HIP, J.RIGHT_KNEE)),
    *((J.RIGHT_KNEE, J.RIGHT_ANKLE), (J.RIGHT_ANKLE, J.RIGHT_FOOT)),
)
RATE_HZ = 100


def drawn(what: tuple[str, str], seed: int) -> tuple[Clip, BodyMotion]:
    rng = np.random.default_rng(seed)
    clip = sample_clip(rng, what[0], Person.sample(rng, subject="x"), what[1])
    return clip, clip.at(np.arange(0.0, clip.duration_s, 1 / RATE_HZ))


@law
@given(whats, seeds)
def test_bones_are_rigid_and_joints_keep_their_limits(what: tuple[str, str], seed: int) -> None:
    clip, motion = drawn(what, seed)
    assert np.isfinite(motion.joints).all()
    for parent, child in BONES:
        length = np.linalg.norm(motion.joints[:, child] - motion.joints[:, parent], axis=1)
        assert np.ptp(length) < 1e-6
    person = clip.person
    for first in (J.LEFT_SHOULDER, J.RIGHT_SHOULDER):
        shoulder, elbow, wrist = (motion.joints[:, first + k] for k in range(3))
        cosine = ((elbow - shoulder) * (wrist - elbow)).sum(axis=1)
        cosine /= person.upper_arm_m * person.forearm_m
        assert np.arccos(np.clip(cosine, -1, 1)).max() <= MAX_FLEXION_RAD + 1e-6
    head = np.linalg.norm(
        motion.joints[:, [J.LEFT_WRIST, J.RIGHT_WRIST]] - motion.joints[:, None, J.HEAD], axis=2
    )
    assert head.min() > 0.075 * person.scale


@law
@given(whats, seeds)
def test_people_move_at_human_speeds(what: tuple[str, str], seed: int) -> None:
    clip, motion = drawn(what, seed)
    speed = np.linalg.norm(np.diff(motion.joints, axis=0), axis=2) * RATE_HZ
    assert speed[:, [J.LEFT_WRIST, J.RIGHT_WRIST]].max() < 8.0
    assert speed[:, [J.LEFT_ELBOW, J.RIGHT_ELBOW]].max() < 12.0
    assert speed[:, [J.HEAD, J.NECK_BASE, J.PELVIS]].max() < 4.0
    assert 0.9 < clip.onset_s < clip.offset_s < clip.duration_s
    assert (motion.joints[:, :, 2] > 0.2).all()


@law
@given(whats, seeds)
def test_who_faces_the_sensor_has_the_right_side_at_larger_x(
    what: tuple[str, str], seed: int
) -> None:
    _, motion = drawn(what, seed)
    rest = motion.joints[: RATE_HZ // 2]
    assert (rest[:, J.RIGHT_SHOULDER, 0] > rest[:, J.LEFT_SHOULDER, 0]).all()
    assert (rest[:, J.RIGHT_HIP, 0] > rest[:, J.LEFT_HIP, 0]).all()
    assert (rest[:, J.HEAD, 1] > rest[:, J.NAVEL, 1]).all()


@settings(law, max_examples=40)
@given(st.sampled_from(GESTURES), seeds, st.sampled_from(SENSORS))
def test_a_seed_gives_the_same_motion_and_observation(gesture: str, seed: int, sensor) -> None:
    seen = []
    for _ in range(2):
        rng = np.random.default_rng(seed)
        clip = sample_clip(rng, gesture, Person.sample(rng, subject="x"))
        seen.append(observe_core(clip, sensor, rng))
    np.testing.assert_array_equal(seen[0].stamps_s, seen[1].stamps_s)
    np.testing.assert_array_equal(seen[0].positions, seen[1].positions)
    np.testing.assert_array_equal(seen[0].confidence, seen[1].confidence)
    assert (seen[0].confidence >= 0).all() and (seen[0].confidence <= 1).all()
    depth = seen[0].positions[:, CoreJoint.NAVEL, 2]
    assert depth.min() > 0.8 and depth.max() < 4.5


@settings(law, max_examples=40)
@given(whats, seeds)
def test_motion_is_a_function_of_time(what: tuple[str, str], seed: int) -> None:
    clip, motion = drawn(what, seed)
    some = motion.times_s[7::23]
    np.testing.assert_allclose(clip.at(some).joints, motion.joints[7::23], atol=1e-9)


@law
@given(seeds)
def test_elbow_directions_are_unit_perpendicular_and_turn_with_the_swivel(seed: int) -> None:
    rng = np.random.default_rng(seed)
    lines = rng.normal(size=(20, 3))
    lines[:, 2] = -abs(lines[:, 2])  # before the shoulder
    swivel = rng.uniform(-0.5, 2.2, 20)
    quarter = elbow_direction(lines, swivel + np.pi / 2)
    direction = elbow_direction(lines, swivel)
    np.testing.assert_allclose(np.linalg.norm(direction, axis=1), 1.0)
    np.testing.assert_allclose((direction * lines).sum(axis=1), 0.0, atol=1e-9)
    np.testing.assert_allclose((direction * quarter).sum(axis=1), 0.0, atol=1e-9)
