"""Real Kinect recordings of real people go through the server."""

import asyncio
import json
import os
from pathlib import Path

import pytest
from typer.testing import CliRunner

from agent_server.cli.main import app
from agent_server.client.once import send_paced
from agent_server.protocol import messages as m
from agent_server.recording.reader import open_recording
from agent_server.service.loading import load_models
from tests.support.live import all_decisions, live

DATA = Path(os.environ.get("AGENT_SERVER_DATA", "nowhere")) / "msrc12"
GOGGLES, HAD_ENOUGH = "P1_1_4_p19.csv.gz", "P1_1_9_p19.csv.gz"
pytestmark = pytest.mark.skipif(
    not (DATA / GOGGLES).exists(), reason="AGENT_SERVER_DATA has no msrc12"
)


def converted(tmp_path, name):
    out = tmp_path / f"{name.partition('.')[0]}.mcap"
    arguments = ["convert", "--from", "msrc12", "--affect", "-6", "5", DATA / name, out]
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert result.exit_code == 0, result.output
    return out


@pytest.mark.parametrize(("name", "gesture"), [(GOGGLES, "bright"), (HAD_ENOUGH, "loud")])
def test_a_real_recording_is_replayed_with_its_labels(tmp_path, name, gesture):
    path = converted(tmp_path, name)
    recording = open_recording(path)
    labels = [label for label in recording.labels() if label.gesture == gesture]
    assert len(labels) >= 5
    result = CliRunner().invoke(app, ["replay", str(path), "--json"])
    decisions = [json.loads(line) for line in result.stdout.splitlines()]
    # Five a second, as long as somebody is tracked.
    assert len(decisions) > 4 * recording.summary.duration_s
    assert all(decision["forecast"] == "ma_wgan_server" for decision in decisions)
    assert not any("mirrored" in decision["quality"]["warnings"] for decision in decisions)


async def test_a_real_recording_goes_through_a_live_server(tmp_path):
    path = converted(tmp_path, GOGGLES)
    events = [e for e in open_recording(path).events() if e.originating_ns < 20_000_000_000]
    watch = m.Hello(m.PROTOCOL, "t", topics=["decision"])
    async with (
        live(load_models()) as server,
        server.join("monitor", hello=watch) as monitor,
        server.join("sensor") as sensor,
    ):
        decisions = []
        listening = asyncio.create_task(all_decisions(monitor, decisions))
        await send_paced(sensor, events, 8.0)
        await asyncio.sleep(0.5)
        listening.cancel()
    assert len(decisions) > 60
    assert decisions[-1].decision.end_ns > 19e9
