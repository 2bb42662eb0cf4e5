"""The server's own protocol: nine joints, 25 frames seen, 50 predicted, every 25 frames.

CMU's test files are motion capture like part of the training; MSRC-12 is a Kinect that no shipped
weight has seen; the synthetic people are none of those trained on. Windows start at the first
tracked frame.
"""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.gesture import IDLE
from agent_server.domain.motion import CLASSIFIED_FRAMES, FRAME_NS, SEEN_FRAMES
from agent_server.domain.skeleton import CoreJoint
from agent_server.skeleton.readers.msrc12 import read_msrc12
from models.data.cmu import read_cmu
from models.data.real import core_stream, source_files
from models.data.splits import synthetic_split

STRIDE = 25
MM = np.float32(1000)


def cmu_core_windows(data: Path, cache: Path) -> dict[str, Float32]:
    """Windows (N, 75, 9, 3) of CMU's test files in mm, by action."""
    del cache  # nothing is generated
    return _by_name((motion.label or "", motion.positions) for motion in read_cmu(data, "test"))


def msrc12_core_windows(data: Path, cache: Path) -> dict[str, Float32]:
    """Windows (N, 75, 9, 3) of all MSRC-12 recordings in mm, by gesture.

    Frames go through the server's own retargeting and resampling. A pause of the sensor starts a
    new stretch, and no window reaches across.
    """
    del cache  # nothing is generated
    return _by_name(_msrc12_stretches(data))


def synthetic_core_windows(data: Path, cache: Path) -> dict[str, Float32]:
    """Windows (N, 75, 9, 3) of held-out virtual people in mm, by gesture.

    The seen frames are what the sensor gives, the future is where the joints are.
    """
    del data  # everything is generated
    windows: dict[str, list[Float32]] = {}
    for recording in synthetic_split(cache, "test"):
        clean = _windows(recording.clean)
        gesture = recording.stretches[0].gesture if recording.stretches else IDLE
        for seen, future in zip(_windows(recording.observed), clean, strict=True):
            window = np.concatenate([seen[:SEEN_FRAMES], future[SEEN_FRAMES:]])
            windows.setdefault(gesture, []).append(window)
    return _stacked(windows)


def _msrc12_stretches(data: Path) -> Iterable[tuple[str, Float32]]:
    for path in source_files(data / "msrc12", "*.csv*"):
        recording = read_msrc12(path)
        gesture = min((mark.tag for mark in recording.marks), default="untagged")
        stream = core_stream(recording.frames)
        breaks = np.flatnonzero(np.diff(stream.stamps_ns) > FRAME_NS) + 1
        for stretch in np.split(stream.positions, breaks):
            yield gesture, stretch


def _by_name(stretches: Iterable[tuple[str, Float32]]) -> dict[str, Float32]:
    windows: dict[str, list[Float32]] = {}
    for name, positions in stretches:
        windows.setdefault(name, []).extend(_windows(positions))
    return _stacked(windows)


def _windows(positions: Float32) -> list[Float32]:
    """Windows of one stretch in metres."""
    starts = range(0, len(positions) - CLASSIFIED_FRAMES + 1, STRIDE)
    return [positions[start : start + CLASSIFIED_FRAMES] for start in starts]


def _stacked(windows: dict[str, list[Float32]]) -> dict[str, Float32]:
    """In mm, with the origin at the navel of the last seen frame, as the server normalises."""
    result = {}
    for name, found in windows.items():
        if found:
            motion = np.stack(found).astype(np.float32)
            origin = motion[:, SEEN_FRAMES - 1, None, None, CoreJoint.NAVEL]
            result[name] = MM * (motion - origin)
    return result
