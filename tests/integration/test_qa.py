"""Suites from the command line: verdicts, reports, comparison; and the shipped suite holds."""

import json
import re
import shlex
import shutil
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import pytest
from typer.testing import CliRunner

from agent_server.cli.main import app
from agent_server.domain.stamp import to_ns
from agent_server.qa.tools.cut import cut
from tests.support.live_recordings import write_live

ROOT = Path(__file__).parents[2]
STREAMS = ROOT / "recorded_streams"


def run(*arguments, status=0):
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    if result.exception is not None and not isinstance(result.exception, SystemExit):
        raise result.exception
    assert result.exit_code == status, result.output
    return result.stdout


@pytest.fixture(scope="module")
def shipped(tmp_path_factory):
    """The shipped suite, run with two processes."""
    out = tmp_path_factory.mktemp("qa") / "out"
    said = run("qa", STREAMS, "--jobs", 2, "--out", out, "--json")
    return json.loads(said), out


@pytest.fixture
def small(tmp_path):
    """Two short streams."""
    folder = tmp_path / "small"
    folder.mkdir()
    for name in ("hello", "headset"):
        shutil.copy(STREAMS / f"{name}.mcap", folder)
    return folder


def case(run, name):
    return next(case for case in run["cases"] if case["name"] == f"{name}.mcap")


def without_times(run):
    return {**run, "cases": [{**case, "seconds": 0} for case in run["cases"]]}


def test_the_shipped_suite_covers_every_stream_and_holds(shipped):
    run, _ = shipped
    assert {c["name"] for c in run["cases"]} == {path.name for path in STREAMS.glob("*.mcap")}
    assert {c["status"] for c in run["cases"]} == {"passed"}
    assert len(run["limits"]) == 3
    assert all(check["passed"] for check in run["limits"])
    asked = [c for case in run["cases"] for c in case["checks"] if c["kind"] == "reaction"]
    assert len(asked) == 19


@pytest.mark.parametrize("name", ["cold", "pleasant_face"])
def test_it_judges_the_decisions_of_the_decision_log(shipped, name):
    log = [json.loads(x) for x in (STREAMS / "expected" / f"{name}.jsonl").read_text().splitlines()]
    steps = case(shipped[0], name)["steps"]
    assert [(s[0], s[1], s[4], s[5]) for s in steps] == [
        (d["window"], round(d["end_ns"] / 1e6), d["gesture"], d["outcome"]) for d in log
    ]


def test_the_number_of_processes_changes_nothing(shipped, small):
    alone = json.loads(run("qa", small, "--jobs", 1, "--json"))
    for name in ("hello", "headset"):
        together = case(shipped[0], name)
        found = case(alone, name)
        for key in ("steps", "forecast", "moments", "false_at_ms", "judged_ms", "sha256"):
            assert found[key] == together[key]


def test_junit_counts_every_expectation(shipped):
    run, out = shipped
    root = ElementTree.parse(out / "junit.xml").getroot()  # noqa: S314 - our own file
    tests = root.findall(".//testcase")
    assert len(tests) == sum(len(c["checks"]) for c in run["cases"]) + len(run["limits"])
    assert root.findall(".//failure") == []
    assert len({(t.get("classname"), t.get("name")) for t in tests}) == len(tests)


class Page(HTMLParser):
    """Collects what a page is made of, and checks that its elements are closed."""

    VOID = ("meta", "br", "circle", "rect", "path", "link", "img")

    def __init__(self):
        super().__init__()
        self.open, self.counts, self.addresses, self.ids = [], {}, [], set()

    def handle_starttag(self, tag, attributes):
        self.counts[tag] = self.counts.get(tag, 0) + 1
        given = dict(attributes)
        self.addresses += [given[k] for k in ("src", "href", "xlink:href") if k in given]
        self.ids |= {given["id"]} if "id" in given else set()
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.counts[tag] = self.counts.get(tag, 0) + 1

    def handle_endtag(self, tag):
        if tag not in self.VOID:
            assert self.open.pop() == tag


def test_the_report_is_whole_and_asks_for_nothing_outside(shipped):
    run, out = shipped
    text = (out / "report.html").read_text("utf-8")
    page = Page()
    page.feed(text)
    assert page.open == []
    assert all(address.startswith("#") for address in page.addresses)
    assert {address[1:] for address in page.addresses} <= page.ids
    assert not re.search(r"url\(|@import|<script|https?://", text)
    assert page.counts["details"] == len(run["cases"])
    assert page.counts["svg"] > 5 + len(run["cases"])
    assert "prefers-color-scheme: dark" in text
    assert "nan" not in re.findall(r'[dxy]="([^"]*)"', text)
    for words in (
        "19 of 19",
        "All of them are synthetic",
        "labelled stretches",
        "mean joint error",
    ):
        assert words in text


def test_an_expectation_that_is_not_met_fails_the_suite(small, tmp_path):
    (small / "suite.toml").write_text(
        '[recording."hello.mcap"]\nwithin_ms = 300\n[limits]\nmin_right = 0.9\n'
    )
    said = run("qa", small, "--jobs", 1, "--out", tmp_path / "out", status=1)
    assert "greet within 300 ms: greet after" in said
    assert "ms late" in said
    assert "right reactions: at least 90%: 50%" in said
    assert "small failed" in said
    root = ElementTree.parse(tmp_path / "out" / "junit.xml").getroot()  # noqa: S314
    assert len(root.findall(".//failure")) == 3


def test_a_recording_that_cannot_be_replayed_is_an_error(small):
    whole = (small / "hello.mcap").read_bytes()
    (small / "hello.mcap").write_bytes(whole[: len(whole) // 2])
    said = run("qa", small, "--jobs", 1, status=2)
    assert "is truncated" in said


def test_where_a_recording_has_no_verdict_others_that_fail_do_not_hide_it(small):
    whole = (small / "hello.mcap").read_bytes()
    (small / "hello.mcap").write_bytes(whole[: len(whole) // 2])
    (small / "suite.toml").write_text("[defaults]\nwithin_ms = 100\n")
    cases = json.loads(run("qa", small, "--jobs", 1, "--json", status=2))["cases"]
    assert [case["status"] for case in cases] == ["failed", "error"]


def test_other_rules_are_tried_beside_those_in_use(small, tmp_path):
    rules = (ROOT / "agent_server" / "scene" / "room.toml").read_text()
    mute = tmp_path / "mute.toml"
    mute.write_text(re.sub(r'(gesture = )"hello"', r'\1"loud"', rules, count=1))
    said = run("qa", small, "--rules", mute, "--jobs", 1, "--out", tmp_path / "out", status=1)
    assert "3 expectations broken, 0 mended" in said
    assert "hello greet → hello nothing_to_do" in said
    assert "3 expectations broke and 0 were mended" in (tmp_path / "out/report.html").read_text()


def test_the_same_models_from_another_folder_change_nothing(small, tmp_path):
    for name in ("ma_wgan_server", "interformer_server"):
        shutil.copytree(ROOT / "models" / "artifacts" / name, tmp_path / "bundles" / name)
    said = run("qa", small, "--models", tmp_path / "bundles", "--jobs", 1)
    assert re.search(r"0 of 2\d\d decisions differ", said)


def test_a_run_is_compared_with_a_saved_one(small, tmp_path):
    run("qa", small, "--jobs", 1, "--out", tmp_path / "before")
    (small / "suite.toml").write_text('[recording."hello.mcap"]\nlate_ms = 0\nwithin_ms = 5000\n')
    (small / "headset.mcap").unlink()
    baseline = tmp_path / "before" / "run.json"
    said = run("qa", small, "--jobs", 1, "--baseline", baseline)
    assert "gone: headset.mcap" in said
    assert "0 of 124 decisions differ" in said


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--baseline", ROOT / "pyproject.toml"), "is no run of a suite"),
        (("--models", ROOT / "docs"), "holds no bundle that predicts or classifies"),
        (("--models", ROOT / "models" / "benchmarks"), "both predict"),
    ],
)
def test_a_mistake_is_named(small, arguments, words):
    result = CliRunner().invoke(app, ["qa", str(small), *map(str, arguments)])
    assert result.exit_code == 1
    assert words in str(result.exception)


def test_faults_cost_what_the_table_says(small):
    (small / "headset.mcap").unlink()
    table = json.loads(run("qa", small, "--faults", "--jobs", 1, "--json"))["faults"]
    rows = {row["name"]: row for row in table}
    assert (rows["none"]["right"], rows["none"]["asked"], rows["none"]["refused"]) == (2, 2, 0)
    assert rows["20% come twice"]["refused"] > 100
    assert rows["20% come twice"]["right"] == 2
    late = rows["body 200 ms late"]["delay_p50_ms"] - rows["none"]["delay_p50_ms"]
    assert late == pytest.approx(200, abs=1)


def test_five_commands_lead_from_a_session_to_a_test(tmp_path, monkeypatch):
    """Word for word as docs/qa.md has them."""
    page = (ROOT / "docs" / "qa.md").read_text("utf-8")
    (commands,) = [block.splitlines() for block in blocks(page, "sh") if "info field.mcap" in block]
    cut(STREAMS / "idle_12_minutes.mcap", tmp_path / "begin.mcap", 0, to_ns(60))
    write_live(tmp_path / "begin.mcap", tmp_path / "field.mcap", session="hall-3")
    (tmp_path / "labels.csv").write_text(blocks(page, "csv")[0])
    (tmp_path / "suite").mkdir()
    monkeypatch.chdir(tmp_path)
    assert len(commands) == 5
    for index, command in enumerate(commands):
        program, *arguments = shlex.split(command)
        assert program == "agent-server"
        said = run(*arguments, status=1 if index == 4 else 0)
    assert blocks(page, "text")[0].strip() in said
    assert (tmp_path / "report" / "report.html").exists()
    assert b"hall-3" not in (tmp_path / "suite" / "wrong-greeting.mcap").read_bytes()


def blocks(page, language):
    return re.findall(rf"```{language}\n(.*?)```", page, re.DOTALL)
