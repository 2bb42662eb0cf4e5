"""Faces without a camera, and an affect model without weights."""

import numpy as np

from agent_server.domain.affect import Calibration
from agent_server.domain.face import (
    ARKIT_BLENDSHAPES,
    FaceBlendshapes,
    FaceLandmarks,
    FaceLayout,
    GazeSample,
)
from agent_server.errors import InferenceError

SMILE = ARKIT_BLENDSHAPES.index("mouthSmileLeft")
FROWN = ARKIT_BLENDSHAPES.index("browDownLeft")
OPEN = ARKIT_BLENDSHAPES.index("jawOpen")

FACES = (
    FaceLandmarks(1, FaceLayout.DLIB68, np.arange(136, dtype=np.float32).reshape(68, 2), 640, 480),
    FaceBlendshapes(2, np.linspace(0, 1, 52, dtype=np.float32).round(4)),
    GazeSample(3, (0.0, 0.25, 2.0), (0.0, 0.0, -1.0)),
    Calibration(4, 2.5, None),
    Calibration(5, None, (-1.5, 0.25)),
)
"""One of everything that a sensor can say of the face."""


class ShapeReader:
    """Reads valence off a smile and a frown, arousal off an open jaw; no other shape counts.

    The feature order is ARKit's. ``sd`` follows the tongue, so that tests can make a face
    doubtful.
    """

    name = "shape_reader"
    sha256 = "2" * 64

    def __init__(self, fails=False):
        self.fails = fails

    def estimate(self, features):
        if self.fails:
            raise InferenceError("the shape reader fails, as it was told to")
        features = np.square(features)
        valence = features[:, SMILE] - features[:, FROWN]
        sd = np.full(len(features), 0.1)
        return np.stack((valence, features[:, OPEN], sd, sd), axis=1).astype(np.float32)


def shapes(stamp_ns, valence, arousal):
    """A face that the shape reader reads as given, on [-10, 10]."""
    values = np.zeros(len(ARKIT_BLENDSHAPES), dtype=np.float32)
    values[SMILE] = max(0.0, valence / 10)
    values[FROWN] = max(0.0, -valence / 10)
    values[OPEN] = arousal / 10
    values.flags.writeable = False
    return FaceBlendshapes(stamp_ns, values)
