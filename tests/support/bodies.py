"""Small bodies for tests: a person who stands still, and what they do with their hands."""

import numpy as np

from agent_server.domain.skeleton import SkeletonFrame
from agent_server.skeleton.formats import get_format

STEP_NS = 33_333_333

CORE_POSE = {
    "head": (0.0, 0.6, 2.0),
    "neck": (0.0, 0.35, 2.0),
    "navel": (0.0, 0.0, 2.0),
    "left_shoulder": (-0.18, 0.3, 2.0),
    "left_elbow": (-0.22, 0.05, 1.97),
    "left_wrist": (-0.22, -0.18, 1.9),
    "right_shoulder": (0.18, 0.3, 2.0),
    "right_elbow": (0.22, 0.05, 1.97),
    "right_wrist": (0.22, -0.18, 1.9),
}
"""Standing, facing the sensor, arms down; metres in the camera frame."""


def core_joints(hands_up=False, shift=(0.0, 0.0, 0.0), confidence=1.0):
    """Joints of the ``core9`` format, shape (9, 4)."""
    pose = dict(CORE_POSE)
    if hands_up:
        pose["left_wrist"], pose["right_wrist"] = (-0.12, 0.6, 1.95), (0.12, 0.6, 1.95)
    names = get_format("core9").names
    positions = np.array([pose[name] for name in names]) + np.array(shift)
    return np.column_stack((positions, np.full(len(names), confidence))).astype(np.float32)


def frame(index, body_id=0, **pose):
    """Frame ``index`` of a 30 Hz stream."""
    return SkeletonFrame(index * STEP_NS, body_id, "core9", core_joints(**pose))


def stream(seconds, hands_up=lambda t: False, start=0, body_id=0, **pose):
    """Frames at 30 Hz; ``hands_up`` says at which second both hands are at the ears."""
    return [
        frame(index, body_id, hands_up=hands_up(index / 30), **pose)
        for index in range(start, start + round(seconds * 30))
    ]
