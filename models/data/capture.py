"""From a motion capture's own frame to the server's: facing the sensor, at 25 Hz."""

import numpy as np

from agent_server.domain.arrays import Float64, frozen
from agent_server.domain.motion import RATE_HZ, MotionSequence
from agent_server.domain.skeleton import CORE_JOINTS, CoreFrame
from agent_server.errors import InvalidInput
from agent_server.skeleton.resample import Resampler

DISTANCE_M = 2.5
"""Where the hips are put in front of the sensor; the recordings' own translation is dropped."""
MIN_RATE_HZ, MAX_RATE_HZ = 4, 1000
"""Slower motion has pauses that the server would not interpolate either."""


def facing_sensor(
    core: Float64, rate_hz: float, *, subject: str, label: str, source: str
) -> MotionSequence:
    """Core joints of a captured body as the sensor would see it, resampled to 25 Hz.

    Args:
        core: Shape (T, 9, 3), metres from the hips: x to the body's left, y up, z forwards.
        rate_hz: Frames a second; frames that lie on the 25 Hz grid stay as they are.
        subject: Who moves.
        label: What is shown.
        source: Name of the set.

    Raises:
        InvalidInput: If the rate is not between 4 and 1000 Hz.
    """
    if not MIN_RATE_HZ <= rate_hz <= MAX_RATE_HZ:
        raise InvalidInput(
            f"{source}, {subject}, {label}: the rate is {rate_hz:g} Hz, expected {MIN_RATE_HZ} to "
            f"{MAX_RATE_HZ}: correct it in the file",
            field="rate_hz",
            code="rate",
        )
    # Half a turn about y makes the body face the sensor: its right hand comes to larger x.
    seen = frozen(
        core * np.array([-1.0, 1.0, -1.0]) + [0.0, 0.0, DISTANCE_M], (None, CORE_JOINTS, 3)
    )
    sure = frozen(np.ones(CORE_JOINTS), (CORE_JOINTS,))
    resampler = Resampler()
    frames = [
        frame
        for index, pose in enumerate(seen)
        for frame in resampler.push(CoreFrame(round(index * 1e9 / rate_hz), 0, pose, sure))
    ]
    return MotionSequence(
        positions=frozen(np.stack([f.positions for f in frames]), (None, CORE_JOINTS, 3)),
        confidence=frozen(np.stack([f.confidence for f in frames]), (None, CORE_JOINTS)),
        rate_hz=RATE_HZ,
        subject=subject,
        label=label,
        source=source,
    )
