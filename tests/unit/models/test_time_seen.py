"""How much of a gesture must be seen, and when the live stage answers it."""

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from agent_server.config import DecideSettings
from models.data.windows import Recording, Stretch
from models.evaluation.decision_times import ENTER, ENTER_WINDOWS, answers, live_streams, sweep
from models.evaluation.gestures import DECIDE, evaluate_decisions, hold_last
from models.evaluation.readings import HELD, PREDICTED, TRUE
from models.evaluation.time_seen import SECONDS, TimeSeen, time_seen
from tests.support.raised_hands import CLASSES, by_last_frame, moving_on, raised, resting


def seen_of(*recordings: Recording) -> TimeSeen:
    return time_seen(by_last_frame, moving_on, recordings, CLASSES)


def at(seconds: float) -> int:
    return int(np.argmin(np.abs(SECONDS - seconds)))


def test_times_go_from_a_third_of_a_second_to_three() -> None:
    assert (SECONDS[0], SECONDS[-1], len(SECONDS)) == (0.3, 3.0, 28)


def test_a_speed_names_a_gesture_before_its_height_does() -> None:
    seen = seen_of(raised("wave"), raised("point"))
    assert seen.first_at(PREDICTED, 0.9) == 0.3
    # 0.6 s are frame 15 of the rise, 0.5 s only frame 12, which is 0.3 m high.
    assert seen.first_at(HELD, 0.9) == 0.6
    # The hand is down again 2 s after the true future of later windows has begun.
    assert seen.share(TRUE)[at(0.3)] == 1
    assert seen.share(TRUE)[at(2.0)] == 0


def test_gestures_count_until_the_hands_are_mostly_back() -> None:
    long, short = raised("wave", lasts=200, frames=400), raised("wave", lasts=50)
    seen = seen_of(long, short)
    # 10 frames before the 50th is the last that counts: 1.6 s after the onset.
    assert seen.remaining[at(1.6)] == 2
    assert seen.remaining[at(1.7)] == 1


def test_a_second_must_have_been_recorded_before_a_window() -> None:
    seen = seen_of(raised("wave", onset=10))
    # Frame 24 is the first that ends a whole second: 0.56 s after the onset.
    assert seen.remaining[at(0.5)] == 0
    assert seen.remaining[at(0.6)] == 1
    assert np.isnan(seen.share(PREDICTED)[at(0.5)])


def test_a_true_future_needs_two_more_seconds() -> None:
    # The last frame is 119, so that windows whose last seen frame is 69 are the last whole ones.
    seen = seen_of(raised("wave", onset=60, frames=120))
    shares = seen.share(TRUE)
    assert not np.isnan(shares[at(0.3)])
    assert np.isnan(shares[at(0.5)])
    assert seen.share(PREDICTED)[at(0.5)] == 1


def test_shares_are_of_one_gesture_where_one_is_asked_for() -> None:
    seen = seen_of(raised("wave"), raised("wave"), raised("point"))
    only_wave = time_seen(lambda motion: np.eye(3, dtype=np.float32)[[0] * len(motion)], moving_on,
                          [raised("wave"), raised("wave"), raised("point")], CLASSES)  # fmt: skip
    assert only_wave.share(PREDICTED)[at(1.0)] == pytest.approx(2 / 3)
    assert only_wave.share(PREDICTED, "wave")[at(1.0)] == 1
    assert only_wave.share(PREDICTED, "point")[at(1.0)] == 0
    assert only_wave.first_at(PREDICTED, 0.9) is None
    assert list(seen.gestures) == ["wave", "wave", "point"]


def two_in_one() -> Recording:
    first, second = raised("wave", frames=520), raised("point", onset=320, frames=520)
    motion = first.observed + second.observed
    return Recording(motion, motion, (*first.stretches, *second.stretches), "v02")  # type: ignore[misc]


def test_answers_agree_with_the_figures_of_a_model() -> None:
    mistaken = raised("wave")
    mistaken = Recording(mistaken.observed, mistaken.clean, (Stretch("point", 60, 160),), "v03")
    still = Recording(resting().observed, resting().clean, (Stretch("wave", 60, 160),), "v03")
    takes = [raised("wave"), mistaken, still, two_in_one(), resting()]
    for predict in (moving_on, hold_last):
        found = answers(live_streams(by_last_frame, predict, takes), CLASSES)
        figures = evaluate_decisions(by_last_frame, predict, takes, CLASSES)
        assert figures["takes"] == len(found.asked) == 5
        assert figures["right"] == pytest.approx(found.right.mean(), abs=1e-4) == 0.6
        assert figures["wrong"] == pytest.approx(found.wrong.mean(), abs=1e-4) == 0.2
        assert figures["missed"] == pytest.approx(found.missed.mean(), abs=1e-4) == 0.2
        assert figures["delay_s_p50"] == pytest.approx(found.delay_s(50), abs=1e-3)


def test_a_held_frame_answers_later() -> None:
    takes = [raised("wave")]
    early, late = (
        answers(live_streams(by_last_frame, predict, takes), CLASSES)
        for predict in (moving_on, hold_last)
    )
    # Windows end at frames 24, 29, ...; the third in a row that names it decides. The speed
    # shows from frame 64 on, the height from frame 74 on.
    assert early.delays_s.tolist() == [pytest.approx((74 - 60) / 25)]
    assert late.delays_s.tolist() == [pytest.approx((84 - 60) / 25)]


def test_decisions_where_nothing_is_asked_are_false() -> None:
    unasked = Recording(raised("wave").observed, raised("wave").clean, (), "v04")
    found = answers(live_streams(by_last_frame, moving_on, [unasked, raised("wave")]), CLASSES)
    assert found.false == 1
    # One recording of 260 frames, and what is not within onset to 0.4 s after the offset.
    assert found.idle_minutes == pytest.approx((260 + 260 - 111) / 25 / 60)
    assert found.false_per_10_minutes == pytest.approx(10 / found.idle_minutes)


def test_recordings_without_labels_are_left_out() -> None:
    unknown = Recording(raised("wave").observed, raised("wave").clean, None, "v05")
    assert live_streams(by_last_frame, moving_on, [unknown]) == []


def test_decided_shares_grow_to_all_that_is_decided() -> None:
    found = answers(
        live_streams(by_last_frame, moving_on, [raised("wave"), raised("point", onset=63)]), CLASSES
    )
    # Both are decided in the window that ends at frame 74: 0.56 s and 0.44 s after their onsets.
    shares = found.by(np.array([0.4, 0.5, 0.6]), found.right)
    assert shares.tolist() == [0, 0.5, 1]
    assert found.by(np.array([3.0]), found.wrong).tolist() == [0]


def test_more_windows_are_later_and_surer_thresholds_miss() -> None:
    streams = live_streams(by_last_frame, moving_on, [raised("wave")])
    found = sweep(streams, CLASSES)
    assert len(found) == len(ENTER) * len(ENTER_WINDOWS)
    delay = {
        (one.settings.enter, one.settings.enter_windows): one.answers.delay_s(50) for one in found
    }
    assert [delay[0.5, windows] for windows in ENTER_WINDOWS] == pytest.approx(
        [0.16, 0.36, 0.56, 0.76]
    )
    assert delay[0.95, 1] is None  # the classifier is never more than 90 % sure


def test_the_shipped_settings_are_what_answers_are_made_with() -> None:
    streams = live_streams(by_last_frame, moving_on, [raised("wave")])
    given = answers(streams, CLASSES)
    same = answers(streams, CLASSES, DecideSettings())
    assert DecideSettings() == DECIDE
    assert given.delays_s.tolist() == same.delays_s.tolist()
