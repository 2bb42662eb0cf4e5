"""Faces: landmarks, blendshapes and gaze as a sensor sends them or the face pipeline finds them.

Landmarks are in pixels of an image of known size: x to the right, y down. A mesh has a depth
too, in the same unit and smaller towards the camera, relative to the head's centre.
"""

from dataclasses import dataclass
from enum import StrEnum

from agent_server.domain.arrays import Float32

ARKIT_BLENDSHAPES: tuple[str, ...] = (
    "browDownLeft", "browDownRight", "browInnerUp", "browOuterUpLeft", "browOuterUpRight",
    "cheekPuff", "cheekSquintLeft", "cheekSquintRight", "eyeBlinkLeft", "eyeBlinkRight",
    "eyeLookDownLeft", "eyeLookDownRight", "eyeLookInLeft", "eyeLookInRight",
    "eyeLookOutLeft", "eyeLookOutRight", "eyeLookUpLeft", "eyeLookUpRight",
    "eyeSquintLeft", "eyeSquintRight", "eyeWideLeft", "eyeWideRight",
    "jawForward", "jawLeft", "jawOpen", "jawRight",
    "mouthClose", "mouthDimpleLeft", "mouthDimpleRight", "mouthFrownLeft", "mouthFrownRight",
    "mouthFunnel", "mouthLeft", "mouthLowerDownLeft", "mouthLowerDownRight",
    "mouthPressLeft", "mouthPressRight", "mouthPucker", "mouthRight", "mouthRollLower",
    "mouthRollUpper", "mouthShrugLower", "mouthShrugUpper", "mouthSmileLeft",
    "mouthSmileRight", "mouthStretchLeft", "mouthStretchRight", "mouthUpperUpLeft",
    "mouthUpperUpRight", "noseSneerLeft", "noseSneerRight", "tongueOut",
)  # fmt: skip
"""The 52 expression coefficients of Apple's ARKit, in the order of every array of them:
alphabetical, as the mesh's own blendshape network has them, and the tongue, which it lacks."""


class FaceLayout(StrEnum):
    """Which points a face has, and in which order."""

    MESH478 = "mesh478"
    MESH468 = "mesh468"
    DLIB68 = "dlib68"

    @property
    def points(self) -> int:
        """Number of points."""
        return {"mesh478": 478, "mesh468": 468, "dlib68": 68}[self.value]

    @property
    def axes(self) -> int:
        """3 for a mesh, 2 for points without depth."""
        return 2 if self is FaceLayout.DLIB68 else 3


@dataclass(frozen=True, slots=True)
class FaceLandmarks:
    """The points of one face at one instant.

    Attributes:
        originating_ns: Capture time.
        layout: Which points.
        points: Shape (N, 2 or 3) as the layout has them, read-only, in pixels.
        width: Width of the image in pixels.
        height: Height of the image in pixels.
    """

    originating_ns: int
    layout: FaceLayout
    points: Float32
    width: int
    height: int


@dataclass(frozen=True, slots=True)
class FaceBlendshapes:
    """The expression of one face at one instant.

    Attributes:
        originating_ns: Capture time.
        values: Shape (52,), read-only, in [0, 1], in the order of ``ARKIT_BLENDSHAPES``.
    """

    originating_ns: int
    values: Float32


Face = FaceLandmarks | FaceBlendshapes


@dataclass(frozen=True, slots=True)
class GazeSample:
    """Where a person looks, by a headset's eye tracker.

    Attributes:
        originating_ns: Capture time.
        origin: Between the eyes: x, y, z in metres, in the frame of the skeletons.
        direction: Of the gaze, unit length, in the same frame.
    """

    originating_ns: int
    origin: tuple[float, float, float]
    direction: tuple[float, float, float]
