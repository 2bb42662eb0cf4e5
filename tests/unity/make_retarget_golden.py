"""Write the poses with which the C# retargeting is held to the Python one.

    python -m tests.unity.make_retarget_golden

Each line of the file is 27 coordinates (nine joints in the camera frame, metres), nine confidences
and 44 numbers (eleven quaternions x, y, z, w), separated by spaces. A line goes on from the
rotations of the line before; a joint whose confidence is 0 is lost.
"""

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.skeleton.humanoid import REST_ROTATIONS, human_rotations
from tests.unity.build import BRIDGE

GOLDEN = BRIDGE / "Tests/EditMode/retarget_golden.txt"
LINES = 200
LOST_SHARE = 0.05
SEED = 20240501

# A person of 1.70 m who faces a sensor two metres away, arms hanging; the camera frame.
_STANDING = np.array(
    [
        *((0.0, 0.70, 2.0), (0.0, 0.45, 2.0), (0.0, 0.15, 2.0)),
        *((-0.17, 0.40, 2.0), (-0.20, 0.10, 2.02), (-0.20, -0.14, 1.95)),
        *((0.17, 0.40, 2.0), (0.20, 0.10, 2.02), (0.20, -0.14, 1.95)),
    ]
)
_SCATTER_M = np.array([0.04, 0.02, 0.02, 0.05, 0.25, 0.4, 0.05, 0.25, 0.4])[:, None]


def lines() -> list[Float64]:
    """The numbers of each line, shape (80,)."""
    generator = np.random.default_rng(SEED)
    previous = REST_ROTATIONS
    made = []
    for _ in range(LINES):
        # Rounded first, so that both sides start from the same numbers.
        positions = np.round(_STANDING + _SCATTER_M * generator.normal(size=(9, 3)), 4)
        angle = generator.uniform(-np.pi, np.pi)
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        positions[:, [0, 2]] = np.round((positions[:, [0, 2]] - (0, 2)) @ turn + (0, 2), 4)
        confidence = (generator.random(9) >= LOST_SHARE).astype(float)
        seen = np.where(confidence[:, None] > 0, positions, np.nan).astype(np.float32)
        previous = human_rotations(seen, previous)
        made.append(np.concatenate([positions.ravel(), confidence, previous.ravel()]))
    return made


def text() -> str:
    """The golden file."""
    return "".join(" ".join(f"{number:.6g}" for number in line) + "\n" for line in lines())


if __name__ == "__main__":
    GOLDEN.write_text(text())
