"""Real people: MSRC-12 and UTD-MHAD recordings whose gestures the server knows by other names.

They are for validation only; no weight that ships has seen them. An MSRC-12 window lasts 3 s and
starts 1.5 s before the tag. It is read in three ways: as the 3 s that the classifier takes
(``3s``, which the figures at the top are of), as its first second with what the predictor expects
(``1s+2s_predicted``, which ends half a second before the gesture's height), and as the server
would live through it, window after window (``live``). A recording of UTD-MHAD is shorter than
3 s and is always read in the last way.
"""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.gesture import GESTURES, IDLE
from agent_server.domain.motion import SEEN_FRAMES
from agent_server.skeleton.readers.utd_mhad import read_utd_mhad
from models.data.msrc12 import TAGS, TaggedStream, read_streams, tag_windows
from models.data.real import core_stream, source_files
from models.evaluation.gestures import (
    Classify,
    Predict,
    decisions,
    named_or_idle,
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
JUDGED = ("bright", "loud", "hello", IDLE)


def msrc12_windows(data: Path) -> tuple[Float32, list[str]]:
    """Windows (N, 75, 9, 3), normalised, and what the server calls them.

    Raises:
        InvalidInput: If the set is not there.
    """
    return known_windows(read_streams(data / "msrc12"))


def known_windows(streams: Sequence[TaggedStream]) -> tuple[Float32, list[str]]:
    """The same of recordings that have been read."""
    windows = tag_windows(streams, {stream.subject for stream in streams})
    tags = [TAGS[label] for label in windows.labels.tolist()]
    index = np.flatnonzero([tag in MSRC12 for tag in tags])
    motion = windows.take(windows.starts.new_tensor(index)).all().numpy()
    return motion, [MSRC12[tags[place]] for place in index]


def utd_mhad_streams(data: Path) -> Iterator[tuple[str, Float32]]:
    """Label and positions (T, 9, 3) of each recording with a label.

    Raises:
        InvalidInput: If the set is not there.
    """
    for path in source_files(data / "utd_mhad", "*.mat"):
        action = re.match(r"a\d+", path.name)
        label = UTD_MHAD.get(action[0]) if action else None
        if label is not None:
            yield label, core_stream(read_utd_mhad(path).frames).positions


def sim2real_report(classify: Classify, predict: Predict, data: Path) -> dict[str, Any]:
    """Recall of ``bright``, ``loud``, ``hello`` and ``idle`` on real people.

    The figures of ``3s`` stand at the top, those of all readings under ``readings``.
    """
    motion, asked = msrc12_windows(data)
    expected = probabilities_of(classify, predict, motion[:, :SEEN_FRAMES])
    given = {
        "3s": named_or_idle(classify(motion)),
        "1s+2s_predicted": named_or_idle(expected),
        "live": [_decided(classify, predict, window) for window in motion],
    }
    recordings = list(utd_mhad_streams(data))
    others = [label for label, _ in recordings]
    decided = [_decided(classify, predict, positions) for _, positions in recordings]
    readings = {
        name: _figures([*asked, *others], [*names, *decided]) for name, names in given.items()
    }
    counts = {"msrc12": len(asked), "utd_mhad": len(others)}
    return {**readings["3s"], "n": counts, "readings": readings}


def _decided(classify: Classify, predict: Predict, positions: Float32) -> str:
    """The first decision on a stream (T, 9, 3), or idle."""
    seen, _ = sliding_seen(positions)
    found = decisions(probabilities_of(classify, predict, seen))
    return found[0][1] if found else IDLE


def _figures(asked: list[str], given: list[str]) -> dict[str, Any]:
    answers = {name: [g for a, g in zip(asked, given, strict=True) if a == name] for name in JUDGED}
    recall = {name: round(found.count(name) / len(found), 4) for name, found in answers.items()}
    return {
        "balanced_accuracy": round(float(np.mean(list(recall.values()))), 4),
        "recall": recall,
        "idle_false_reactions": round(1 - recall[IDLE], 4),
        "mistaken_for": {
            name: {other: found.count(other) for other in GESTURES if other in found}
            for name, found in answers.items()
        },
    }
