"""``agent-server gestures``: a sensor on a real websocket, prompts, and what is in the file."""

import asyncio
import json
import re
import signal
import sys
from contextlib import asynccontextmanager

import pytest

from agent_server.cli import gestures as module
from agent_server.cli.main import main
from agent_server.client.once import ConnectionFailed, join, send_paced
from agent_server.recording.reader import open_recording
from agent_server.synthetic.scenario import Part, Scenario, play
from agent_server.synthetic.sensors import KINECT_V2
from tests.support.patience import PATIENCE_S, patience

NS = 1_000_000_000
SPEED = 10.0
"""The stamps of the frames are the clock, so that a recording may be sent faster than made."""
SHOWN = Scenario(
    name="covers_ears",
    description="Covers both ears, twice, half a second after the go.",
    seed=4,
    sensor=KINECT_V2,
    duration_s=26.0,
    parts=(Part("loud", "palms", 4.9), Part("loud", "palms", 13.9)),
)
"""Settled after a second, go after three more, five for the gesture, one of rest, and again."""


@asynccontextmanager
async def recording(tmp_path, *options):
    """The command in a process of its own, once it listens; its address comes with it."""
    line = [sys.executable, "-m", "agent_server", "gestures", "record", "cover"]
    line += ["--subject", "anna", "--repetitions", "2", "--seconds", "5", "--rest", "1"]
    line += ["--port", "0", "--out", str(tmp_path), "--json", *options]
    pipe = asyncio.subprocess.PIPE
    process = await asyncio.create_subprocess_exec(*line, stdout=pipe, stderr=pipe)
    try:
        said = (await asyncio.wait_for(process.stderr.readline(), PATIENCE_S)).decode()
        yield process, re.search(r"ws://[0-9.:]+", said)[0]
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()


async def ended(process):
    """Exit status, what was printed, and what was said."""
    out, err = await asyncio.wait_for(process.communicate(), PATIENCE_S)
    return process.returncode, out.decode(), err.decode()


async def send(url, events):
    """Play what a sensor sent; the server may go away before the end."""
    try:
        async with join(url, "lab", "sensor") as sensor:
            await send_paced(sensor, events, SPEED)
    except ConnectionFailed as error:
        assert "stopping" in str(error)


async def test_a_sensor_is_recorded_and_the_labels_lie_on_the_motion(tmp_path):
    shown = play(SHOWN)
    async with recording(tmp_path) as (process, url):
        await send(url, shown.events)
        status, out, said = await ended(process)
    assert status == 0, said
    report = json.loads(out)
    assert (report["repetitions"], report["repeated"]) == (2, 0)
    file = open_recording(tmp_path / report["file"])
    assert file.path.name.startswith("cover-anna-")
    frames = [event for event in file.events() if hasattr(event, "joints")]
    sent = [event for event in shown.events if hasattr(event, "joints")]
    assert [f.originating_ns for f in frames] == [
        f.originating_ns for f in sent[: report["frames"]]
    ]
    labels = file.labels()
    assert [label.onset_ns for label in labels] == [one["onset_ns"] for one in report["labels"]]
    truth = [label for label in shown.labels if label.gesture == "loud"]
    for label, true in zip(labels, truth, strict=True):
        assert (label.gesture, label.subject) == ("cover", "anna")
        assert label.onset_ns / NS == pytest.approx(true.onset_ns / NS, abs=0.2)
        assert label.offset_ns / NS == pytest.approx(true.offset_ns / NS, abs=0.6)
    # Rest goes on after the last label, as after the others.
    assert frames[-1].originating_ns - labels[-1].offset_ns > NS
    for words in ("A sensor is here", "1 of 2:  3  2  1  go", "good", "That was all"):
        assert words in said


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT for a single process")
async def test_an_interruption_keeps_what_was_finished(tmp_path):
    shown = play(SHOWN)
    until = [event for event in shown.events if event.originating_ns < 14 * NS]
    async with recording(tmp_path) as (process, url):
        async with join(url, "hall", "sensor"):
            await send(url, until)
        process.send_signal(signal.SIGINT)
        status, out, said = await ended(process)
    assert status == 130, said
    assert "Somebody came to session hall" in said
    report = json.loads(out)
    assert report["repetitions"] == 1
    assert len(open_recording(tmp_path / report["file"]).labels()) == 1


async def test_a_sensor_that_goes_in_mid_repetition_may_come_back(tmp_path):
    shown = play(SHOWN)
    until = [event for event in shown.events if event.originating_ns < 6 * NS]
    async with recording(tmp_path, "--repetitions", "1") as (process, url):
        await send(url, until)
        async with patience():
            while "did not count" not in (await process.stderr.readline()).decode():
                pass
        await send(url, shown.events)
        status, out, said = await ended(process)
    assert status == 0, said
    report = json.loads(out)
    assert (report["repetitions"], report["repeated"]) == (1, 1)
    # The second connection's clock goes on where the first one's has stopped.
    assert report["labels"][0]["onset_ns"] > until[-1].originating_ns + 4 * NS


async def test_a_sensor_that_does_not_come_is_waited_for_but_not_for_ever(tmp_path):
    async with recording(tmp_path, "--wait", "1") as (process, _):
        status, out, said = await ended(process)
    assert status == 2
    assert json.loads(out)["file"] is None
    assert "no sensor came: connect one to ws://" in " ".join(said.split())
    assert list(tmp_path.iterdir()) == []


async def test_a_sensor_whose_body_does_not_show_is_told_from_none(tmp_path):
    async with (
        recording(tmp_path, "--wait", "1.5") as (process, url),
        join(url, "lab", "sensor"),
    ):
        _, _, said = await ended(process)
    assert "a sensor is connected, but sends no body" in " ".join(said.split())


def fails(monkeypatch, capsys, *arguments):
    monkeypatch.setattr(sys, "argv", ["agent-server", "gestures", *map(str, arguments)])
    with pytest.raises(SystemExit) as end:
        main()
    return end.value.code, " ".join(capsys.readouterr().err.split())


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["two words"], "letters, digits"),
        (["Cold"], "built-in 'cold'"),
        (["wave", "--subject", "a b"], "subject is 'a b'"),
        (["wave", "--session", "a b"], "--session is 'a b'"),
        (["wave", "--port", "70000"], "port must lie in"),
        (["wave", "--host", "203.0.113.1", "--port", "1"], "cannot listen"),
    ],
)
def test_a_mistake_is_told_before_anybody_is_waited_for(
    monkeypatch, capsys, tmp_path, arguments, said
):
    monkeypatch.chdir(tmp_path)
    status, error = fails(monkeypatch, capsys, "record", *arguments)
    assert (status, said in error) == (2, True), error
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", ["train", "check"])
def test_without_the_training_extra_the_way_to_it_is_told(monkeypatch, capsys, command):
    monkeypatch.setattr(module, "NEEDS_TRAINING", ("models", "a_torch_that_is_not_here"))
    status, error = fails(monkeypatch, capsys, command, "DIR")
    assert status == 2
    assert "needs a_torch_that_is_not_here" in error
    assert "pip install -e '.[train]'" in error


@pytest.mark.parametrize("command", ["train", "check"])
def test_train_and_check_pass_everything_on_and_their_status_back(
    monkeypatch, capfd, tmp_path, command
):
    (tmp_path / "models").mkdir()
    (tmp_path / "models" / "__init__.py").touch()
    (tmp_path / "models" / "__main__.py").write_text(
        "import sys\nprint(sys.argv[1:])\nraise SystemExit(7)\n"
    )
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(module, "NEEDS_TRAINING", ())
    arguments = ["--out", "B", "DIR", "--epochs", "3", "--json"]
    monkeypatch.setattr(sys, "argv", ["agent-server", "gestures", command, *arguments])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 7
    assert capfd.readouterr().out.strip() == str(["gestures", command, *arguments])
