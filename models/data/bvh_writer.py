"""Writing BVH motion files from positions of joints.

Every joint has position channels, which take the place of its OFFSET in each frame, and no
rotations: positions alone do not tell how a bone is turned about itself. What is written is read
back by :mod:`models.data.bvh` exactly, to the six decimals of the text.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.errors import InvalidInput

CHANNELS = "CHANNELS 3 Xposition Yposition Zposition"


def write_bvh(
    path: Path, names: Sequence[str], parents: Sequence[int], positions: Float32, rate_hz: float
) -> None:
    """Write a motion.

    Args:
        path: The file.
        names: Name of each joint, J of them, without spaces.
        parents: Index of each joint's parent, -1 for the one root.
        positions: Shape (T, J, 3), in the unit and axes that the file shall have.
        rate_hz: Frames a second.

    Raises:
        InvalidInput: If the parents are no tree, or the shapes do not fit each other.
    """
    order = list(_depth_first(parents))
    if positions.ndim != 3 or positions.shape[1:] != (len(names), 3) or len(order) != len(names):
        raise InvalidInput(
            f"positions have the shape {positions.shape} and {len(order)} of the parents are a "
            f"tree: {len(names)} names ask for (T, {len(names)}, 3) and as many parents with one "
            "root",
            field="positions",
        )
    roots = np.zeros_like(positions[:, :1])
    anchors = np.concatenate([positions, roots], axis=1)[:, list(parents)]  # -1 is the last
    local = (positions - anchors)[:, order]
    rows = [" ".join(f"{value:.6f}" for value in frame.ravel()) for frame in local]
    lines = [
        "HIERARCHY",
        *_joint(names, parents, positions[0] - anchors[0], order[0], 0),
        "MOTION",
        f"Frames: {len(rows)}",
        f"Frame Time: {1 / rate_hz:.8f}",
        *rows,
    ]
    path.write_text("\n".join(lines) + "\n")


def _depth_first(parents: Sequence[int], at: int = -1) -> Iterator[int]:
    """Joints in the order in which a file lists them."""
    for joint, parent in enumerate(parents):
        if parent == at:
            yield joint
            yield from _depth_first(parents, joint)


def _joint(
    names: Sequence[str], parents: Sequence[int], offsets: Float32, joint: int, depth: int
) -> Iterator[str]:
    indent = "  " * depth
    # A root's channels are added to its OFFSET, so that is zero.
    offset = offsets[joint] if depth else np.zeros(3)
    yield f"{indent}{'JOINT' if depth else 'ROOT'} {names[joint]}"
    yield f"{indent}{{"
    yield f"{indent}  OFFSET " + " ".join(f"{value:.6f}" for value in offset)
    yield f"{indent}  {CHANNELS}"
    children = [each for each, parent in enumerate(parents) if parent == joint]
    for child in children:
        yield from _joint(names, parents, offsets, child, depth + 1)
    if not children:
        yield f"{indent}  End Site"
        yield f"{indent}  {{"
        yield f"{indent}    OFFSET 0.000000 0.000000 0.000000"
        yield f"{indent}  }}"
    yield f"{indent}}}"
