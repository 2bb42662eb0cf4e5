"""Real people: MSRC-12 and UTD-MHAD recordings whose gestures the server knows by other names.

They are for validation only; no weight that ships has seen them.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.gesture import GESTURES, IDLE
from agent_server.domain.motion import CLASSIFIED_FRAMES, RATE_HZ, SEEN_FRAMES
from agent_server.domain.skeleton import CoreJoint
from agent_server.skeleton.readers.msrc12 import read_msrc12
from agent_server.skeleton.readers.utd_mhad import read_utd_mhad
from models.data.real import core_stream, source_files
from models.evaluation.gestures import (
    THRESHOLD,
    Classify,
    Predict,
    decisions,
    probabilities_of,
    sliding_seen,
)

MSRC12 = {
    "G4": "bright",
    "G9": "loud",
    **dict.fromkeys(("G2", "G3", "G6", "G7", "G8", "G12"), IDLE),
}
UTD_MHAD = {
    "a3": "hello",
    **{f"a{n}": IDLE for n in range(12, 28) if n not in {16, 18, 19}},
}
BEFORE_TAG_FRAMES = 1.5 * RATE_HZ
"""MSRC-12 windows start this long before the tag."""


def msrc12_windows(data: Path) -> tuple[Float32, np.ndarray]:
    """Windows (N, 75, 9, 3), normalised, and their labels as indices in GESTURES.

    A window that leaves its recording is left out.

    Raises:
        InvalidInput: If the set is not there.
    """
    windows, labels = [], []
    for path in source_files(data / "msrc12", "*.csv*"):
        recording = read_msrc12(path)
        if not any(mark.tag in MSRC12 for mark in recording.marks):
            continue
        stream = core_stream(recording)
        for mark in recording.marks:
            if mark.tag not in MSRC12:
                continue
            at = int(np.searchsorted(stream.stamps_ns, mark.stamp_ns) - BEFORE_TAG_FRAMES)
            window = stream.positions[max(at, 0) : at + CLASSIFIED_FRAMES]
            if at < 0 or len(window) < CLASSIFIED_FRAMES:
                continue
            windows.append(window - window[SEEN_FRAMES - 1, CoreJoint.NAVEL])
            labels.append(GESTURES.index(MSRC12[mark.tag]))
    return np.stack(windows).astype(np.float32), np.array(labels)


def utd_mhad_streams(data: Path) -> Iterator[tuple[str, Float32]]:
    """Label and positions (T, 9, 3) of each recording with a label.

    Raises:
        InvalidInput: If the set is not there.
    """
    for path in source_files(data / "utd_mhad", "*.mat"):
        action = re.match(r"a\d+", path.name)
        label = UTD_MHAD.get(action[0]) if action else None
        if label is not None:
            yield label, core_stream(read_utd_mhad(path)).positions


def sim2real_report(classify: Classify, predict: Predict, data: Path) -> dict[str, Any]:
    """Recall of ``bright``, ``loud``, ``hello`` and ``idle`` on real people.

    MSRC-12 is judged by one window, whose gesture counts above the decision's threshold;
    UTD-MHAD by the decisions over a whole recording.
    """
    asked: list[str] = []
    given: list[str] = []
    windows, labels = msrc12_windows(data)
    rows = probabilities_of(classify, predict, windows[:, :SEEN_FRAMES])
    sure = rows.max(1) > THRESHOLD
    asked += [GESTURES[label] for label in labels]
    given += [GESTURES[c] if s else IDLE for c, s in zip(rows.argmax(1), sure, strict=True)]
    by_set = {"msrc12": len(asked)}
    for label, positions in utd_mhad_streams(data):
        seen, _ = sliding_seen(positions)
        found = decisions(probabilities_of(classify, predict, seen))
        asked.append(label)
        given.append(found[0][1] if found else IDLE)
    by_set["utd_mhad"] = len(asked) - by_set["msrc12"]
    recall = {
        name: _share([g == name for a, g in zip(asked, given, strict=True) if a == name])
        for name in ("bright", "loud", "hello", IDLE)
    }
    return {
        "balanced_accuracy": round(float(np.mean(list(recall.values()))), 4),
        "recall": recall,
        "idle_false_reactions": round(1 - recall[IDLE], 4),
        "mistaken_for": {
            name: _counts([g for a, g in zip(asked, given, strict=True) if a == name])
            for name in recall
        },
        "n": by_set,
    }


def _share(values: list[bool]) -> float:
    return round(float(np.mean(values)), 4)


def _counts(names: list[str]) -> dict[str, int]:
    return {name: names.count(name) for name in GESTURES if name in names}
