"""Whole recordings of real people through the live stages: what is decided on, and when.

MSRC-12's goggles count as ``bright`` and its had-enough as ``loud``; a tag marks the height of a
gesture. A decision answers a tag from 1.5 s before it to 1.5 s after it; the set's repetitions are
farther apart. Recordings of gestures that resemble none of ours show how often the agent would
react for nothing.
"""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from agent_server.config import SubjectSettings, WindowSettings
from agent_server.domain.arrays import Float32
from agent_server.domain.gesture import IDLE
from agent_server.domain.motion import Window
from agent_server.domain.stamp import NS_PER_S
from agent_server.skeleton.normalise import normalise
from agent_server.skeleton.readers.msrc12 import read_msrc12
from agent_server.skeleton.readers.source import SourceRecording
from agent_server.stages.perceive import Perception
from models.data.real import source_files
from models.evaluation.gestures import Classify, Predict, decisions, probabilities_of
from models.evaluation.sim2real import MSRC12

TOLERANCE_S = 1.5


def shipped_report(classify: Classify, predict: Predict, data: Path) -> dict[str, Any]:
    """Recall and delay of real gestures, and reactions to real motion that asks for none.

    Args:
        classify: motion (B, 75, 9, 3) -> probabilities (B, C).
        predict: seen (B, 25, 9, 3) -> future (B, 50, 9, 3).
        data: Folder that holds ``msrc12/``.

    Raises:
        InvalidInput: If the set is not there.
    """
    delays: dict[str, list[float | None]] = {}
    mistaken: dict[str, Counter[str]] = {}
    idle_s, idle_decisions = 0.0, Counter[str]()
    for recording, label in _recordings(data):
        found = _decided(recording, classify, predict)
        if label == IDLE:
            idle_s += recording.end_ns / NS_PER_S
            idle_decisions.update(gesture for _, gesture in found)
            continue
        for mark in recording.marks:
            near = [
                (at_s - mark.stamp_ns / NS_PER_S, gesture)
                for at_s, gesture in found
                if abs(at_s - mark.stamp_ns / NS_PER_S) <= TOLERANCE_S
            ]
            right = [delay for delay, gesture in near if gesture == label]
            delays.setdefault(label, []).append(right[0] if right else None)
            others = (gesture for _, gesture in near if gesture != label)
            mistaken.setdefault(label, Counter()).update(others)
    minutes = idle_s / 60
    return {
        "rows": {
            label: {
                "marks": len(all_delays),
                "recall": round(len(hits) / len(all_delays), 4),
                "delay_s_p50": round(float(np.median(hits)), 3) if hits else None,
                "mistaken_for": dict(mistaken[label]),
            }
            for label, all_delays in delays.items()
            for hits in [[delay for delay in all_delays if delay is not None]]
        },
        "idle": {
            "minutes": round(minutes, 1),
            "false_reactions": idle_decisions.total(),
            "per_10_minutes": round(10 * idle_decisions.total() / minutes, 2),
            "gestures": dict(idle_decisions),
        },
    }


def _recordings(data: Path) -> Iterator[tuple[SourceRecording, str]]:
    """Recordings of which we know what the agent ought to make; each shows one gesture."""
    for path in source_files(data / "msrc12", "*.csv*"):
        recording = read_msrc12(path)
        labels = {MSRC12.get(mark.tag) for mark in recording.marks}
        if len(labels) == 1 and (label := labels.pop()) is not None:
            yield recording, label


def _decided(
    recording: SourceRecording, classify: Classify, predict: Predict
) -> list[tuple[float, str]]:
    """Time in seconds and gesture of every decision on a recording."""
    perception = Perception(WindowSettings(), SubjectSettings())
    windows = [
        found
        for frame in recording.frames
        for found in perception.push(frame)
        if isinstance(found, Window)
    ]
    if not windows:
        return []
    seen: Float32 = normalise(np.stack([window.positions for window in windows]))[0]
    rows = probabilities_of(classify, predict, seen)
    ends = [window.end_ns for window in windows]
    return [(ends[index] / NS_PER_S, gesture) for index, gesture in decisions(rows, ends)]
