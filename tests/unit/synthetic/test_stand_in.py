"""A person who does what is asked for."""

import numpy as np
import pytest

from agent_server.domain.gesture import GESTURES, IDLE
from agent_server.errors import InvalidInput
from agent_server.synthetic.stand_in import stand_in


@pytest.mark.parametrize("gesture", GESTURES)
def test_it_does_what_is_asked_for_from_rest_to_rest(gesture):
    clip = stand_in(gesture, 3)
    stamps = [frame.originating_ns for frame in clip.frames]
    assert stamps == sorted(stamps)
    assert 2.0e9 < stamps[-1] < 9.0e9
    assert {frame.format for frame in clip.frames} == {"kinect_v2"}
    assert 0 <= clip.onset_ns < clip.offset_ns <= stamps[-1] + 50_000_000
    first, last = (clip.frames[index].joints[:, :3] for index in (0, -1))
    # Hands come back to where they were, to a few centimetres of sway and noise.
    assert np.linalg.norm(first - last, axis=1)[:12].max() < 0.12
    assert (clip.variant == "") == (gesture == IDLE)


def test_a_seed_is_one_person_and_takes_differ():
    first, second = stand_in("cold", 5), stand_in("hello", 5)
    heads = [clip.frames[0].joints[3, :3] for clip in (first, second)]
    assert np.linalg.norm(heads[0] - heads[1]) < 0.08
    again, other = stand_in("cold", 5), stand_in("cold", 5, take=1)
    assert all(
        np.array_equal(a.joints, b.joints) for a, b in zip(first.frames, again.frames, strict=True)
    )
    assert len(other.frames) != len(first.frames) or not np.array_equal(
        other.frames[60].joints, first.frames[60].joints
    )


def test_what_it_cannot_do_is_named():
    with pytest.raises(InvalidInput, match=r"juggle.*cold"):
        stand_in("juggle", 1)
