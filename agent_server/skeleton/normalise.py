"""Between the camera frame and the frame of the models.

The models see metres with unrotated axes and the origin at the navel of the last seen frame.
"""

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import SEEN_FRAMES
from agent_server.domain.skeleton import CoreJoint


def normalise(positions: Float32) -> tuple[Float32, Float32]:
    """Move motion into the models' frame.

    Args:
        positions: Shape (..., T, 9, 3) with T >= 25, metres in the camera frame; the frame at
            index 24 is the last seen one.

    Returns:
        Positions in the models' frame, shape (..., T, 9, 3), and their origin in the camera
        frame, shape (..., 3).
    """
    origin = positions[..., SEEN_FRAMES - 1, CoreJoint.NAVEL, :]
    return positions - origin[..., None, None, :], origin


def denormalise(positions: Float32, origin: Float32) -> Float32:
    """Move motion back into the camera frame.

    Args:
        positions: Shape (..., T, 9, 3), metres in the models' frame; any frames of the motion.
        origin: Shape (..., 3), as :func:`normalise` gave it.

    Returns:
        Shape (..., T, 9, 3), metres in the camera frame.
    """
    return np.add(positions, origin[..., None, None, :])
