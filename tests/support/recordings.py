"""Recordings as a live session makes them, made at once: a body, a face, the core's log."""

import numpy as np

from agent_server.domain.face import FaceLandmarks, FaceLayout
from agent_server.protocol.faces import round_points
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.records import SensorChanged, WindowDone
from agent_server.recording.writer import RecordingWriter
from tests.support.bodies import frame

PERIOD_NS = 33_333_333


def write_session(path, seconds, session="s", seed=0):
    """Write a synthetic session of a body at 30 Hz and a face of 68 points at 10 Hz."""
    rng = np.random.default_rng(seed)
    face = rng.uniform(100, 300, (68, 2))
    with RecordingWriter(path, RecordingMetadata(session, "test")) as writer:
        writer.append_core(SensorChanged(0, open=True))
        for index in range(30 * seconds):
            stamp_ns = index * PERIOD_NS
            times = (stamp_ns + 4_000_000, stamp_ns + 4_200_000)
            shift = rng.normal(0, 0.004, 3)
            writer.append_input(frame(index, shift=tuple(shift)), times)
            if index % 3 == 0:
                points = round_points(face + rng.normal(0, 0.5, face.shape)).astype(np.float32)
                writer.append_input(
                    FaceLandmarks(stamp_ns, FaceLayout.DLIB68, points, 640, 480), times
                )
            if index >= 30 and index % 6 == 0:
                writer.append_core(WindowDone(stamp_ns, (index - 30) // 6))
    return path
