"""Prompts, count-down and labels, with a person who does what is said, or does not."""

import pytest

from agent_server.domain.skeleton import SkeletonFrame
from agent_server.errors import InvalidInput
from agent_server.recording.director import TakeDirector
from agent_server.recording.takes import (
    Again,
    Count,
    Done,
    Go,
    Gone,
    Left,
    Seen,
    Spoilt,
    Taken,
    TakePlan,
)
from tests.support.bodies import core_joints
from tests.support.takes import NS, Person

FRAME_S = 0.04


def plan(gesture="wave", repetitions=3, window_s=3.0, rest_s=1.0):
    return TakePlan(gesture, "anna", repetitions, round(window_s * NS), round(rest_s * NS))


def person(**options):
    return Person(TakeDirector(plan(**options)))


def test_each_repetition_is_counted_down_shown_and_labelled_where_the_hands_move():
    anna = person()
    anna.stay(30)
    assert anna.said(Seen, Count, Go, Taken, Done) == [
        Seen(),
        *(
            cue
            for repetition, label in enumerate(anna.director.labels, 1)
            for cue in (
                *(Count(repetition, left) for left in (3, 2, 1)),
                Go(repetition, 3 * NS),
                Taken(repetition, label, is_cut=False),
            )
        ),
        Done(),
    ]
    assert len(anna.motions) == len(anna.director.labels) == 3
    for (start, end), label in zip(anna.motions, anna.director.labels, strict=True):
        assert label.onset_ns / NS == pytest.approx(start / NS, abs=3 * FRAME_S)
        assert label.offset_ns / NS == pytest.approx(end / NS, abs=3 * FRAME_S)
        assert (label.gesture, label.subject) == ("wave", "anna")
        assert (label.expected, label.quiet) == (None, False)
    assert anna.director.repeated == 0


def test_counts_come_a_second_apart_and_rest_follows_a_repetition():
    anna = person(repetitions=2)
    anna.stay(30)
    times = {
        (type(cue), getattr(cue, "left", 0), cue.repetition): now / NS
        for now, cue in anna.cues
        if isinstance(cue, Count | Go | Taken)
    }
    for repetition in (1, 2):
        go = times[Go, 0, repetition]
        for left in (3, 2, 1):
            assert times[Count, left, repetition] == pytest.approx(go - left, abs=0.1)
        assert times[Taken, 0, repetition] == pytest.approx(go + 3.0, abs=0.1)
    assert times[Count, 3, 2] == pytest.approx(times[Taken, 0, 1] + 1.0, abs=0.1)


def test_a_repetition_in_which_nothing_moves_comes_again_without_a_label():
    anna = person(repetitions=1)
    anna.is_willing = False
    anna.until(Again)
    assert anna.said(Again) == [Again(1, Spoilt.STILL)]
    assert anna.director.labels == []
    anna.is_willing = True
    anna.until(Done)
    assert len(anna.director.labels) == anna.director.repeated == 1


def test_hands_that_the_sensor_only_guesses_are_told_as_such():
    anna = person(repetitions=1)
    anna.until(Go)
    anna.confidence = 0.5
    anna.until(Again)
    assert anna.said(Again) == [Again(1, Spoilt.HIDDEN)]


def test_a_gesture_that_takes_too_long_is_labelled_to_the_end_and_called_cut():
    anna = person(repetitions=1)
    anna.hold_ns = 5 * NS
    anna.until(Taken)
    (taken,) = anna.said(Taken)
    assert taken.is_cut
    assert taken.label.offset_ns / NS == pytest.approx(anna.now_ns / NS, abs=3 * FRAME_S)


def test_a_body_that_is_lost_in_mid_repetition_costs_that_repetition_alone():
    anna = person(repetitions=2)
    anna.until(Taken)
    first = anna.director.labels[0]
    anna.until(Go)
    anna.stay(1)
    anna.leave(5)
    assert anna.said(Again, Gone) == [Again(2, Spoilt.LOST), Gone()]
    anna.until(Go)
    anna.until(Done)
    assert [cue.repetition for cue in anna.said(Go)] == [1, 2, 2]
    assert anna.director.labels[0] == first
    assert len(anna.director.labels) == 2
    onset_ns = anna.director.labels[1].onset_ns
    assert onset_ns / NS == pytest.approx(anna.motions[2][0] / NS, abs=3 * FRAME_S)


def test_frames_that_stop_without_a_clock_that_tells_are_noticed_at_the_next_frame():
    anna = person(repetitions=1)
    anna.until(Go)
    anna.stay(1)
    anna.now_ns += NS // 2
    anna.stay(0.1)
    assert anna.said(Again, Gone, Seen) == [Seen(), Again(1, Spoilt.LOST), Gone(), Seen()]


def test_a_short_gap_spoils_nothing():
    anna = person(repetitions=1)
    anna.until(Go)
    anna.stay(1)
    anna.now_ns += NS // 5
    anna.until(Done)
    assert anna.director.repeated == 0


def test_a_count_down_that_is_left_starts_anew_and_spoils_nothing():
    anna = person(repetitions=1)
    anna.until(Count)
    anna.leave(3)
    anna.until(Done)
    assert anna.said(Gone, Again) == [Gone()]
    assert [cue.left for cue in anna.said(Count)] == [3, 3, 2, 1]


def test_who_leaves_during_the_rest_is_waited_for():
    anna = person(repetitions=2, rest_s=5.0)
    anna.until(Taken)
    anna.leave(30)
    assert anna.said(Gone) == [Gone()]
    anna.until(Done)
    assert len(anna.director.labels) == 2


def test_somebody_who_passes_behind_changes_nothing():
    anna = person(repetitions=1)
    while not anna.said(Done):
        behind = SkeletonFrame(
            anna.now_ns, 9, "core9", core_joints(hands_up=True, shift=(0.0, 0.0, 1.5))
        )
        anna.stay(1 / 30)
        anna.hear(anna.director.push(behind))
    assert anna.said(Gone, Again) == []
    (label,) = anna.director.labels
    assert label.onset_ns / NS == pytest.approx(anna.motions[0][0] / NS, abs=3 * FRAME_S)


def test_a_body_of_which_a_joint_is_never_seen_is_not_prompted():
    director = TakeDirector(plan())
    joints = core_joints()
    joints[-1, 3] = 0.0
    for index in range(200):
        assert director.push(SkeletonFrame(index * NS // 30, 1, "core9", joints)) == []


def test_idle_motion_is_one_quiet_stretch_as_long_as_all_repetitions():
    anna = person(gesture="idle", repetitions=6)
    anna.until(Done)
    (label,) = anna.director.labels
    assert (label.offset_ns - label.onset_ns) / NS == pytest.approx(24, abs=0.1)
    assert (label.gesture, label.quiet) == ("idle", True)
    assert anna.said(Go) == [Go(1, 24 * NS)]
    assert anna.said(Left) == [Left(20 * NS), Left(10 * NS)]


def test_idle_motion_that_is_broken_off_goes_on_with_what_is_missing():
    anna = person(gesture="idle", repetitions=5)
    anna.until(Go)
    anna.stay(1)
    anna.leave(4)
    assert anna.said(Again) == [Again(1, Spoilt.LOST)]
    anna.until(Go)
    anna.stay(8)
    anna.leave(4)
    anna.until(Done)
    lengths = [(label.offset_ns - label.onset_ns) / NS for label in anna.director.labels]
    assert lengths == [pytest.approx(8, abs=0.1), pytest.approx(12, abs=0.1)]


def test_stopping_keeps_idle_motion_but_no_half_repetition():
    for gesture, labels in (("idle", 1), ("wave", 0)):
        anna = person(gesture=gesture, window_s=10.0)
        anna.until(Go)
        anna.stay(8)
        anna.hear(anna.director.stop())
        assert len(anna.director.labels) == labels
        anna.stay(30)
        assert len(anna.director.labels) == labels


@pytest.mark.parametrize("name", ["wave", "cold", "thumbs_up", "Stop-2", "idle", "x" * 40])
def test_names_that_will_do(name):
    assert plan(gesture=name).gesture == name


@pytest.mark.parametrize("name", ["", "two words", "2nd", "über", "a/b", "../x", "x" * 41, "a\n"])
def test_names_that_will_not_do(name):
    with pytest.raises(InvalidInput, match="letters, digits"):
        plan(gesture=name)


@pytest.mark.parametrize(("name", "said"), [("Hello", "'hello'"), ("body_lost", "cause")])
def test_names_that_mean_something_else_are_refused(name, said):
    with pytest.raises(InvalidInput, match=said):
        plan(gesture=name)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"repetitions": 0}, "at least one"),
        ({"window_s": 0.5}, "at least one"),
        ({"rest_s": -1.0}, "at least one"),
        ({"gesture": "idle", "repetitions": 1, "window_s": 1.0}, "idle motion"),
    ],
)
def test_plans_that_record_nothing_are_refused(options, said):
    with pytest.raises(InvalidInput, match=said):
        plan(**options)


@pytest.mark.parametrize("subject", ["", "Anna B.", "a/b"])
def test_a_subject_is_a_name_too(subject):
    with pytest.raises(InvalidInput, match="subject"):
        TakePlan("wave", subject, 1, NS, 0)
