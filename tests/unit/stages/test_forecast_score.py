"""Scores of forecasts: against a naive computation, over gaps, and when they drift."""

import numpy as np
import pytest

from agent_server.domain.motion import (
    FRAME_NS,
    PREDICTED_FRAMES,
    RATE_HZ,
    SEEN_FRAMES,
    Forecast,
    Quality,
    Window,
)
from agent_server.stages.forecast_score import ForecastScore

QUALITY = Quality(1.0, 0.0, 0.0)


def walk(frames, seed=0):
    """A body whose joints wander, shape (T, 9, 3)."""
    steps = np.random.default_rng(seed).normal(0, 0.01, (frames, 9, 3))
    return np.cumsum(steps, axis=0).astype(np.float32)


def window(motion, end, *, body_id=1, confidence=None, start_ns=0):
    """The window of a motion whose last frame is ``end``."""
    seen = slice(end + 1 - SEEN_FRAMES, end + 1)
    sure = np.ones((len(motion), 9), np.float32) if confidence is None else confidence
    end_ns = start_ns + end * FRAME_NS
    return Window(end, body_id, 0, end_ns, motion[seen], sure[seen], QUALITY)


def forecast(motion, end, offset=0.0):
    """What comes after ``end``, and every joint this far off in x."""
    future = motion[end + 1 : end + 1 + PREDICTED_FRAMES] + np.float32([offset, 0, 0])
    return Forecast(future, "test")


def play(score, motion, *, hop=5, offset=0.0, start=SEEN_FRAMES - 1, **options):
    """Push every window whose future the motion has; gives how often it began to drift."""
    ends = range(start, len(motion) - PREDICTED_FRAMES, hop)
    return sum(score.push(window(motion, e, **options), forecast(motion, e, offset)) for e in ends)


@pytest.mark.parametrize("hop", [1, 5, 7, 25])
def test_a_score_is_that_of_a_naive_computation(hop):
    motion = walk(400)
    score = ForecastScore()
    play(score, motion, hop=hop, offset=0.03)
    last = range(SEEN_FRAMES - 1, len(motion) - PREDICTED_FRAMES, hop)[-1]
    a_second = -(-RATE_HZ // hop) * hop
    ends = [e for e in range(SEEN_FRAMES - 1, last + 1, a_second) if e + PREDICTED_FRAMES <= last]
    still = [
        np.linalg.norm(motion[e + 1 : e + 1 + PREDICTED_FRAMES] - motion[e], axis=-1).mean()
        for e in ends
    ]
    figures = score.figures()
    assert figures.forecasts == len(ends)
    assert figures.error_mm == pytest.approx(30.0, abs=0.1)
    assert figures.zero_velocity_mm == pytest.approx(1000 * np.mean(still), abs=0.1)


def test_nothing_is_said_before_the_truth_has_come():
    score = ForecastScore()
    motion = walk(124)
    play(score, motion)
    assert score.figures() is None or score.figures().forecasts == 0


@pytest.mark.parametrize("other", [{"body_id": 2}, {"start_ns": 40 * FRAME_NS}, {"start_ns": 7}])
def test_a_gap_or_another_body_begins_anew(other):
    score = ForecastScore()
    play(score, walk(150))
    before = score.figures().forecasts
    score.push(window(walk(400), 200, **other), forecast(walk(400), 200))
    play(score, walk(400), start=205, **other)
    # Of those before the break none is scored with what came after it.
    ends = range(200, 350, RATE_HZ)
    scored = sum(end + PREDICTED_FRAMES < 350 for end in ends)
    assert scored
    assert score.figures().forecasts == before + scored


def test_joints_that_are_not_tracked_and_forecasts_that_failed_do_not_count():
    motion = walk(200)
    wrong = motion.copy()
    wrong[:, 3] += 5.0
    confidence = np.ones((200, 9), np.float32)
    confidence[:, 3] = 0.0
    score = ForecastScore()
    for end in range(24, 150, 5):
        score.push(window(wrong, end, confidence=confidence), forecast(motion, end, 0.01))
    assert score.figures().error_mm == pytest.approx(10.0, abs=0.1)
    failed = ForecastScore()
    for end in range(24, 150, 5):
        failed.push(window(motion, end), Forecast(motion[:50], "last_frame", "it failed"))
    assert failed.figures() is None


def test_forecasts_that_are_worse_than_none_are_told_once_until_they_are_better():
    motion = walk(3000)
    score = ForecastScore()
    assert play(score, motion) == 0
    bad = ForecastScore()
    assert play(bad, motion, offset=2.0) == 1
    # A minute of good ones, and again bad ones.
    assert play(bad, motion, start_ns=3000 * FRAME_NS) == 0
    assert bad.figures().error_mm < 1.0
    assert play(bad, motion, offset=2.0, start_ns=6000 * FRAME_NS) == 1


def test_only_the_last_minute_counts():
    motion = walk(3000)
    score = ForecastScore()
    play(score, motion, offset=0.5)
    assert score.figures().forecasts == 61
