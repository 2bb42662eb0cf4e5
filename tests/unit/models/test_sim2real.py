import os
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="needs the train extra")

from agent_server.domain.gesture import GESTURES
from agent_server.errors import InvalidInput
from agent_server.skeleton.readers.source import SourceRecording, single_body
from models.data.real import core_stream
from models.evaluation.sim2real import (
    msrc12_windows,
    sim2real_report,
    utd_mhad_streams,
)

DATA = os.environ.get("AGENT_SERVER_DATA")


def recording(frames: int) -> SourceRecording:
    joints = np.ones((frames, 20, 4), dtype=np.float32)
    stamps = [index * 33_333_333 for index in range(frames)]
    return SourceRecording("kinect_v1", "p01", single_body(stamps, joints, "kinect_v1"), (), {})


def test_a_recording_becomes_a_stream_at_25_hz() -> None:
    stream = core_stream(recording(61).frames)
    assert stream.positions.shape == (50, 9, 3)
    assert set(np.diff(stream.stamps_ns)) == {40_000_000}
    assert core_stream(recording(0).frames).positions.shape == (0, 9, 3)


def test_a_missing_set_is_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="msrc12"):
        msrc12_windows(tmp_path)
    with pytest.raises(InvalidInput, match="utd_mhad"):
        next(utd_mhad_streams(tmp_path))


def test_the_report_counts_by_label(monkeypatch: pytest.MonkeyPatch) -> None:
    def windows(data: Path) -> tuple[np.ndarray, list[str]]:
        return np.zeros((4, 75, 9, 3), np.float32), ["bright", "loud", "idle", "idle"]

    monkeypatch.setattr("models.evaluation.sim2real.msrc12_windows", windows)
    monkeypatch.setattr(
        "models.evaluation.sim2real.utd_mhad_streams",
        lambda data: iter([("hello", np.zeros((60, 9, 3), np.float32))]),
    )

    def always_loud(motion: np.ndarray) -> np.ndarray:
        return np.eye(len(GESTURES), dtype=np.float32)[[GESTURES.index("loud")] * len(motion)]

    report = sim2real_report(always_loud, lambda seen: np.repeat(seen[:, -1:], 50, 1), Path())
    assert report["recall"] == {"bright": 0.0, "loud": 1.0, "hello": 0.0, "idle": 0.0}
    assert report["balanced_accuracy"] == 0.25
    assert report["idle_false_reactions"] == 1.0
    assert report["n"] == {"msrc12": 4, "utd_mhad": 1}


def test_each_reading_has_its_own_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    windows = np.zeros((2, 75, 9, 3), np.float32)
    windows[0, 40:] = 1.0  # what shows that it is bright lies after the seen second
    monkeypatch.setattr(
        "models.evaluation.sim2real.msrc12_windows", lambda data: (windows, ["bright", "loud"])
    )
    monkeypatch.setattr(
        "models.evaluation.sim2real.utd_mhad_streams",
        lambda data: iter([(name, np.zeros((60, 9, 3), np.float32)) for name in ("hello", "idle")]),
    )

    def bright_if_moved(motion: np.ndarray) -> np.ndarray:
        moved = np.abs(motion).max(axis=(1, 2, 3)) > 0
        at = np.where(moved, GESTURES.index("bright"), GESTURES.index("idle"))
        return np.eye(len(GESTURES), dtype=np.float32)[at]

    report = sim2real_report(bright_if_moved, lambda seen: np.repeat(seen[:, -1:], 50, 1), Path())
    recalls = {name: row["recall"]["bright"] for name, row in report["readings"].items()}
    assert recalls == {"3s": 1.0, "1s+2s_predicted": 0.0, "live": 1.0}
    assert report["recall"] == report["readings"]["3s"]["recall"]


@pytest.mark.skipif(DATA is None, reason="needs utd_mhad (AGENT_SERVER_DATA)")
def test_real_recordings_are_read() -> None:
    assert DATA is not None
    label, positions = next(utd_mhad_streams(Path(DATA)))
    assert label in GESTURES
    assert positions.shape[1:] == (9, 3)
    assert np.isfinite(positions).all()
