"""Replays of inputs that come in otherwise than they were captured."""

from pathlib import Path

import numpy as np
import pytest

from agent_server.config import Settings
from agent_server.qa.faults.base import Arrival, NoFault
from agent_server.qa.faults.transport import Delay, Duplicate, Reorder
from agent_server.qa.faulty import replay_arrivals
from agent_server.qa.setup import load_setup
from agent_server.recording.reader import open_recording
from agent_server.service.replay import log_line, replay

SMELL = Path(__file__).parents[3] / "recorded_streams" / "smell.mcap"


@pytest.fixture(scope="module")
def setup():
    return load_setup(Settings())


@pytest.fixture(scope="module")
def clean(setup):
    recording = open_recording(SMELL)
    return [log_line(d) for d in replay(recording, setup.core("smell"), setup.models)]


def under(fault, setup):
    given = [Arrival(event.originating_ns, event) for event in open_recording(SMELL).events()]
    came = sorted(fault.apply(given, np.random.default_rng(5)), key=lambda a: a.at_ns)
    return replay_arrivals("smell", setup, "expected", came)


def test_without_a_fault_decisions_are_those_of_a_plain_replay(setup, clean):
    taken, refused = under(NoFault(), setup)
    assert [log_line(decision) for _, decision in taken] == clean
    assert refused == 0
    assert all(0 <= at_ns - decision.end_ns < 50_000_000 for at_ns, decision in taken)


def test_what_comes_twice_is_refused_the_second_time_and_changes_nothing(setup, clean):
    taken, refused = under(Duplicate(0.3), setup)
    assert [log_line(decision) for _, decision in taken] == clean
    assert refused > 200


def test_what_comes_late_is_decided_on_late(setup):
    plain, _ = under(NoFault(), setup)
    late, _ = under(Delay(200), setup)
    assert [(at - 200_000_000, d.end_ns) for at, d in late] == [(at, d.end_ns) for at, d in plain]


def test_what_comes_after_its_successors_is_passed_over(setup, clean):
    taken, refused = under(Reorder(0.1), setup)
    assert refused > 30
    assert abs(len(taken) - len(clean)) < 5
