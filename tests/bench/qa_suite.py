"""A suite of many recordings through ``agent-server qa``, with one process and with more.

    python -m tests.bench.qa_suite --recordings 1000 --seconds 20 --jobs 1 2 --json

The recordings are synthetic and lie in a temporary folder. Some are different (``--different``),
the others are copies of them under other names, which cost a run just as much.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

from agent_server import __version__
from agent_server.protocol.inputs import input_from_message, input_to_message
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.sink import AT_ONCE
from agent_server.recording.writer import RecordingWriter
from agent_server.synthetic.scenario import Part, Scenario, play
from agent_server.synthetic.sensors import KINECT_V2

GESTURES = (
    ("hello", "beside_head"),
    ("cold", "upper_arms"),
    ("loud", "palms"),
    ("smell", "pinch"),
    ("bright", "eyes_both"),
)
FACES = ("mesh478", "blendshapes", "dlib68", "affect")


def write_recordings(folder, count, seconds, different):
    made = []
    for index in range(min(different, count)):
        gesture, variant = GESTURES[index % len(GESTURES)]
        scenario = Scenario(
            name=f"session{index:04d}",
            description="Made for a benchmark.",
            seed=1000 + index,
            sensor=KINECT_V2,
            duration_s=seconds,
            face_as=FACES[index % len(FACES)],
            parts=(Part(gesture, variant, 5.0),),
        )
        path = folder / f"{scenario.name}.mcap"
        write(scenario, path)
        made.append(path)
    for index in range(len(made), count):
        (folder / f"session{index:04d}.mcap").write_bytes(made[index % len(made)].read_bytes())


def write(scenario, path):
    session = play(scenario)
    metadata = RecordingMetadata(
        session=scenario.name,
        server_version=__version__,
        face=session.face,
        joint_format=session.format,
        origin=f"synthetic: agent_server.synthetic, seed {scenario.seed}",
    )
    with RecordingWriter(path, metadata, AT_ONCE) as writer:
        appends = [
            (label.onset_ns, partial(writer.append_label, label)) for label in session.labels
        ]
        for event in session.events:
            taken = input_from_message(input_to_message(event))
            appends.append((event.originating_ns, partial(writer.append_input, taken)))
        for _, append in sorted(appends, key=lambda item: item[0]):
            append()


def run(folder, jobs):
    """Wall time, and processor time of all processes, of one run."""
    line = [sys.executable, "-m", "agent_server", "qa", folder, "--jobs", str(jobs), "--json"]
    before, began = os.times(), time.perf_counter()
    done = subprocess.run(line, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
    wall_s = time.perf_counter() - began
    after = os.times()
    cases = json.loads(done.stdout)["cases"]
    assert all(case["status"] in ("passed", "failed") for case in cases)
    return {
        "jobs": jobs,
        "wall_s": round(wall_s, 1),
        "cpu_s": round(
            after.children_user + after.children_system
            - before.children_user - before.children_system, 1
        ),
        "recordings_per_s": round(len(cases) / wall_s, 2),
    }  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--recordings", type=int, default=100)
    parser.add_argument("--different", type=int, default=40)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--jobs", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_recordings(folder, arguments.recordings, arguments.seconds, arguments.different)
        load = os.getloadavg()[0]
        runs = [run(folder, jobs) for jobs in arguments.jobs]
    result = {
        "recordings": arguments.recordings,
        "different": min(arguments.different, arguments.recordings),
        "seconds_each": arguments.seconds,
        "data": "synthetic",
        "cores": os.cpu_count(),
        "load_before": round(load, 1),
        "runs": runs,
        "speed_up": round(runs[0]["wall_s"] / runs[-1]["wall_s"], 2),
    }
    print(json.dumps(result, indent=None if arguments.json else 2))  # noqa: T201


if __name__ == "__main__":
    main()
