"""Two people's motion as a recording that Foxglove, the server and its tools open."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

import agent_server
from agent_server.domain.arrays import Float32
from agent_server.domain.label import Label
from agent_server.domain.skeleton import SkeletonFrame
from agent_server.domain.stamp import to_ns
from agent_server.recording.metadata import RecordingMetadata
from agent_server.recording.sink import AT_ONCE
from agent_server.recording.writer import RecordingWriter
from agent_server.skeleton.formats import FORMATS
from models.data.interactions import LICENCE

FORMAT = "kinect_v1"
AWAY_M = 2.5
"""From the sensor to the middle between the two, along z."""
NAMES = (
    *("head", "shoulder_center", "spine", "shoulder_left", "elbow_left", "wrist_left"),
    *("shoulder_right", "elbow_right", "wrist_right", "hip_left", "knee_left", "ankle_left"),
    *("hip_right", "knee_right", "ankle_right"),
)
"""What Kinect v1 calls our 15 joints; of its 20 the middle of the hips, hands and feet are left."""
_STAND_IN = {
    "hip_center": "spine",
    "hand_left": "wrist_left",
    "hand_right": "wrist_right",
    "foot_left": "ankle_left",
    "foot_right": "ankle_right",
}
"""Where a joint is put that is not there; its confidence is 0."""


def write_pair_recording(
    path: Path,
    people: Sequence[Float32],
    rate_hz: float,
    label: str,
    subject: str,
    description: str,
) -> None:
    """Write a motion.

    Args:
        path: The file; it must not exist.
        people: Of each person the positions (T, 15, 3), metres, in the frame of the pair.
        rate_hz: Frames a second.
        label: What they do.
        subject: Who they are, for the label.
        description: Of the recording, in a sentence.

    Raises:
        RecordingError: If the file exists or cannot be written.
    """
    metadata = RecordingMetadata(
        session=subject,
        server_version=agent_server.__version__,
        face="none",
        joint_format=FORMAT,
        description=description,
        licence=LICENCE,
        origin="generated",
    )
    bodies = [kinect_joints(positions) for positions in people]
    frames = len(bodies[0])
    with RecordingWriter(path, metadata, AT_ONCE) as writer:
        writer.append_label(Label(label, 0, to_ns((frames - 1) / rate_hz), subject, None, False))
        for at in range(frames):
            for body, joints in enumerate(bodies):
                writer.append_input(SkeletonFrame(to_ns(at / rate_hz), body, FORMAT, joints[at]))


def kinect_joints(positions: Float32) -> Float32:
    """Our joints (T, 15, 3) as Kinect v1's, (T, 20, 4) with the confidence, read-only."""
    names = FORMATS[FORMAT].names
    places = [NAMES.index(_STAND_IN.get(name, name)) for name in names]
    joints = np.ones((len(positions), len(names), 4), np.float32)
    joints[..., :3] = positions[:, places] + np.array([0.0, 0.0, AWAY_M])
    joints[:, [name in _STAND_IN for name in names], 3] = 0.0
    joints.flags.writeable = False
    return joints
