"""A reaction to a made-up person, by a small reactor without weights."""

from dataclasses import replace

import numpy as np
import pytest

from agent_server.domain.motion import Forecast, Quality, Window
from agent_server.skeleton.pair import (
    JOINT_NAMES,
    TORSO,
    as_action,
    bone_vectors,
    with_lengths,
)
from agent_server.stages.react import noise_of, react
from tests.support.bodies import core_joints
from tests.support.reactor import RANGE, HandReactor

STANDING = core_joints()[:, :3]
RIGHT_ELBOW, RIGHT_HAND = map(JOINT_NAMES.index, ("right_elbow", "right_hand"))


def seen(turned=0.0):
    """Somebody who stands still, turned by an angle about the vertical, and keeps standing."""
    cos, sin = np.cos(turned), np.sin(turned)
    still = STANDING[None] @ np.array([[cos, 0, -sin], [0, 1, 0], [sin, 0, cos]])
    motion = still.repeat(75, 0).astype(np.float32)
    quality = Quality(1.0, 0.0, 0.0)
    window = Window(0, 1, 0, 960_000_000, motion[:25], np.ones((25, 9)), quality)
    return window, Forecast(motion[25:], "test")


def made(reactor, seed="s/c1"):
    return list(react(reactor, *seen(), seed))


def frames(stretches):
    return np.concatenate([stretch.positions for stretch in stretches])


def test_two_seconds_from_the_decision_on_come_in_order_without_gaps():
    stretches = made(HandReactor())
    assert [stretch.is_last for stretch in stretches] == [False] * (len(stretches) - 1) + [True]
    assert [one.first_frame for one in stretches] == np.cumsum(
        [0, *(len(one.positions) for one in stretches[:-1])]
    ).tolist()
    assert max(len(stretch.positions) for stretch in stretches) == 5
    assert frames(stretches).shape == (50, 15, 3)
    assert stretches[-1].refused is None


def test_the_second_that_was_seen_is_over_and_the_hand_is_where_it_is_by_then():
    reactor = HandReactor(speed=0.1)
    motion = frames(made(reactor))
    forearm = motion[:, RIGHT_HAND] - motion[:, RIGHT_ELBOW]
    angle = np.arctan2(forearm[:, 2], -forearm[:, 1])
    length = np.hypot(0.1, 0.26)
    expected = np.arctan2(0.1, 0.26) + 0.1 / length * (0.96 + np.arange(50) / 25)
    np.testing.assert_allclose(angle, expected, atol=2e-3)


def test_bones_keep_the_lengths_of_one_skeleton():
    lengths = np.linalg.norm(bone_vectors(np.array(RANGE.reaction, np.float32)), axis=-1)
    found = np.linalg.norm(bone_vectors(frames(made(HandReactor()))), axis=-1)
    np.testing.assert_allclose(found, np.tile(lengths, (50, 1)), atol=1e-5)


def test_the_agent_looks_along_z_with_its_left_at_x_and_its_feet_on_the_floor():
    first = frames(made(HandReactor(speed=0.0)))[0]
    assert first[TORSO, [0, 2]] == pytest.approx(0, abs=1e-6)
    assert first[:, 1].min() == pytest.approx(0, abs=1e-6)
    left, right = (first[JOINT_NAMES.index(f"{side}_shoulder"), 0] for side in ("left", "right"))
    assert left > 0.1 > -0.1 > right
    assert first[RIGHT_HAND, 2] > 0.05  # hands hang a little before the body


def test_it_is_given_three_seconds_of_somebody_who_faces_it_whichever_way_they_turn():
    for turned in (0.0, 1.0, -2.5):
        reactor = HandReactor()
        list(react(reactor, *seen(turned), "s/c1"))
        assert reactor.action.shape == (45, 15, 3)
        np.testing.assert_allclose(reactor.action[0, TORSO], RANGE.action[TORSO], atol=1e-6)
        shoulders = reactor.action[0, 3] - reactor.action[0, 6]
        assert abs(shoulders[0]) < 1e-3
        assert shoulders[2] < -0.1  # who looks along x has their left at -z


def test_who_is_tall_becomes_as_tall_as_who_acted_in_training():
    small, tall = (as_action(scale * STANDING[None], np.array(RANGE.action)) for scale in (1, 1.3))
    np.testing.assert_allclose(small, tall, atol=1e-5)


def test_noise_hangs_on_the_command_alone():
    np.testing.assert_array_equal(noise_of("s/c1", 4), noise_of("s/c1", 4))
    assert not np.allclose(noise_of("s/c1", 4), noise_of("s/c2", 4))
    one, other = (made(reactor) for reactor in (HandReactor(), HandReactor()))
    np.testing.assert_array_equal(frames(one), frames(other))


@pytest.mark.parametrize(
    ("limits", "reason"),
    [
        ({"speed_m_s": 0.05}, "a joint is too fast"),
        ({"acceleration_m_s2": 0.1}, "a joint changes its speed too fast"),
        ({"reach_m": (2, 2, 2, 0.3)}, "an arm reaches too far"),
        ({"bones": (1.0,) * 7 + (0.1,)}, "a bone is too long or short"),
    ],
)
def test_what_leaves_the_training_range_is_not_played_on(limits, reason):
    stretches = made(HandReactor(speed=0.4, grows=0.1, known=replace(RANGE, **limits)))
    assert stretches[-1].refused.startswith(reason)
    assert stretches[-1].is_last
    assert len(frames(stretches)) < 50


def test_what_the_quality_network_holds_for_no_reaction_is_not_played_on():
    (only,) = made(HandReactor(quality=lambda index: 0.3))
    assert only.is_last
    assert only.refused == ("it does not go with what the person does: quality 0.30, 0.5 is asked")
    assert only.positions.shape == (0, 15, 3)
    *_, last = made(HandReactor(quality=lambda index: 0.9 if index < 30 else 0.4))
    assert "quality 0.40" in last.refused
    assert 20 < last.first_frame + len(last.positions) < 30
    # On the second that is not played, the network has not seen enough yet.
    assert made(HandReactor(quality=lambda index: 0.1 * min(index, 9)))[-1].refused is None


def test_where_a_draw_comes_to_nothing_the_next_one_is_tried():
    tried = []

    def quality(index):
        tried.append(index)
        return 0.9 if tried.count(0) == 3 else 0.2

    stretches = made(HandReactor(quality=quality))
    assert stretches[-1].refused is None
    assert len(frames(stretches)) == 50
    assert tried.count(0) == 3
    tried.clear()
    # What has begun to play is not made anew.
    *_, last = made(HandReactor(quality=lambda index: tried.append(index) or 0.9 - index / 60))
    assert last.refused.startswith("it does not go")
    assert tried.count(0) == 1


def test_a_model_that_breaks_keeps_what_it_has_made():
    *good, last = made(HandReactor(breaks_at=25))
    assert last.refused == "the hand is broken"
    assert 10 < len(frames([*good, last])) < 20


def test_a_reaction_that_is_over_before_the_decision_has_nothing_to_play():
    (only,) = made(HandReactor(ends_at=5))
    assert only.refused == "the reaction is over before it begins"
    assert only.positions.shape == (0, 15, 3)


def test_lengths_are_set_right_and_directions_kept():
    pose = np.array(RANGE.reaction, np.float32)
    lengths = np.linalg.norm(bone_vectors(pose), axis=-1)
    np.testing.assert_allclose(
        with_lengths(pose * np.float32(1.7), lengths) - 1.7 * pose[TORSO],
        pose - pose[TORSO],
        atol=1e-6,
    )
