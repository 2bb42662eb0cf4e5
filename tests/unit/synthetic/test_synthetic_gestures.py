"""Hands go where the gesture says, in every variant."""

from dataclasses import replace

import numpy as np
import pytest

from agent_server.domain.arrays import Float64
from agent_server.synthetic.body import BodyJoint, BodyMotion
from agent_server.synthetic.clips import Clip, sample_clip
from agent_server.synthetic.gestures import VARIANTS
from agent_server.synthetic.idle import ACTIONS, ON_FOOT
from agent_server.synthetic.limbs import turn
from agent_server.synthetic.person import Person, Placement

WRISTS = (BodyJoint.LEFT_WRIST, BodyJoint.RIGHT_WRIST)
TAKES = range(6)


def played(gesture: str, variant: str, seed: int) -> tuple[Clip, BodyMotion]:
    rng = np.random.default_rng([seed, len(variant)])
    clip = sample_clip(rng, gesture, Person.sample(rng, subject="x"), variant)
    return clip, clip.at(np.arange(0.0, clip.duration_s, 0.02))


def distances(motion: BodyMotion, place: tuple[float, float, float]) -> Float64:
    """Of both wrists from a place in the head's frame, right, up and back: shape (T, 2)."""
    point = motion.joints[:, BodyJoint.HEAD] + turn(motion.head, np.array(place))
    return np.linalg.norm(motion.joints[:, WRISTS] - point[:, None], axis=2)


def swings(clip: Clip, side: int) -> list[float]:
    """Frequencies of the swings of one hand that are larger than fidgeting."""
    return [
        swing.frequency_hz
        for swing in clip.performance.arms[side].swings
        if np.linalg.norm(swing.along) > 0.012
    ]


@pytest.mark.parametrize("variant", VARIANTS["loud"])
@pytest.mark.parametrize("seed", TAKES)
def test_loud_brings_both_wrists_to_the_ears(variant: str, seed: int) -> None:
    _, motion = played("loud", variant, seed)
    left = distances(motion, (-0.075, 0.0, 0.0))[:, 0]
    right = distances(motion, (0.075, 0.0, 0.0))[:, 1]
    together = np.maximum(left, right) < 0.22
    assert together.sum() * 0.02 >= 0.5


@pytest.mark.parametrize("variant", VARIANTS["bright"])
@pytest.mark.parametrize("seed", TAKES)
def test_bright_brings_a_hand_before_the_eyes(variant: str, seed: int) -> None:
    clip, motion = played("bright", variant, seed)
    eyes = (0.0, 0.02, -0.10)
    hands = motion.joints[:, (BodyJoint.LEFT_HAND, BodyJoint.RIGHT_HAND)]
    point = motion.joints[:, BodyJoint.HEAD] + turn(motion.head, np.array(eyes))
    near = np.linalg.norm(hands - point[:, None], axis=2) < 0.19 * clip.person.scale
    near |= distances(motion, eyes) < 0.19 * clip.person.scale
    held = near.all(axis=1) if "both" in variant else near.any(axis=1)
    assert held.sum() * 0.02 >= 0.5


@pytest.mark.parametrize("variant", VARIANTS["smell"])
@pytest.mark.parametrize("seed", TAKES)
def test_smell_brings_a_hand_to_nose_and_mouth(variant: str, seed: int) -> None:
    clip, motion = played("smell", variant, seed)
    near = distances(motion, (0.0, -0.06, -0.11)) < 0.21 * clip.person.scale
    held = near.all(axis=1) if "both" in variant else near.any(axis=1)
    assert held.sum() * 0.02 >= 0.5


@pytest.mark.parametrize("variant", VARIANTS["hot"])
@pytest.mark.parametrize("seed", TAKES)
def test_hot_moves_air_near_neck_or_mouth(variant: str, seed: int) -> None:
    clip, motion = played("hot", variant, seed)
    near = distances(motion, (0.0, -0.17, -0.10)).min(axis=1) < 0.36 * clip.person.scale
    assert near.sum() * 0.02 >= 0.8
    rates = swings(clip, 0) + swings(clip, 1)
    assert rates and all(1.0 < rate < 5.5 for rate in rates)


@pytest.mark.parametrize("variant", VARIANTS["cold"])
@pytest.mark.parametrize("seed", TAKES)
def test_cold_rubs_the_opposite_arm(variant: str, seed: int) -> None:
    clip, motion = played("cold", variant, seed)
    rubbing = 0
    for side, other in ((0, BodyJoint.RIGHT_SHOULDER), (1, BodyJoint.LEFT_SHOULDER)):
        hand = motion.joints[:, WRISTS[side] + 1]
        arm = motion.joints[:, other : other + 3]
        along = np.linspace(0, 1, 9)[:, None, None]
        upper = arm[:, 0] + along * (arm[:, 1] - arm[:, 0])
        lower = arm[:, 1] + along * (arm[:, 2] - arm[:, 1])
        gap = np.linalg.norm(np.concatenate([upper, lower]) - hand, axis=2).min(axis=0)
        touches = (gap < 0.20 * clip.person.scale).sum() * 0.02 >= 0.5
        rates = swings(clip, side)
        assert all(0.7 < rate < 5.0 for rate in rates)
        rubbing += bool(touches and rates)
    assert rubbing == (1 if variant == "one_arm" else 2)


@pytest.mark.parametrize("variant", VARIANTS["hello"])
@pytest.mark.parametrize("seed", TAKES)
def test_hello_waves_with_the_forearm_up(variant: str, seed: int) -> None:
    clip, motion = played("hello", variant, seed)
    waving = 0
    for side, wrist in enumerate(WRISTS):
        if rates := swings(clip, side):
            waving += 1
            assert all(0.6 < rate < 4.5 for rate in rates)
            rise = motion.joints[:, wrist, 1] - motion.joints[:, wrist - 1, 1]
            assert (rise > 0.05).sum() * 0.02 >= 0.5
    assert waving == (2 if "both" in variant else 1)


def test_hands_rest_before_and_after_a_gesture() -> None:
    for gesture, ways in VARIANTS.items():
        for variant in ways:
            clip, motion = played(gesture, variant, 3)
            speed = np.linalg.norm(np.diff(motion.joints[:, WRISTS], axis=0), axis=2) / 0.02
            times = motion.times_s[1:]
            assert speed[times < clip.onset_s].max() < 0.25
            assert speed[times > clip.offset_s + 0.02].max() < 0.25
            during = speed[(times > clip.onset_s) & (times < clip.offset_s)]
            assert during.max() > 0.4


def test_people_differ_and_so_do_takes() -> None:
    rng = np.random.default_rng(0)
    person = Person.sample(rng, subject="x")
    takes = [sample_clip(rng, "loud", person, "palms") for _ in range(40)]
    durations = [clip.offset_s - clip.onset_s for clip in takes]
    assert np.std(durations) > 0.4
    heights = [clip.at(np.array([0.5 * (clip.onset_s + clip.offset_s)])) for clip in takes]
    relative = [m.joints[0, WRISTS[0]] - m.joints[0, BodyJoint.HEAD] for m in heights]
    assert (np.std(relative, axis=0) > 0.02).all()


def test_what_needs_feet_is_done_standing() -> None:
    rng = np.random.default_rng(1)
    person = Person.sample(rng, subject="x")
    assert set(ACTIONS) >= ON_FOOT
    for action in sorted(ON_FOOT):
        assert not sample_clip(rng, "idle", person, action).performance.placement.seated
    seated = Placement.sample(rng, seated=True)
    drawn = {
        sample_clip(rng, "idle", person, placement=replace(seated)).variant for _ in range(150)
    }
    assert not drawn & ON_FOOT
    assert len(drawn) > 20
