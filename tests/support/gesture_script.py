"""Gestures that a script makes and a classifier without weights names: how high one hand is."""

import numpy as np

from agent_server.domain.gesture import GESTURES, IDLE
from agent_server.domain.motion import SEEN_FRAMES
from agent_server.domain.skeleton import CoreJoint
from agent_server.skeleton.formats import get_format
from tests.support.bodies import core_joints

HAND = CoreJoint.RIGHT_WRIST
LOWEST_M, APART_M = 0.05, 0.1
"""Height of the hand above the navel for the first gesture, and from one gesture to the next."""
SCRIPT = ("hello", "cold", "smell", "bright", "hot", "loud", "cold", "smell", "loud", "bright")
GESTURE_S = 0.2
PAUSE_EVERY, PAUSE_S = 40, 1.6
"""After so many gestures there are none for so long, and attention ends."""

_CODE = tuple(label for label in GESTURES if label != IDLE)
_HAND_JOINT = get_format("core9").names.index("right_wrist")


def named(motion):
    """The gesture of the last seen frame of a motion (75, 9, 3), by the height of the hand."""
    index = (motion[SEEN_FRAMES - 1, HAND, 1] - LOWEST_M) / APART_M
    nearest = round(float(index))
    # Between two heights the hand is on its way.
    return _CODE[nearest] if 0 <= nearest < len(_CODE) and abs(index - nearest) < 0.2 else IDLE


def joints(gesture):
    """A body of the format ``core9``, shape (9, 4), that makes a gesture."""
    body = core_joints()
    if gesture != IDLE:
        body[_HAND_JOINT, 1] = LOWEST_M + APART_M * _CODE.index(gesture)
    return body


def gesture_at(seconds):
    """What the script has at a time."""
    period_s = PAUSE_EVERY * GESTURE_S + PAUSE_S
    index = int((seconds % period_s) / GESTURE_S)
    return IDLE if index >= PAUSE_EVERY else SCRIPT[index % len(SCRIPT)]


BODIES = {label: np.round(joints(label), 3).tolist() for label in GESTURES}
"""Joints of every gesture, as a message has them."""
