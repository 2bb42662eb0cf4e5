"""Gestures that anybody can name from one number: a hand goes up, stays up, and comes down.

A hand rises by 25 mm a frame for 20 frames. The classifier looks at the last frame of a window
only, and the predictor lets rising hands rise on: it knows what is coming long before a held frame
does.
"""

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.gesture import IDLE
from agent_server.domain.skeleton import CoreJoint
from models.data.windows import Recording, Stretch

CLASSES = ("wave", "point", IDLE)
HANDS = {"wave": CoreJoint.RIGHT_WRIST, "point": CoreJoint.LEFT_WRIST}
STEP = 0.025
RISE_FRAMES = 20
NAMED_FROM = 0.31
"""A hand higher than this is a gesture: that of the 13th frame of the rise is the first."""
SURE = 0.9


def raised(
    gesture: str, onset: int = 60, lasts: int = 100, frames: int = 260, person: str = "v01"
) -> Recording:
    """A recording of one gesture, ``lasts`` frames long; its onset frame is still at rest."""
    at = np.arange(frames) - onset
    height = STEP * np.clip(np.minimum(at, lasts - at), 0, RISE_FRAMES)
    motion = np.zeros((frames, 9, 3), np.float32)
    motion[:, HANDS[gesture], 1] = height
    return Recording(motion, motion, (Stretch(gesture, onset, onset + lasts),), person)


def resting(frames: int = 260, person: str = "v01") -> Recording:
    """A recording in which nothing happens."""
    motion = np.zeros((frames, 9, 3), np.float32)
    return Recording(motion, motion, (), person)


def moving_on(seen: Float32) -> Float32:
    """The future in which what rises goes on rising, and all else stays where it is."""
    steps = np.arange(1, 51, dtype=np.float32)[None, :, None, None]
    future: Float32 = seen[:, -1:] + np.maximum(seen[:, -1:] - seen[:, -2:-1], 0) * steps
    return future


def by_last_frame(motion: Float32) -> Float32:
    """Probabilities (B, 3) of CLASSES, from the hands at the end of the windows."""
    rows = np.full((len(motion), len(CLASSES)), (1 - SURE) / 2, np.float32)
    up = [motion[:, -1, HANDS[name], 1] > NAMED_FROM for name in CLASSES[:-1]]
    named = np.where(up[0], 0, np.where(up[1], 1, 2))
    rows[np.arange(len(motion)), named] = SURE
    return rows
