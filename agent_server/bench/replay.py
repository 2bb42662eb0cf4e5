"""How fast a recording is replayed, and whether each replay comes to the same bytes."""

import hashlib
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from agent_server.config import Settings
from agent_server.recording.reader import open_recording
from agent_server.recording.topics import FACE, SKELETON
from agent_server.scene.rulebook import Rules
from agent_server.service.core import Core
from agent_server.service.models import Models
from agent_server.service.replay import log_line, replay


@dataclass(frozen=True, slots=True)
class ReplayResult:
    """Replays of one recording, from the file to the lines of the decision log, on one thread.

    Attributes:
        times_real_time: Recorded time by the time that a replay takes, median of the runs.
        times_real_time_cpu: The same by the processor time alone, which counts no waiting for a
            processor that others use.
        best_times_real_time: The fastest run.
        recorded_s: Length of the recording.
        frames: Skeleton frames in it.
        faces: Faces in it.
        decisions: Decisions on it.
        runs: How often it was replayed after a first time, which warms up.
        identical: Runs whose decision log is that of the first time, byte for byte.
        log_sha256: Hash of the log.
    """

    times_real_time: float
    times_real_time_cpu: float
    best_times_real_time: float
    recorded_s: float
    frames: int
    faces: int
    decisions: int
    runs: int
    identical: int
    log_sha256: str


def measure_replay(
    path: Path, settings: Settings, models: Models, rules: Rules, runs: int
) -> ReplayResult:
    """Replay a recording again and again.

    Raises:
        RecordingError: If it cannot be read.
    """
    recording = open_recording(path)
    logs: list[str] = []
    walls: list[float] = []
    processors: list[float] = []
    decisions = 0
    for _ in range(runs + 1):
        wall, processor = time.perf_counter(), time.process_time()
        core = Core(recording.metadata.session, settings, rules, models)
        lines = [log_line(decision) for decision in replay(recording, core, models)]
        walls.append(time.perf_counter() - wall)
        processors.append(time.process_time() - processor)
        logs.append(hashlib.sha256(b"\n".join(lines)).hexdigest())
        decisions = len(lines)
    recorded_s = recording.summary.duration_s
    topics = recording.summary.topics
    return ReplayResult(
        times_real_time=round(recorded_s / float(np.median(walls[1:])), 1),
        times_real_time_cpu=round(recorded_s / float(np.median(processors[1:])), 1),
        best_times_real_time=round(recorded_s / min(walls[1:]), 1),
        recorded_s=round(recorded_s, 1),
        frames=topics.get(SKELETON.name, 0),
        faces=topics.get(FACE.name, 0),
        decisions=decisions,
        runs=runs,
        identical=sum(one == logs[0] for one in logs[1:]),
        log_sha256=logs[0],
    )
