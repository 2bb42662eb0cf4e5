"""The command line: what each command prints, and how mistakes are told."""

import asyncio
import json
import re
import shutil
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path

import pytest
from typer.testing import CliRunner

from agent_server import __version__, assets
from agent_server.cli.main import app, main
from agent_server.protocol import codes
from agent_server.recording.reader import open_recording
from tests.support.live import live

STREAMS = Path(__file__).parents[2] / "recorded_streams"


def run(*arguments):
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == 0, result.output
    return result.stdout


def fails(monkeypatch, capsys, *arguments):
    """Run as from a shell, and give what was said on stderr."""
    monkeypatch.setattr(sys, "argv", ["agent-server", *map(str, arguments)])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2
    return " ".join(capsys.readouterr().err.split())


def test_the_version_is_told():
    assert run("--version").strip() == __version__


def test_replay_prints_one_decision_a_line_and_the_same_bytes_twice():
    first = run("replay", STREAMS / "cold.mcap", "--speed", "max", "--json")
    lines = [json.loads(line) for line in first.splitlines()]
    assert [line["index"] for line in lines] == list(range(len(lines)))
    assert any(line["outcome"] == "command" for line in lines)
    assert first == run("replay", STREAMS / "cold.mcap", "--json")


def test_replay_tells_a_person_what_happened():
    told = run("replay", STREAMS / "cold.mcap")
    assert "-> close_window (stand up, walk to, close, walk to, sit down)" in told
    assert len(told.splitlines()) < 20


def test_replay_keeps_the_pace_that_is_asked_for():
    start = time.monotonic()
    lines = run("replay", STREAMS / "cold.mcap", "--speed", "10", "--json").splitlines()
    # 124 windows, 0.2 s apart, ten times as fast.
    assert time.monotonic() - start > 0.9 * (len(lines) - 1) * 0.2 / 10


def test_replay_heeds_the_settings(tmp_path):
    (tmp_path / "thesis.toml").write_text("[window]\nmode = 'thesis'\n[gate]\nmode = 'thesis'\n")
    out = run("replay", STREAMS / "cold.mcap", "--json", "-c", tmp_path / "thesis.toml")
    lines = [json.loads(line) for line in out.splitlines()]
    assert {b["end_ns"] - a["end_ns"] for a, b in pairwise(lines)} == {10**9}
    assert {line["gate"]["mode"] for line in lines} == {"thesis"}


async def test_replay_sends_to_a_running_server():
    async with live() as server:
        command = [sys.executable, "-m", "agent_server", "replay", STREAMS / "loud.mcap"]
        command += ["--to", server.url, "--speed", "20", "--json"]
        process = await asyncio.create_subprocess_exec(*command, stdout=subprocess.PIPE)
        out, _ = await process.communicate()
        assert process.returncode == 0
        ids = [json.loads(line)["id"] for line in out.splitlines()]
        assert "loud/0" in ids
        assert server.hub.sessions["loud"].counters["frames"] > 700


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["replay", "nowhere.mcap"], "nowhere.mcap"),
        (["replay", STREAMS / "cold.mcap", "--speed", "fast"], "--speed is 'fast'"),
        (["replay", STREAMS / "cold.mcap", "--speed", "-1"], "--speed is '-1'"),
        (["replay", STREAMS / "cold.mcap", "--to", "http://x", "--speed", "max"], "--speed max"),
        (["serve", "--port", "70000"], "port must lie in"),
        (["replay", STREAMS / "cold.mcap", "--to", "http://127.0.0.1:9"], "cannot connect"),
        (["replay", STREAMS / "cold.mcap", "-c", "nowhere.toml"], "nowhere.toml"),
        (["serve", "--host", "203.0.113.1", "--port", "1"], "no tokens are asked for"),
        (["serve", "--host", "203.0.113.1", "--port", "1", "--insecure"], "cannot listen"),
        (["convert", "--from", "msrc12", "nowhere.csv", "out.mcap"], "nowhere.csv"),
        (["recover", "nowhere.mcap", "out.mcap"], "nowhere.mcap"),
        (["serve", "--classifier", "nowhere"], "no manifest.json in nowhere"),
        (["replay", STREAMS / "cold.mcap", "--predictor", "nowhere"], "no manifest.json"),
        (["replay", STREAMS / "cold.mcap", "--expect", "nowhere.jsonl"], "nowhere.jsonl"),
        (["qa", "nowhere"], "nowhere"),
        (["qa", STREAMS.parent / "pyproject.toml"], "pyproject.toml"),
    ],
)
def test_a_mistake_is_told_in_a_sentence(monkeypatch, capsys, arguments, said):
    assert said in fails(monkeypatch, capsys, *arguments)


def test_convert_reports_what_it_did(tmp_path):
    lines = [{"format": "core9", "subject": "anna"}]
    joints = [[0.0, 0.1 * j, 2.0, 1.0] for j in range(9)]
    lines += [{"time_s": index / 30, "body_id": 1, "joints": joints} for index in range(60)]
    source = tmp_path / "anna.jsonl"
    source.write_text("".join(json.dumps(line) + "\n" for line in lines))
    out = tmp_path / "anna.mcap"
    report = json.loads(run("convert", "--from", "kinect-json", source, out, "--json"))
    assert (report["frames"], report["format"]) == (60, "core9")
    assert len(list(open_recording(out).events())) == 60
    told = run("convert", "--from", "kinect-json", "--affect", -6, 5, source, tmp_path / "b.mcap")
    assert "60 frames of 1 bodies" in told
    assert open_recording(tmp_path / "b.mcap").metadata.face == "expected"


def test_recover_saves_what_is_whole(tmp_path):
    damaged = tmp_path / "damaged.mcap"
    whole = (STREAMS / "cold.mcap").read_bytes()
    damaged.write_bytes(whole[: len(whole) // 2])
    report = json.loads(run("recover", damaged, tmp_path / "a.mcap", "--json"))
    assert report["records"] > 100
    assert not report["finished"]
    told = run("recover", damaged, tmp_path / "b.mcap")
    assert "did not come to an end" in told
    assert run("replay", tmp_path / "b.mcap", "--json")
    shutil.copy(STREAMS / "cold.mcap", tmp_path / "whole.mcap")
    assert "nothing was lost" in run("recover", tmp_path / "whole.mcap", tmp_path / "c.mcap")


def test_benchmarks_print_json():
    ingest = json.loads(run("bench", "ingest", "--rounds", 1, "--json"))
    assert ingest["us_per_frame"] > 0
    assert ingest["joints"] == 25
    decision = json.loads(run("bench", "decision", "--rounds", 1, "--json"))
    stages = ("affect", "window", "predict", "futures", "classify", "decide")
    assert tuple(decision["stages"]) == stages
    assert 0 < decision["p50_ms"] <= decision["p95_ms"] <= decision["p99_ms"]
    load = json.loads(run("bench", "load", "--sessions", 2, "--seconds", 4, "--json"))
    assert load["sessions"] == 2
    assert load["decisions"] >= 2 * 10
    assert load["rss_mb"] > 10


def test_the_demo_runs_and_ends_by_itself():
    command = [sys.executable, "-m", "agent_server", "demo", STREAMS / "cold.mcap"]
    command += ["--no-browser", "--port", "0", "--rounds", "1"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=90, check=False)
    assert done.returncode == 0, done.stderr
    assert "/?session=demo" in done.stdout
    assert "close_window" in done.stdout


def test_a_wrong_bundle_stops_the_start_with_a_sentence(monkeypatch, capsys, tmp_path):
    shutil.copytree(assets.bundles(), tmp_path / "bundles")
    (tmp_path / "bundles" / "ma_wgan_server" / "model.onnx").write_bytes(b"")
    monkeypatch.setattr(assets, "bundles", lambda: tmp_path / "bundles")
    assert "was altered" in fails(monkeypatch, capsys, "serve", "--port", "0")


def test_a_wrong_rule_file_stops_the_start_with_its_line(monkeypatch, capsys, tmp_path):
    rules = (Path(assets.__file__).parent / "scene" / "room.toml").read_text()
    line = rules[: rules.index('gesture = "loud"')].count("\n") + 1
    (tmp_path / "room.toml").write_text(rules.replace('gesture = "loud"', 'gesture = "laud"'))
    (tmp_path / "c.toml").write_text(f"rules = '{tmp_path / 'room.toml'}'\n")
    said = fails(monkeypatch, capsys, "serve", "--port", "0", "-c", tmp_path / "c.toml")
    assert f"room.toml:{line}" in said
    assert "did you mean 'loud'" in said


def test_closing_codes_are_those_of_the_table():
    ours = {value for name, value in vars(codes).items() if re.fullmatch("CLOSE_[A-Z_]+", name)}
    assert {value for value in ours if isinstance(value, int)} == {
        code.code for code in codes.CLOSE_CODES
    }
