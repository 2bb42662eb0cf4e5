"""The sample room on the stand-in of the engine, with a real server and a recorded person."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

from agent_server.skeleton.readers.kinect_json import read_kinect_json
from tests.unity.build import compiled, core, needs_mono, run, sources
from tests.unity.test_unity_compiles import editor, engine, unity

LIVE = Path(__file__).parent / "live"


@needs_mono
def test_the_first_command_of_the_demo_is_carried_out(tmp_path: Path):
    telemetry, skeletons = tmp_path / "telemetry.jsonl", tmp_path / "skeletons.jsonl"
    references = (core(), unity(), editor(), *engine())
    program = compiled("LiveRoom.exe", sources(LIVE), references)
    start = "from agent_server.cli.main import main; main()"
    command = [sys.executable, "-c", start, "demo", "--no-browser", "--port", "0"]
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as demo:
        try:
            assert demo.stdout is not None
            address = re.search(r"http://([\d.]+:\d+)", demo.stdout.readline())
            assert address is not None
            lines = list(run(program, f"ws://{address[1]}", str(telemetry), str(skeletons)))
        finally:
            demo.terminate()
            demo.communicate(timeout=20)
    assert "last word Done" in lines
    assert any(line.startswith("command ") for line in lines)
    assert "person shown" in lines
    poses, forecasts = map(int, re.findall(r"\d+", next(x for x in lines if x.startswith("poses"))))
    assert poses > 25
    assert forecasts > 5
    kinds = {json.loads(line)["type"] for line in telemetry.read_text().splitlines()}
    assert kinds >= {"pose", "forecast", "decision"}
    track = read_kinect_json(skeletons)
    assert track.format == "core9"
    assert len(track.frames) > 25
    assert not [line for line in lines if line.startswith("error")], lines
