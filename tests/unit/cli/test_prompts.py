"""What a person is told while a gesture is recorded."""

from io import StringIO

import pytest
from rich.console import Console

from agent_server.cli.prompts import Prompter
from agent_server.domain.label import Label
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
from agent_server.service.take_recorder import OtherSession, SensorMoved

NS = 1_000_000_000
LABEL = Label("wave", 4 * NS, 6 * NS, "anna", None, quiet=False)


def told(*notices, gesture="wave"):
    out = StringIO()
    plan = TakePlan(gesture, "anna", 4, 3 * NS, NS)
    prompter = Prompter(Console(file=out, width=100), plan, "lab")
    for notice in notices:
        prompter.tell(notice)
    return out.getvalue()


def test_a_count_down_is_one_line_and_what_comes_next_another():
    counted = [Count(2, 3), Count(2, 2), Count(2, 1)]
    assert told(*counted, Go(2, 3 * NS), Taken(2, LABEL, is_cut=False)) == (
        "2 of 4:  3  2  1  go  (3 s)\ngood, 2.0 s\n"
    )
    first, second = told(*counted[:2], Gone()).splitlines()
    assert first == "2 of 4:  3  2  "
    assert second.startswith("I do not see you")


def test_idle_motion_has_no_repetitions():
    assert told(Count(1, 3), Go(1, 20 * NS), Left(10 * NS), gesture="idle") == (
        "3  go  (20 s)\n10 s left\n"
    )
    assert "none of your gestures" in told(Seen(), gesture="idle")


@pytest.mark.parametrize(
    ("notice", "words"),
    [
        (Seen(), "show wave once"),
        (SensorMoved(is_here=True), "A sensor is here"),
        (SensorMoved(is_here=False), "has gone"),
        (OtherSession("hall"), "say --session hall"),
        (Again(1, Spoilt.STILL), "no arm moved"),
        (Again(1, Spoilt.HIDDEN), "did not see your hands"),
        (Again(1, Spoilt.LOST), "lost you"),
        (Taken(1, LABEL, is_cut=True), "raise --seconds"),
        (Done(), "That was all"),
    ],
)
def test_everything_that_happens_is_said_in_words(notice, words):
    assert words in told(notice)
