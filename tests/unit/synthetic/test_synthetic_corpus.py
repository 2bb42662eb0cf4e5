import time
from itertools import islice

import numpy as np
import pytest

from agent_server.domain.gesture import GESTURES
from agent_server.errors import InvalidInput
from agent_server.synthetic.clips import sample_clip
from agent_server.synthetic.corpus import corpus, resample, subject_names
from agent_server.synthetic.gestures import VARIANTS
from agent_server.synthetic.idle import ACTIONS
from agent_server.synthetic.person import Person
from agent_server.synthetic.sensors import KINECT_V1, CoreObservation

NAMES = subject_names(6)


def test_an_item_depends_on_the_seed_and_its_place_alone() -> None:
    some = list(corpus(5, 4, subjects=NAMES))
    more = list(islice(corpus(5, 100, subjects=NAMES), 6))
    for one, other in zip(some, more, strict=False):
        np.testing.assert_array_equal(one.positions, other.positions)
        np.testing.assert_array_equal(one.confidence, other.confidence)
        assert (one.gesture, one.variant, one.subject) == (
            other.gesture,
            other.variant,
            other.subject,
        )
    assert not np.array_equal(more[0].positions, next(corpus(6, 1, subjects=NAMES)).positions)


def test_items_are_labelled_clips_at_25_hz() -> None:
    items = list(corpus(1, 120, subjects=NAMES))
    assert {item.gesture for item in items} == set(GESTURES)
    assert {item.subject for item in items} == set(NAMES)
    assert len({item.sensor for item in items}) == 4
    for item in items:
        frames = len(item.positions)
        assert item.positions.shape == (frames, 9, 3) and item.confidence.shape == (frames, 9)
        assert 0 < item.onset_frame < item.offset_frame < frames
        assert 3.0 < frames / 25 < 20.0
        known = ACTIONS if item.gesture == "idle" else VARIANTS[item.gesture]
        assert item.variant in known


def test_shares_and_selections_are_kept() -> None:
    only = list(
        corpus(
            2, 60, subjects=["v00"], gestures=("cold", "idle"), sensors=(KINECT_V1,), idle_share=0.5
        )
    )
    assert {item.sensor for item in only} == {"kinect_v1"}
    assert 15 < sum(item.gesture == "idle" for item in only) < 45
    none = list(corpus(2, 20, subjects=["v00"], idle_share=0.0))
    assert all(item.gesture != "idle" for item in none)


@pytest.mark.parametrize("empty", ["subjects", "gestures", "sensors"])
def test_nothing_to_draw_from_is_refused(empty: str) -> None:
    arguments = {"subjects": NAMES, empty: ()}
    with pytest.raises(InvalidInput, match=f"{empty} is empty"):
        next(corpus(0, 1, **arguments))


def test_resampling_is_linear_and_keeps_what_is_not_tracked() -> None:
    stamps = np.array([0.0, 0.031, 0.070, 0.099, 0.140, 0.165])
    positions = np.zeros((6, 9, 3))
    positions[..., 1] = stamps[:, None]
    confidence = np.ones((6, 9))
    confidence[3, 5] = 0.0
    out, sure = resample(CoreObservation(stamps, positions, confidence))
    assert out.shape == (5, 9, 3)
    np.testing.assert_allclose(out[:, 0, 1], [0.0, 0.04, 0.08, 0.12, 0.16])
    np.testing.assert_array_equal(sure[:, 5], [1, 1, 0, 0, 1])


def test_an_unknown_gesture_or_variant_is_refused() -> None:
    rng = np.random.default_rng(0)
    person = Person.sample(rng, subject="x")
    with pytest.raises(InvalidInput, match="gesture is 'sneeze'"):
        sample_clip(rng, "sneeze", person)
    with pytest.raises(InvalidInput, match="expected one of palms"):
        sample_clip(rng, "loud", person, "whisper")
    with pytest.raises(InvalidInput, match="'idle'"):
        sample_clip(rng, "idle", person, "palms")


def test_a_thousand_clips_take_less_than_ten_seconds() -> None:
    start = time.process_time()
    count = sum(1 for _ in corpus(9, 100, subjects=NAMES))
    assert count == 100
    assert time.process_time() - start < 1.0 * 2  # twice, for a busy machine
