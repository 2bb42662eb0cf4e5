"""Models without weights that know one gesture: both hands at the ears."""

from agent_server.domain.motion import SEEN_FRAMES
from agent_server.domain.skeleton import CoreJoint
from agent_server.inference.fake import LastFramePredictor, RuleClassifier
from agent_server.service.models import Models


def covers_ears(motion):
    """``loud`` when both wrists of the last seen frame are as high as the neck."""
    last = motion[SEEN_FRAMES - 1]
    neck = last[CoreJoint.NECK, 1]
    wrists = last[[CoreJoint.LEFT_WRIST, CoreJoint.RIGHT_WRIST], 1]
    return "loud" if (wrists > neck).all() else "idle"


def fake_models(fail_on=frozenset()):
    """A predictor that repeats the last frame and a classifier that sees covered ears."""
    return Models(LastFramePredictor(fail_on), RuleClassifier(covers_ears))
