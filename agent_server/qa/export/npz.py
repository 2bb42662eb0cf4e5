"""A recording as arrays for numpy."""

from pathlib import Path
from typing import Any

import numpy as np

from agent_server.domain.motion import PREDICTED_FRAMES, SEEN_FRAMES
from agent_server.domain.skeleton import CORE_JOINT_NAMES, CORE_JOINTS
from agent_server.errors import InvalidInput
from agent_server.qa.export.content import Content, in_camera
from agent_server.skeleton.formats import get_format


def write_npz(content: Content, path: Path) -> None:
    """Write one file of arrays; stamps are int64 nanoseconds, positions metres, camera frame.

    ``skeleton_stamp_ns`` and ``skeleton_body_id`` (N), ``skeleton_joints`` (N, J, 4) with the
    confidence last, ``joint_names`` (J); ``affect_stamp_ns`` (M), ``affect`` (M, 2);
    ``decision_end_ns``, ``decision_gesture``, ``decision_outcome`` and ``decision_reaction``
    (D), ``probabilities`` (D, C), ``gesture_names`` (C); ``seen`` (D, 25, 9, 3) and
    ``predicted`` (D, 50, 9, 3) at 25 Hz, ``core_joint_names`` (9); ``label_gesture``,
    ``label_onset_ns``, ``label_offset_ns``, ``label_expected`` and ``label_quiet`` (L).

    Raises:
        InvalidInput: If bodies of several formats are mixed, or the file cannot be written.
    """
    formats = sorted({frame.format for frame in content.frames})
    if len(formats) > 1:
        raise InvalidInput(
            f"{content.path} mixes skeletons of {' and '.join(formats)}, which fit no one array: "
            "export it with --csv",
            field="format",
        )
    decisions = [sight.decision for sight in content.sights]
    names = list(decisions[0].probabilities) if decisions else []
    probabilities = [list(d.probabilities.values()) for d in decisions]
    seen = [sight.window.positions for sight in content.sights]
    predicted = [sight.forecast.positions for sight in content.sights]
    arrays: dict[str, Any] = {
        "skeleton_stamp_ns": np.array([f.originating_ns for f in content.frames], np.int64),
        "skeleton_body_id": np.array([f.body_id for f in content.frames], np.int64),
        "skeleton_joints": np.stack([in_camera(f) for f in content.frames]),
        "joint_names": np.array(get_format(formats[0]).names),
        "affect_stamp_ns": np.array([a.originating_ns for a in content.affect], np.int64),
        "affect": np.array([(a.valence, a.arousal) for a in content.affect], float).reshape(-1, 2),
        "decision_end_ns": np.array([d.end_ns for d in decisions], np.int64),
        "decision_gesture": np.array([d.gesture for d in decisions], str),
        "decision_outcome": np.array([d.outcome.value for d in decisions], str),
        "decision_reaction": np.array(
            ["" if d.command is None else d.command.reaction for d in decisions], str
        ),
        "probabilities": np.array(probabilities, float).reshape(-1, len(names)),
        "gesture_names": np.array(names, str),
        "seen": np.array(seen, np.float32).reshape(-1, SEEN_FRAMES, CORE_JOINTS, 3),
        "predicted": np.array(predicted, np.float32).reshape(-1, PREDICTED_FRAMES, CORE_JOINTS, 3),
        "core_joint_names": np.array(CORE_JOINT_NAMES),
        "label_gesture": np.array([label.gesture for label in content.labels], str),
        "label_onset_ns": np.array([label.onset_ns for label in content.labels], np.int64),
        "label_offset_ns": np.array([label.offset_ns for label in content.labels], np.int64),
        "label_expected": np.array([label.expected or "" for label in content.labels], str),
        "label_quiet": np.array([label.quiet for label in content.labels], bool),
    }
    try:
        with path.open("wb") as file:
            np.savez_compressed(file, allow_pickle=False, **arrays)
    except OSError as error:
        raise InvalidInput(f"{path} cannot be written: {error.strerror or error}") from error
