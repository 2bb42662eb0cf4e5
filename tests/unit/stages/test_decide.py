"""One decision a gesture: hysteresis, cool-down, hand-over."""

import numpy as np
import pytest

from agent_server.config import DecideSettings
from agent_server.domain.gesture import GESTURES, Classification
from agent_server.stages.decide import GestureTracker, Phase

HOP = 200_000_000


def seen(label, level=0.9):
    probabilities = np.full(len(GESTURES), (1 - level) / (len(GESTURES) - 1), np.float32)
    probabilities[GESTURES.index(label)] = level
    return Classification(GESTURES, probabilities)


class Stream:
    """A tracker that is fed window after window."""

    def __init__(self, settings=None, enter_windows=None):
        self.tracker = GestureTracker(settings or DecideSettings(), {"hello"}, enter_windows)
        self.now = 0

    def push(self, label, level=0.9, count=1):
        for _ in range(count):
            result = self.tracker.push(seen(label, level), self.now)
            self.now += HOP
        return result


def test_a_gesture_starts_after_three_windows_in_a_row():
    stream = Stream()
    assert stream.push("cold", count=2).phase is Phase.UNSURE
    assert stream.push("cold").phase is Phase.ACTIVE


def test_an_interrupted_streak_starts_again():
    stream = Stream()
    stream.push("cold", count=2)
    stream.push("idle")
    assert stream.push("cold", count=2).phase is Phase.UNSURE


def test_what_is_not_probable_enough_never_starts():
    assert Stream().push("loud", level=0.64, count=10).phase is Phase.UNSURE


def test_what_no_face_confirms_must_be_surer():
    assert Stream().push("hello", level=0.67, count=10).phase is Phase.UNSURE
    assert Stream().push("loud", level=0.67, count=10).phase is Phase.ACTIVE
    assert Stream().push("hello", level=0.9, count=10).phase is Phase.ACTIVE


def test_idle_is_never_a_gesture():
    stream = Stream()
    result = stream.push("idle", count=10)
    assert (result.phase, result.gesture) == (Phase.IDLE, "idle")


def test_an_answered_gesture_is_not_answered_again_while_it_lasts():
    stream = Stream()
    assert stream.push("hot", count=3).phase is Phase.ACTIVE
    stream.tracker.mark_handled()
    assert stream.push("hot", count=20).phase is Phase.HANDLED


def test_a_dip_does_not_end_a_gesture_but_two_weak_windows_do():
    stream = Stream()
    stream.push("hot", count=3)
    stream.push("idle")
    assert stream.push("hot").gesture == "hot"
    stream.push("idle", count=2)
    assert stream.push("idle").phase is Phase.IDLE


def test_after_an_answer_the_same_gesture_cools_down_for_two_seconds():
    stream = Stream()
    stream.push("hot", count=3)
    stream.tracker.mark_handled()
    stream.push("idle", count=2)  # the second one ends it
    ended = stream.now - HOP
    while stream.now < ended + 2_000_000_000:
        assert stream.push("hot").phase is Phase.COOLING_DOWN
    assert stream.push("hot").phase is Phase.ACTIVE


def test_another_gesture_does_not_cool_down():
    stream = Stream()
    stream.push("hot", count=3)
    stream.tracker.mark_handled()
    stream.push("idle", count=2)
    assert stream.push("loud", count=3).phase is Phase.ACTIVE


def test_a_gesture_that_was_not_answered_may_start_again_at_once():
    stream = Stream()
    stream.push("hot", count=3)
    stream.push("idle", count=2)
    assert stream.push("hot", count=3).phase is Phase.ACTIVE


def test_a_clear_other_gesture_takes_over():
    stream = Stream()
    stream.push("hot", count=3)
    stream.tracker.mark_handled()
    result = stream.push("loud", count=3)
    assert (result.phase, result.gesture) == (Phase.ACTIVE, "loud")


def test_on_the_thesis_grid_one_window_is_enough():
    stream = Stream(enter_windows=1)
    assert stream.push("smell").phase is Phase.ACTIVE
    assert stream.push("idle").phase is Phase.IDLE


def test_a_reset_ends_what_was_going_on():
    stream = Stream()
    stream.push("hot", count=3)
    stream.tracker.mark_handled()
    stream.tracker.reset(stream.now)
    assert stream.push("hot", count=3).phase is Phase.COOLING_DOWN


@pytest.mark.parametrize("level", [0.41, 0.9])
def test_over_the_leaving_threshold_a_gesture_lasts(level):
    stream = Stream()
    stream.push("hot", count=3)
    assert stream.push("hot", level=level, count=5).gesture == "hot"
