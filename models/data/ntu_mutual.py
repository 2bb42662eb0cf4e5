"""The mutual actions of NTU RGB+D 120: 26 things that two people do, Kinect v2 at 30 Hz.

Liu et al., "NTU RGB+D 120: A Large-Scale Benchmark for 3D Human Activity Understanding" (TPAMI
2019), with the set's own cross-subject split. The ``.skeleton`` files lie anywhere below ``ntu/``;
those of other actions are passed over. For research only.
"""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.errors import InvalidInput
from agent_server.skeleton.readers.ntu import read_ntu
from models.data.interactions import Interaction, InteractionSet, Part

LABELS = {
    "A050": "punching",
    "A051": "kicking",
    "A052": "pushing",
    "A053": "patting on back",
    "A054": "pointing finger",
    "A055": "hugging",
    "A056": "giving object",
    "A057": "touching pocket",
    "A058": "shaking hands",
    "A059": "walking towards",
    "A060": "walking apart",
    "A106": "hitting with object",
    "A107": "wielding knife",
    "A108": "knocking over",
    "A109": "grabbing stuff",
    "A110": "shooting with gun",
    "A111": "stepping on foot",
    "A112": "high five",
    "A113": "cheers and drink",
    "A114": "carrying object",
    "A115": "taking photo",
    "A116": "following",
    "A117": "whispering",
    "A118": "exchanging things",
    "A119": "supporting somebody",
    "A120": "rock paper scissors",
}
TRAINING_SUBJECTS = frozenset(
    (
        *(1, 2, 4, 5, 8, 9, 13, 14, 15, 16, 17, 18, 19, 25, 27, 28, 31, 34, 35, 38),
        *(45, 46, 47, 49, 50, 52, 53, 54, 55, 56, 57, 58, 59, 70, 74, 78),
        *(80, 81, 82, 83, 84, 85, 86, 89, 91, 92, 93, 94, 95, 97, 98, 100, 103),
    )
)
"""The 53 of 106 performers of the set's cross-subject training split."""
ORDER = (3, 20, 1, 4, 5, 6, 8, 9, 10, 12, 13, 14, 16, 17, 18)
"""Our joints among Kinect v2's 25: a torso is the middle of the spine, a hand a wrist, a foot an
ankle."""
LEAST_FRAMES = 10


class MutualSet(InteractionSet):
    """The set; it is split by performers and has no lists of files."""

    __slots__ = ()

    def read(self, data: Path, part: Part) -> list[Interaction]:
        """The interactions of one of the cross-subject splits, in the order of their names.

        Raises:
            InvalidInput: If there are none, or a file is none of the set.
        """
        read, dropped = self.read_counted(data, part)
        if not read:
            raise InvalidInput(
                f"{data / self.folder} holds no {part} interaction of two people (left out: "
                f"{dict(dropped) or 'nothing'}): give as --data the folder that holds ntu/ with "
                "the .skeleton files of A050-A060 and A106-A120",
                field="data",
            )
        return read

    def read_counted(self, data: Path, part: Part) -> tuple[list[Interaction], Counter[str]]:
        """The same, and why how many recordings were left out.

        Kinect loses people: ``one_person`` counts recordings that never show two at once,
        ``short`` those that show them in fewer than ten frames.
        """
        read: list[Interaction] = []
        dropped: Counter[str] = Counter()
        for path in self._files(data / self.folder, part):
            people = two_people(path)
            if people is None:
                dropped["one_person"] += 1
            elif len(people[0]) < LEAST_FRAMES:
                dropped["short"] += 1
            else:
                first, second = (person[:: self.every] for person in people)
                label = self.label_of((path.stem[-4:],))
                read.append(Interaction(path.stem, path.stem[8:12], label, first, second))
        return read, dropped

    def _files(self, root: Path, part: Part) -> Iterator[Path]:
        for path in sorted(root.rglob("S???C???P???R???A???.skeleton")):
            is_training = int(path.stem[9:12]) in TRAINING_SUBJECTS
            if path.stem[-4:] in LABELS and is_training == (part == "train"):
                yield path


def two_people(path: Path) -> tuple[Float32, Float32] | None:
    """The two bodies that are seen longest, each of shape (T, 15, 3), metres, camera frame.

    T goes from the first frame with both to the last one; a body that is not seen in between
    keeps its last pose. None where no frame has two bodies.
    """
    tracks: dict[int, dict[int, Float32]] = {}
    for frame in read_ntu(path).frames:
        joints = frame.joints[list(ORDER), :3]
        tracks.setdefault(frame.body_id, {})[frame.originating_ns] = joints
    if len(tracks) < 2:
        return None
    longest = sorted(tracks, key=lambda body: -len(tracks[body]))[:2]
    first, second = (tracks[body] for body in longest)
    together = sorted(first.keys() & second.keys())
    if not together:
        return None
    times = [at for at in sorted(first.keys() | second.keys()) if together[0] <= at <= together[-1]]
    return _held(first, times), _held(second, times)


def _held(track: dict[int, Float32], times: list[int]) -> Float32:
    poses: list[Float32] = []
    for at in times:
        poses.append(track[at] if at in track else poses[-1])
    return np.stack(poses)


NTU_MUTUAL = MutualSet(
    "ntu",
    "ntu",
    30,
    1,
    tuple(LABELS.values()),
    ORDER,
    lambda parts: LABELS[parts[0]],
    tuple(LABELS.values()),
)
