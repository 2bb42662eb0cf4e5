import re
from importlib import resources
from pathlib import Path

import pytest

from agent_server.domain.decision import Outcome
from agent_server.domain.gesture import GESTURES
from agent_server.errors import RuleError
from agent_server.scene.room import Room
from agent_server.scene.rules import parse_rules

GUIDE = Path(__file__).parents[3].joinpath("docs", "rules.md").read_text(encoding="utf-8")
ROOM = resources.files("agent_server.scene").joinpath("room.toml").read_text("utf-8")


def example(name):
    return re.search(rf"<!-- example: {name} -->\n```toml\n(.*?)```", GUIDE, re.DOTALL)[1]


def test_the_example_of_the_guide_works():
    text = ROOM.replace("[objects]\n", "[objects]\n" + example("object"))
    text = text.replace("[steps]\n", "[steps]\n" + example("step")) + example("rest")
    rules = parse_rules(text, [*GESTURES, "dim"], name="my_room.toml")
    room = Room(rules, "s")
    assert room.consider("dim", 0, 0).command.reaction == "dim_lamp"
    room.advance(room.deadline())
    assert room.snapshot().objects["lamp"] == "dimmed"
    assert room.consider("dim", 0, 0).outcome is Outcome.NOTHING_TO_DO


def test_the_mistake_of_the_guide_reads_as_it_says():
    text = ROOM.replace('when = { curtain = "open" }', 'when = { curtian = "open" }')
    with pytest.raises(RuleError) as refused:
        parse_rules(text, GESTURES, name="my_room.toml")
    assert str(refused.value) in GUIDE


KEYS = [
    *("attention_s", "ungated", "states", "initial", "duration_s", "target"),
    *("steps", "effects", "priority", "ttl_s", "gesture", "when", "reaction", "preempts"),
]


@pytest.mark.parametrize("key", KEYS)
def test_the_guide_explains_every_key(key):
    assert f"| `{key}` |" in GUIDE
