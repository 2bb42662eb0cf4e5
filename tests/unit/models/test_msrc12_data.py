"""MSRC-12 as benchmarks cut it."""

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from agent_server.domain.motion import FRAME_NS
from agent_server.domain.skeleton import CoreJoint
from agent_server.skeleton.readers.source import Mark
from models.data.msrc12 import (
    AFTER_FRAMES,
    BEFORE_FRAMES,
    TAGS,
    TaggedStream,
    folds,
    tag_windows,
    tagged_recordings,
)
from models.data.real import CoreStream


def stream(frames: int, *marks: tuple[int, str], pause_at: int | None = None) -> TaggedStream:
    """Every joint is at x = number of the frame."""
    stamps = np.arange(frames, dtype=np.int64) * FRAME_NS
    if pause_at is not None:
        stamps[pause_at:] += 10 * FRAME_NS
    positions = np.zeros((frames, 9, 3), np.float32)
    positions[..., 0] = np.arange(frames)[:, None]
    tags = tuple(Mark(int(stamps[at]), tag) for at, tag in marks)
    return TaggedStream("take", "p01", CoreStream(stamps, positions), tags)


def test_every_person_is_in_one_role_and_tested_at_most_once() -> None:
    people = [f"p{number:02d}" for number in range(20)]
    rotations = folds(people[::-1])
    assert [fold.test for fold in rotations] == [tuple(people[k::4]) for k in range(3)]
    for fold in rotations:
        roles = [*fold.train, *fold.validation, *fold.test]
        assert sorted(roles) == people
        assert len(fold.validation) == 2


def test_the_seen_second_ends_half_a_second_before_the_tag() -> None:
    windows = tag_windows([stream(200, (100, "G4"))], {"p01"})
    assert len(windows) == 1
    assert windows.labels.tolist() == [TAGS.index("G4")]
    last_seen = windows.observed[windows.starts[0] + 24, CoreJoint.NAVEL, 0]
    assert 100 - float(last_seen) == pytest.approx(0.5 * 25 + 1, abs=1)


def test_windows_that_leave_the_recording_or_cross_a_pause_are_left_out() -> None:
    assert len(tag_windows([stream(200, (20, "G1"), (190, "G1"), (100, "G2"))], {"p01"})) == 1
    assert len(tag_windows([stream(200, (100, "G1"), pause_at=110)], {"p01"})) == 0


def test_shifted_windows_keep_their_label() -> None:
    windows = tag_windows([stream(200, (100, "G7"))], {"p01"}, shift=3)
    assert len(windows) == 7
    assert set(windows.labels.tolist()) == {TAGS.index("G7")}


def test_recordings_are_cut_at_pauses_and_keep_the_tags_of_each_part() -> None:
    parts = tagged_recordings([stream(300, (100, "G1"), (250, "G2"), pause_at=200)], {"p01"})
    assert [len(part.observed) for part in parts] == [200, 100]
    first, second = (part.stretches for part in parts)
    assert first is not None and second is not None
    assert [(s.gesture, s.onset, s.offset) for s in first] == [
        ("G1", 100 - BEFORE_FRAMES, 100 + AFTER_FRAMES)
    ]
    assert [(s.gesture, s.onset) for s in second] == [("G2", 50 - BEFORE_FRAMES)]
