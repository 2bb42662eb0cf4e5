"""Decision logs side by side: rounding is no change, all else is."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from agent_server.cli.main import app
from agent_server.errors import RecordingError
from agent_server.service.decision_log import changes, read_log

STREAMS = Path(__file__).parents[3] / "recorded_streams"
LOG = STREAMS / "expected" / "cold.jsonl"


def altered(tmp_path, alter):
    """The log with one decision changed, the first whose gate saw a face."""
    rows = [json.loads(line) for line in LOG.read_text().splitlines()]
    alter(next(row for row in rows if row["gate"]["valence"] is not None))
    path = tmp_path / "altered.jsonl"
    path.write_text("".join(json.dumps(row) + "\n" for row in rows))
    return read_log(path)


def move(section, name, by):
    def alter(row):
        row[section][name] += by if row[section][name] + by <= 1 else -by

    return alter


@pytest.mark.parametrize(
    "alter", [move("probabilities", "cold", 0.015), move("gate", "valence", -0.04)]
)
def test_what_other_arithmetic_rounds_is_no_change(tmp_path, alter):
    found = altered(tmp_path, alter)
    assert found != read_log(LOG)
    assert list(changes(read_log(LOG), found)) == []


@pytest.mark.parametrize(
    ("alter", "field"),
    [
        (move("probabilities", "cold", 0.03), "probabilities.cold"),
        (move("gate", "valence", -0.1), "gate.valence"),
        (move("gate", "age_ms", 0.1), "gate.age_ms"),
        (lambda row: row.update(outcome="busy"), "outcome"),
    ],
)
def test_everything_else_is_a_change(tmp_path, alter, field):
    found = list(changes(read_log(LOG), altered(tmp_path, alter)))
    assert [change.field for change in found] == [field]


def test_a_decision_more_or_less_is_told():
    log = read_log(LOG)
    (less,) = changes(log, log[:-1])
    assert (less.index, less.expected, less.actual) == (len(log) - 1, log[-1].id, None)
    assert "the decision is None" in str(less)
    (more,) = changes(log[:-1], log)
    assert more.expected is None


def test_what_is_no_log_is_refused_with_its_line(tmp_path):
    path = tmp_path / "log.jsonl"
    path.write_text(LOG.read_text().splitlines()[0] + "\n{}\n")
    with pytest.raises(RecordingError, match=r"log\.jsonl, line 2 is no decision"):
        read_log(path)
    with pytest.raises(RecordingError, match=r"none\.jsonl cannot be read"):
        read_log(tmp_path / "none.jsonl")


def test_replay_compares_with_a_log(tmp_path):
    def run(log):
        return CliRunner().invoke(
            app, ["replay", str(STREAMS / "cold.mcap"), "--expect", str(log), "--json"]
        )

    same = run(LOG)
    assert (same.exit_code, json.loads(same.stdout)["changes"]) == (0, [])
    wrong = tmp_path / "wrong.jsonl"
    wrong.write_text(LOG.read_text().replace('"outcome":"command"', '"outcome":"busy"'))
    other = run(wrong)
    assert other.exit_code == 1
    assert {change["field"] for change in json.loads(other.stdout)["changes"]} == {"outcome"}


def test_every_replay_gives_the_same_bytes():
    done = CliRunner().invoke(
        app, ["bench", "replay", str(STREAMS / "cold.mcap"), "--runs", "2", "--json"]
    )
    result = json.loads(done.stdout)
    assert (done.exit_code, result["identical"]) == (0, 2)
    assert result["times_real_time"] > 1
