"""Where a head is and which way it faces, from its landmarks and one canonical head.

The camera is taken for a pinhole whose focal length is the width of the image (a field of view
of 53 degrees, as webcams have); the head for one of a mean size. Distances are therefore good to
about a tenth, angles to a few degrees. In a picture that was cut out of a larger one both are off.
"""

from dataclasses import dataclass
from math import asin, atan2, cos, sin

import cv2
import numpy as np
from numpy.typing import NDArray

from agent_server.domain.arrays import Float64
from agent_server.domain.face import FaceLandmarks, FaceLayout

INTER_PUPIL_M = 0.063
"""Between the pupils of the canonical head, the mean of adults."""

# fmt: off
_MESH_INDICES = np.array((
    33, 133, 362, 263,  # corners of the eyes
    168, 197, 5, 4,  # ridge of the nose
    98, 97, 2, 326, 327,  # base of the nose
    6, 195, 1, 48, 278,  # more of the nose
    10, 151, 9, 109, 338, 67, 297,  # forehead
    127, 356, 234, 454, 93, 323,  # in front of the ears
))
_DLIB68_INDICES = np.array((36, 39, 42, 45, 27, 28, 29, 30, 31, 32, 33, 34, 35))
_CANONICAL_MM = np.array((
    (-45.6, 0.3, 5.5), (-17.9, 3.1, -0.3), (17.9, 3.1, -0.3), (45.6, 0.3, 5.5),
    (0.0, -1.4, -16.8), (0.0, 11.4, -24.8), (0.0, 21.9, -34.4), (0.0, 28.3, -36.2),
    (-15.5, 35.7, -9.7), (-7.0, 37.1, -15.7), (0.0, 37.4, -17.4), (7.0, 37.1, -15.7),
    (15.5, 35.7, -9.7),
    (0.0, 5.6, -20.3), (0.0, 16.5, -29.5), (0.0, 32.9, -33.7), (-17.4, 31.1, -18.2),
    (17.4, 31.1, -18.2),
    (0.0, -41.7, -17.4), (0.0, -28.5, -19.5), (0.0, -14.9, -20.0), (-19.6, -41.4, -15.6),
    (19.6, -41.4, -15.6), (-35.9, -39.3, -8.8), (35.9, -39.3, -8.8),
    (-68.6, -0.4, 55.4), (68.6, -0.4, 55.4), (-67.9, 10.1, 61.4), (67.9, 10.1, 61.4),
    (-66.6, 21.2, 63.5), (66.6, 21.2, 63.5),
))
# fmt: on
"""Points of a face that an expression moves little: those that dlib has too come first.

x to the right as the camera sees it, y down, z away from the camera; the origin lies between the
pupils. The mean of the meshes that the face pipeline finds on the 1,032 CC0 faces of diffusionfer,
aligned rigidly, made symmetric, and scaled to ``INTER_PUPIL_M``.
"""


@dataclass(frozen=True, slots=True)
class HeadPose:
    """Pose of a head in the camera's frame: x to the right, y down, z away from the camera.

    Angles are zero for a head that looks along the camera's axis, into the camera. The head is
    first nodded, then turned, then tilted.

    Attributes:
        yaw: Turn in radians, positive towards the right of the image.
        pitch: Nod in radians, positive upwards.
        roll: Tilt in radians, positive clockwise in the image.
        translation: Of the point between the eyes: x, y, z in metres.
    """

    yaw: float
    pitch: float
    roll: float
    translation: tuple[float, float, float]

    @property
    def rotation(self) -> Float64:
        """Matrix (3, 3) from the head's axes to the camera's."""
        turn, nod, tilt = -self.yaw, -self.pitch, self.roll
        about_x = np.array(((1, 0, 0), (0, cos(nod), -sin(nod)), (0, sin(nod), cos(nod))))
        about_y = np.array(((cos(turn), 0, sin(turn)), (0, 1, 0), (-sin(turn), 0, cos(turn))))
        about_z = np.array(((cos(tilt), -sin(tilt), 0), (sin(tilt), cos(tilt), 0), (0, 0, 1)))
        rotation: Float64 = about_z @ about_y @ about_x
        return rotation


def head_pose(face: FaceLandmarks) -> HeadPose | None:
    """Pose of the head that the landmarks are of.

    Args:
        face: A mesh, whose depth is not used, or 68 points.

    Returns:
        Its pose; None where no head in front of the camera has such landmarks.
    """
    shape = canonical_points(face.layout)
    seen = face.points[pose_indices(face.layout), :2].astype(np.float64)
    focal = float(face.width)
    camera = np.array(((focal, 0, face.width / 2), (0, focal, face.height / 2), (0, 0, 1.0)))
    try:
        found, axis, translation = cv2.solvePnP(shape, seen, camera, None, flags=cv2.SOLVEPNP_SQPNP)
    except cv2.error:  # points in one place
        return None
    if not found or not translation[2, 0] > 0:
        return None
    rotation = cv2.Rodrigues(axis)[0]
    x, y, z = translation[:, 0].tolist()
    return HeadPose(
        yaw=asin(max(-1.0, min(1.0, float(rotation[2, 0])))),
        pitch=-atan2(rotation[2, 1], rotation[2, 2]),
        roll=atan2(rotation[1, 0], rotation[0, 0]),
        translation=(x, y, z),
    )


def pose_indices(layout: FaceLayout) -> NDArray[np.int64]:
    """Which points of a layout its poses are found from, (K,)."""
    return _DLIB68_INDICES if layout is FaceLayout.DLIB68 else _MESH_INDICES


def canonical_points(layout: FaceLayout) -> Float64:
    """The same points of the canonical head, (K, 3) in metres in the head's axes."""
    points: Float64 = _CANONICAL_MM[: len(pose_indices(layout))] / 1000
    return points
