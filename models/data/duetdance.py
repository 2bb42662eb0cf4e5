"""DuetDance: couples who dance, as the BiGraphDiff project has prepared them.

Kundu et al., "Cross-Conditioned Recurrent Networks for Long-Term Synthesis of Inter-Person Human
Motion Interactions" (WACV 2020). A file ``Skeletons/salsa/0012/skeleton_A.mat`` holds ``skel``:
45 rows, axis-major, y down, in units of the first frame's norm; ``Train.txt`` and ``Test.txt`` list
the files of both people.

What the published material does not say is taken as follows: the joints come from LCR-Net, whose
order fits the bones that the project draws and tells right from left; a trunk is half a metre
long; frames follow each other at 25 Hz.
"""

from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from models.data.interactions import InteractionSet, read_curve

ORDER = (12, 14, 13, 11, 9, 7, 10, 8, 6, 5, 3, 1, 4, 2, 0)
"""Where its files keep our joints; the torso is the middle of the hips."""
NECK, PELVIS = 1, 2
TRUNK_M = 0.5
AXES = np.array([-1.0, -1.0, 1.0])
_LABELS = ("cha-cha", "jive", "rumba", "salsa", "samba")


class DanceSet(InteractionSet):
    """The set; other than SBU's, its coordinates have a unit of their own in every recording."""

    __slots__ = ()

    def read_people(self, action: Path, reaction: Path) -> tuple[Float32, Float32]:
        """Both people of a recording, each of shape (T, 15, 3), metres, all frames."""
        first, second = (read_curve(path, self.order, "skel") for path in (action, reaction))
        trunks = [
            np.linalg.norm(person[:, NECK] - person[:, PELVIS], axis=-1)
            for person in (first, second)
        ]
        unit = TRUNK_M / max(float(np.median(np.concatenate(trunks))), 1e-9)
        return (first * AXES * unit).astype(np.float32), (second * AXES * unit).astype(np.float32)


DUETDANCE = DanceSet(
    "duetdance", "duetdance", 25, 1, _LABELS, ORDER, lambda parts: parts[0], _LABELS
)
