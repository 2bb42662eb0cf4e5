"""UTD-MHAD: one action of about two seconds a file, Kinect v1 at 30 Hz.

Chen, Jafari and Kehtarnavaz, "UTD-MHAD: A multimodal dataset for human action recognition
utilizing a depth camera and a wearable inertial sensor", ICIP 2015.
"""

import re
from pathlib import Path

import numpy as np

from agent_server.domain.stamp import to_ns
from agent_server.errors import InvalidInput
from agent_server.skeleton.readers.mat5 import read_mat5
from agent_server.skeleton.readers.source import (
    MAX_COORDINATE,
    Mark,
    SourceRecording,
    single_body,
)

FORMAT = "utd_mhad"
RATE_HZ = 30
JOINTS = 20
VARIABLE = "d_skel"

_NAME = re.compile(r"^(?P<action>a\d+)_(?P<subject>s\d+)_t\d+_skeleton\.mat$")


def read_utd_mhad(path: Path) -> SourceRecording:
    """Read ``aA_sS_tT_skeleton.mat``.

    The action is in the file's name only; it becomes a mark at 0 ns, for example ``a3``. The
    set has no tracking states, so every joint has confidence 1.

    Raises:
        RecordingError: If the file cannot be read.
        InvalidInput: If its name or its content is not that of the set.
    """
    name = _NAME.match(path.name)
    if name is None:
        raise InvalidInput(
            f"{path} is not named aA_sS_tT_skeleton.mat, so its action and subject are unknown",
            field="name",
            code="unknown_name",
        )
    track = read_mat5(path).get(VARIABLE)  # (20, 3, T)
    if track is None or track.ndim != 3 or track.shape[:2] != (JOINTS, 3):
        found = "nothing" if track is None else "x".join(map(str, track.shape))
        raise InvalidInput(
            f"{path}: {VARIABLE} ought to be {JOINTS} joints x 3 axes x frames, found {found}",
            field=VARIABLE,
            code="wrong_shape",
        )
    if not (np.abs(track) <= MAX_COORDINATE).all():
        raise InvalidInput(
            f"{path}: {VARIABLE} holds numbers that are not finite, or far too large",
            field=VARIABLE,
            code="not_finite",
        )
    joints = np.ones((track.shape[2], JOINTS, 4), dtype=np.float32)
    joints[:, :, :3] = track.transpose(2, 0, 1)
    stamps = [to_ns(index / RATE_HZ) for index in range(len(joints))]
    return SourceRecording(
        format=FORMAT,
        subject=f"utd_mhad_{name['subject']}",
        frames=single_body(stamps, joints, FORMAT),
        marks=(Mark(0, name["action"]),),
        dropped={},
    )
