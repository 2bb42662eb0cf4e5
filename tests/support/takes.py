"""A person in front of a sensor who does what the prompts say."""

import numpy as np

from agent_server.domain.skeleton import SkeletonFrame
from agent_server.recording.takes import Go
from tests.support.bodies import STEP_NS, core_joints

NS = 1_000_000_000
DOWN, UP = core_joints(), core_joints(hands_up=True)
RAISE_NS = 400_000_000
"""How long the hands take to go up, and to come down."""


def raised(now_ns, start_ns, hold_ns):
    """How far the hands are up, 0 to 1, when they start to rise at ``start_ns``."""
    up = np.clip((now_ns - start_ns) / RAISE_NS, 0, 1)
    down = np.clip((now_ns - start_ns - RAISE_NS - hold_ns) / RAISE_NS, 0, 1)
    return float(up - down)


def pose(share, confidence=1.0):
    """A body whose hands are up as far as ``share`` says."""
    joints = ((1 - share) * DOWN + share * UP).astype(np.float32)
    joints[:, 3] = confidence
    return joints


class Person:
    """Raises both hands ``delay_ns`` after each "go", unless told not to.

    Attributes:
        now_ns: Time of the next frame.
        cues: All that was said, with the time at which it was.
        motions: Start and end of each raising of the hands.
    """

    def __init__(self, director, delay_ns=NS // 2, hold_ns=NS // 2):
        self.director = director
        self.delay_ns, self.hold_ns = delay_ns, hold_ns
        self.now_ns = 0
        self.body_id = 7
        self.confidence = 1.0
        self.is_willing = True
        self.cues = []
        self.motions = []

    def frame(self):
        share = 0.0
        if self.motions:
            share = raised(self.now_ns, self.motions[-1][0], self.hold_ns)
        return SkeletonFrame(self.now_ns, self.body_id, "core9", pose(share, self.confidence))

    def hear(self, cues):
        for cue in cues:
            self.cues.append((self.now_ns, cue))
            if isinstance(cue, Go) and self.is_willing:
                start = self.now_ns + self.delay_ns
                self.motions.append((start, start + 2 * RAISE_NS + self.hold_ns))

    def stay(self, seconds):
        """Stand in front of the sensor."""
        for _ in range(round(seconds * NS / STEP_NS)):
            self.hear(self.director.push(self.frame()))
            self.now_ns += STEP_NS

    def leave(self, seconds, steps=10):
        """Be out of the picture; the server's clock tells of the time that passes."""
        for _ in range(steps):
            self.now_ns += round(seconds * NS / steps)
            self.hear(self.director.advance(self.now_ns))

    def until(self, kind, at_most_s=60):
        """Stand there until something is said."""
        for _ in range(round(at_most_s * NS / STEP_NS)):
            before = len(self.cues)
            self.stay(STEP_NS / NS)
            if any(isinstance(cue, kind) for _, cue in self.cues[before:]):
                return
        raise AssertionError(f"nobody said {kind.__name__}")

    def said(self, *kinds):
        """What was said of these kinds, in order."""
        return [cue for _, cue in self.cues if isinstance(cue, kinds)]
