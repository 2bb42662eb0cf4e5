"""Which joints a model of a data set predicts, how they mirror, and which bones join them."""

from dataclasses import dataclass

from agent_server.domain.skeleton import CORE_BONES, CoreJoint
from agent_server.inference.manifest import SkeletonName


@dataclass(frozen=True, slots=True)
class Layout:
    """A choice among the joints of a data set.

    Attributes:
        name: Name of the layout.
        joints: Indices among the joints of the data set.
        mirror: For each chosen joint, the place of its counterpart among the chosen ones; a
            mirrored body has its x negated and its joints taken in this order.
        bones: Pairs (parent, child) of places among the chosen joints.
    """

    name: SkeletonName
    joints: tuple[int, ...]
    mirror: tuple[int, ...]
    bones: tuple[tuple[int, int], ...]

    @property
    def coordinates(self) -> int:
        """Numbers a pose."""
        return 3 * len(self.joints)


def _layout(
    name: SkeletonName,
    joints: tuple[int, ...],
    pairs: dict[int, int],
    bones: tuple[tuple[int, int], ...],
) -> Layout:
    """A layout from pairs and bones in the data set's own indices."""
    place = {joint: at for at, joint in enumerate(joints)}
    both = {**pairs, **{right: left for left, right in pairs.items()}}
    return Layout(
        name,
        joints,
        tuple(place[both.get(joint, joint)] for joint in joints),
        tuple((place[parent], place[child]) for parent, child in bones),
    )


H36M = _layout(
    "h36m22",
    (2, 3, 4, 5, 7, 8, 9, 10, 12, 13, 14, 15, 17, 18, 19, 21, 22, 25, 26, 27, 29, 30),
    {
        **{2: 7, 3: 8, 4: 9, 5: 10},
        **{17: 25, 18: 26, 19: 27, 21: 29, 22: 30},
    },
    (
        *((2, 3), (3, 4), (4, 5), (7, 8), (8, 9), (9, 10)),
        *((12, 13), (13, 14), (14, 15)),
        *((13, 17), (17, 18), (18, 19), (19, 21), (19, 22)),
        *((13, 25), (25, 26), (26, 27), (27, 29), (27, 30)),
    ),
)
"""The 22 joints of Human3.6M that siMLPe predicts; the other ten stand still or are copies."""

CMU = _layout(
    "cmu25",
    (
        *(3, 4, 5, 6, 9, 10, 11, 12, 14, 15, 17, 18, 19),
        *(21, 22, 23, 25, 26, 28, 30, 31, 32, 34, 35, 37),
    ),
    {
        **{3: 9, 4: 10, 5: 11, 6: 12},
        **{21: 30, 22: 31, 23: 32, 25: 34, 26: 35, 28: 37},
    },
    (
        *((3, 4), (4, 5), (5, 6), (9, 10), (10, 11), (11, 12)),
        *((14, 15), (15, 17), (17, 18), (18, 19)),
        *((15, 21), (21, 22), (22, 23), (23, 25), (25, 26), (23, 28)),
        *((15, 30), (30, 31), (31, 32), (32, 34), (34, 35), (32, 37)),
    ),
)
"""The 25 of CMU's 38 joints that the literature evaluates."""

CORE = _layout(
    "core9",
    tuple(CoreJoint),
    {
        CoreJoint.LEFT_SHOULDER: CoreJoint.RIGHT_SHOULDER,
        CoreJoint.LEFT_ELBOW: CoreJoint.RIGHT_ELBOW,
        CoreJoint.LEFT_WRIST: CoreJoint.RIGHT_WRIST,
    },
    CORE_BONES,
)
"""The nine joints of the server."""

KINECT15 = _layout(
    "kinect15",
    tuple(range(15)),
    {3: 6, 4: 7, 5: 8, 9: 12, 10: 13, 11: 14},
    (
        *((0, 1), (1, 2), (1, 3), (3, 4), (4, 5), (1, 6), (6, 7), (7, 8)),
        *((2, 9), (9, 10), (10, 11), (2, 12), (12, 13), (13, 14)),
    ),
)
"""The 15 joints of SBU and K3HI: head, neck, torso, then shoulder, elbow and hand, left and right,
then hip, knee and foot, left and right."""
