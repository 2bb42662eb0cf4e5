"""An hour of a body and a face on disk: its size, its memory, and the way to any second of it.

Writer and reader run in processes of their own, so that the memory of each is its own:
``python -m agent_server.bench.recording write|read FILE MINUTES`` is what they are.
"""

import json
import random
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from itertools import cycle
from pathlib import Path

import msgspec
import numpy as np

from agent_server import __version__, assets
from agent_server.bench.figures import peak_resident_mb
from agent_server.domain.face import FaceLandmarks
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import NS_PER_S
from agent_server.errors import AgentServerError
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.reader import open_recording
from agent_server.recording.writer import RecordingWriter

RATE_HZ = 30
SEEKS = 300


@dataclass(frozen=True, slots=True)
class RecordingResult:
    """A synthetic person at 30 Hz, body (25 joints) and face (478 points), in one file.

    Attributes:
        minutes: Its length.
        size_mb: Size of the file, in millions of bytes.
        write_times_real_time: Its length by the time that writing took.
        writer_rss_mb: Most memory that the writing process ever had.
        reader_rss_mb: Most memory that the reading process ever had, the whole file read.
        open_ms: Time to open it: its index is read.
        seek_ms_p50: Time from asking for a second to its first record, once it is open, median.
        seek_ms_max: The longest of 300 such times, at random seconds.
        records: Records in it.
        chunks: Chunks in it.
    """

    minutes: float
    size_mb: float
    write_times_real_time: float
    writer_rss_mb: float | None
    reader_rss_mb: float | None
    open_ms: float
    seek_ms_p50: float
    seek_ms_max: float
    records: int
    chunks: int


def measure_recording(minutes: float) -> RecordingResult:
    """Write and read a recording of this length in a temporary folder.

    Raises:
        AgentServerError: If a process fails, for example because the disk is full.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "long.mcap"
        figures = {**_in_a_process("write", path, minutes), **_in_a_process("read", path, minutes)}
        size_mb = round(path.stat().st_size / 1e6, 1)
    return msgspec.convert({"minutes": minutes, "size_mb": size_mb, **figures}, RecordingResult)


def _in_a_process(task: str, path: Path, minutes: float) -> dict[str, float]:
    command = [sys.executable, "-m", "agent_server.bench.recording", task, str(path), str(minutes)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603
    if done.returncode:
        raise AgentServerError(f"the process that was to {task} {path} failed: {done.stderr}")
    figures: dict[str, float] = json.loads(done.stdout)
    return figures


def _write(path: Path, minutes: float) -> dict[str, float | None]:
    demo = list(open_recording(assets.demo_recording()).events())
    bodies = cycle([one for one in demo if isinstance(one, SkeletonFrame)])
    faces = cycle([one for one in demo if isinstance(one, FaceLandmarks)])
    began_s = time.perf_counter()
    with RecordingWriter(path, RecordingMetadata("bench", __version__)) as writer:
        for index in range(round(minutes * 60 * RATE_HZ)):
            stamp_ns = index * NS_PER_S // RATE_HZ
            times = (stamp_ns, stamp_ns)
            body, face = next(bodies), next(faces)
            writer.append_input(SkeletonFrame(stamp_ns, 0, body.format, body.joints), times)
            writer.append_input(
                FaceLandmarks(stamp_ns, face.layout, face.points, face.width, face.height), times
            )
    took_s = time.perf_counter() - began_s
    return {
        "write_times_real_time": round(minutes * 60 / took_s, 1),
        "writer_rss_mb": peak_resident_mb(),
    }


def _read(path: Path, minutes: float) -> dict[str, float | None]:
    began_s = time.perf_counter()
    recording = open_recording(path)
    opened_s = time.perf_counter()
    chosen = random.Random(0)  # noqa: S311 - it chooses what to measure
    seeks_ms = []
    for _ in range(SEEKS):
        second_ns = chosen.randrange(max(1, int(minutes * 60) - 1)) * NS_PER_S
        asked_s = time.perf_counter()
        next(recording.records(start_ns=second_ns, end_ns=second_ns + NS_PER_S))
        seeks_ms.append((time.perf_counter() - asked_s) * 1000)
    records = sum(1 for _ in recording)
    return {
        "open_ms": round((opened_s - began_s) * 1000, 1),
        "seek_ms_p50": round(float(np.median(seeks_ms)), 2),
        "seek_ms_max": round(max(seeks_ms), 2),
        "records": records,
        "chunks": recording.summary.chunks,
        "reader_rss_mb": peak_resident_mb(),
    }


if __name__ == "__main__":
    _task, _file, _minutes = sys.argv[1:]
    _work = {"write": _write, "read": _read}[_task]
    print(json.dumps(_work(Path(_file), float(_minutes))))  # noqa: T201 - for who has started it
