"""Reactions against labels, with models that know a simple rule."""

from pathlib import Path

import pytest

from agent_server.bench.reactions import Stream, measure_reactions, played, recorded
from agent_server.config import Settings
from agent_server.domain.label import Label
from agent_server.errors import ConfigError
from agent_server.service.loading import load_models, load_room
from agent_server.synthetic.scenario import SCENARIOS

STREAMS = Path(__file__).parents[3] / "recorded_streams"


@pytest.fixture(scope="module")
def models():
    return load_models()


@pytest.fixture(scope="module")
def hello():
    return next(s for s in recorded_one("hello"))


def recorded_one(name):
    """The stream of one recording, out of a folder that holds it alone."""
    return (s for p, s in zip(sorted(STREAMS.glob("*.mcap")), recorded(STREAMS), strict=True)
            if p.stem == name)  # fmt: skip


def measure(models, *streams):
    return measure_reactions(models, load_room(Settings(), models), iter(streams))


def test_answers_are_counted_and_timed(models, hello):
    result = measure(models, hello)
    asked = sum(label.expected is not None for label in hello.labels)
    assert (result.streams, result.asked, result.right) == (1, asked, asked)
    assert (result.wrong, result.missed, result.false_reactions) == (0, 0, 0)
    assert 0.3 < result.delay_s_p50 < 2.0


def test_what_no_label_asks_for_is_false_and_what_does_not_come_is_missed(models, hello):
    elsewhere = Label("hello", 0, 1_000_000, "s01", "greet", False)
    stream = Stream(hello.face, hello.events, (elsewhere,), hello.duration_s)
    result = measure(models, stream)
    reactions = measure(models, hello).right
    assert (result.right, result.missed, result.false_reactions) == (0, 1, reactions)
    assert result.delay_s_p50 is None
    assert result.false_per_10_minutes > 0


def test_another_reaction_than_the_one_asked_for_is_wrong(models, hello):
    labels = tuple(
        Label(each.gesture, each.onset_ns, each.offset_ns, each.subject, "open_window", False)
        for each in hello.labels
        if each.expected is not None
    )
    result = measure(models, Stream(hello.face, hello.events, labels, hello.duration_s))
    assert (result.right, result.wrong) == (0, len(labels))


def test_other_seeds_give_other_people():
    first = next(played(1))
    assert {label.subject for label in first.labels} == {f"s{SCENARIOS[0].seed + 100:02d}"}


def test_a_folder_without_recordings_is_refused(tmp_path):
    with pytest.raises(ConfigError, match="holds no"):
        next(recorded(tmp_path))
