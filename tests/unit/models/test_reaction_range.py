"""The limits of generated reactions, measured on made-up interactions."""

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from agent_server.skeleton.pair import TORSO
from models.export.reaction_range import BONE_SLACK, training_range
from tests.support.interactions import interaction

RATE_HZ = 15


def measured(frames=30):
    return training_range([interaction("s01s02", "03", frames, n) for n in (1, 2)], RATE_HZ)


def test_both_begin_where_the_people_stand_and_face_each_other():
    known = measured()
    action, reaction = np.array(known.action), np.array(known.reaction)
    assert action.shape == reaction.shape == (15, 3)
    np.testing.assert_allclose(action[TORSO], (-0.5, 0, 0), atol=0.02)
    np.testing.assert_allclose(reaction[TORSO], (0.5, 0, 0), atol=0.02)
    # The shoulders' width is that of the made-up people, whichever way they face.
    widths = [np.linalg.norm(pose[3] - pose[6]) for pose in (action, reaction)]
    np.testing.assert_allclose(widths, 0.3, atol=1e-3)


def test_limits_are_those_of_the_reaction():
    recorded = interaction("s01s02", "03", 30).reaction
    steps = np.linalg.norm(np.diff(recorded[:, :9], axis=0), axis=-1).max() * RATE_HZ
    known = measured()
    assert 0.8 * steps < known.speed_m_s <= steps * 1.01
    reach = np.linalg.norm(recorded[:, 8] - recorded[:, TORSO], axis=-1).max()
    assert known.reach_m[3] == pytest.approx(reach, abs=0.02)
    assert min(known.bones) == BONE_SLACK


def test_who_moves_twice_as_often_a_second_is_twice_as_fast():
    slow, fast = (
        training_range([interaction("s01s02", "03", 30)], rate_hz) for rate_hz in (15, 30)
    )
    assert fast.speed_m_s == pytest.approx(2 * slow.speed_m_s, abs=2e-3)
    assert fast.acceleration_m_s2 == pytest.approx(4 * slow.acceleration_m_s2, abs=4e-3)
