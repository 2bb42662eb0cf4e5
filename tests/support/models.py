"""Models without weights that know one gesture: both hands at the ears."""

import numpy as np

from agent_server.domain.motion import PREDICTED_FRAMES, SEEN_FRAMES
from agent_server.domain.skeleton import CoreJoint
from agent_server.errors import InferenceError
from agent_server.inference.fake import LastFramePredictor, RuleClassifier
from agent_server.service.models import Models


def covers_ears(motion):
    """``loud`` when both wrists of the last seen frame are as high as the neck."""
    last = motion[SEEN_FRAMES - 1]
    neck = last[CoreJoint.NECK, 1]
    wrists = last[[CoreJoint.LEFT_WRIST, CoreJoint.RIGHT_WRIST], 1]
    return "loud" if (wrists > neck).all() else "idle"


class RisingSampler:
    """Draw k, from 1, stays as it was last seen, k times 10 cm higher; qualities are as told."""

    name = "rising_sampler"
    sha256 = "4" * 64

    def __init__(self, *quality, fails=False):
        self.quality = np.array(quality, np.float32)
        self.fails = fails
        self.asked = []

    def draw(self, seen, count):
        if self.fails:
            raise InferenceError("the sampler is broken")
        self.asked.append(count)
        drawn = np.repeat(seen[None, -1:], PREDICTED_FRAMES, axis=1).repeat(count, axis=0)
        drawn[..., 1] += 0.1 * np.arange(1, count + 1, dtype=np.float32)[:, None, None]
        return drawn, self.quality[:count]


class CalmReader:
    """Finds every face calm, whatever it is given as."""

    name = "calm_reader"
    sha256 = "3" * 64

    def estimate(self, features):
        return np.tile(np.float32((0.0, 0.0, 0.1, 0.1)), (len(features), 1))


def fake_models(fail_on=frozenset()):
    """A predictor that repeats the last frame and a classifier that sees covered ears."""
    affect = {source: CalmReader() for source in ("mesh", "points68", "blendshapes")}
    return Models(LastFramePredictor(fail_on), RuleClassifier(covers_ears), affect)
