"""The windows of the thesis's table."""

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from agent_server.domain.gesture import GESTURES, IDLE
from models.data.synthetic import synthetic_recordings
from models.evaluation.thesis import ABLATIONS, CLASSIFIER, EARLY_OR_LATE, MIX, PARTS, table_windows

PEOPLE = ("v500", "v501")


def test_eleven_people_of_whom_two_are_held_out() -> None:
    people = [person for _, _, group in PARTS.values() for person in group]
    assert len(people) == len(set(people)) == 11
    assert len(PARTS["test"][2]) == 2


def test_windows_begin_with_the_movement() -> None:
    takes = synthetic_recordings(7, 60, PEOPLE, MIX)
    windows = table_windows(7, 60, PEOPLE)
    each = 2 * EARLY_OR_LATE + 1
    assert len(windows) == 60 * each
    ends = np.cumsum([len(take.observed) for take in takes])
    for index, (take, end) in enumerate(zip(takes, ends, strict=True)):
        mine = windows.take(windows.starts.new_tensor(range(index * each, (index + 1) * each)))
        gesture = take.stretches[0].gesture if take.stretches else IDLE
        assert set(mine.labels.tolist()) == {GESTURES.index(gesture)}
        first = mine.starts.numpy() - (end - len(take.observed))
        assert first.min() >= 0
        assert first.max() + 75 <= len(take.observed)
        if take.stretches:
            assert abs(first - take.stretches[0].onset).max() <= EARLY_OR_LATE


def test_all_gestures_are_alike_often_and_nobody_uses_a_webcam() -> None:
    windows = table_windows(9, 400, PEOPLE)
    share = np.bincount(windows.labels.numpy(), minlength=7) / len(windows)
    assert share == pytest.approx(np.full(7, 1 / 7), abs=0.05)
    assert MIX.sensors[3] == 0.0


def test_ablations_change_the_network_alone() -> None:
    for config in ABLATIONS.values():
        assert config.network != CLASSIFIER.network
        assert (config.steps, config.batch) == (CLASSIFIER.steps, CLASSIFIER.batch)
