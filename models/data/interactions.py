"""SBU and K3HI: recordings of two people, the first of whom acts on the second.

SBU: Yun et al., "Two-person Interaction Detection Using Body-Pose Features and Multiple Instance
Learning" (CVPR Workshops 2012), as the thesis of B. Chopin cleaned it. K3HI: Hu et al., "Efficient
Interaction Recognition through Positive Action Representation" (2013). For benchmarks only.

Both are read into one order of joints (:data:`models.data.layouts.KINECT15`) and one frame: metres
up to an offset, right-handed, y up, z from the sensor to the people.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
import torch

from agent_server.domain.arrays import Float32, Float64
from agent_server.errors import ConfigError, InvalidInput
from agent_server.skeleton.readers.mat5 import read_mat5
from models.data.layouts import KINECT15

LICENCE = "research only"
Part = Literal["train", "test"]
JOINTS = len(KINECT15.joints)
TORSO = 2
SCALE = np.array([-2.56, -1.92, 1.28])
OFFSET = np.array([1.28, 0.96, 0.0])
"""The sets' normalised units times SCALE, plus OFFSET, are metres."""
K3HI_ORDER = (0, 1, 8, 2, 4, 6, 3, 5, 7, 9, 11, 13, 10, 12, 14)
"""Where K3HI keeps our joints."""
SBU_NAMES = {
    "01": "walking",
    "02": "walking",
    "03": "kicking",
    "04": "pushing",
    "05": "shaking hands",
    "07": "exchanging",
    "08": "punching",
}
SBU_FOLDS = (
    ("s01s02", "s03s04", "s05s02", "s06s04"),
    ("s02s03", "s02s07", "s03s05", "s05s03"),
    ("s01s03", "s01s07", "s07s01", "s07s03"),
    ("s02s01", "s02s06", "s03s02", "s03s06"),
    ("s04s02", "s04s03", "s04s06", "s06s02", "s06s03"),
)
"""The set's own five folds, by the pair of people."""


@dataclass(frozen=True, slots=True)
class Interaction:
    """A recording of two people.

    Attributes:
        name: Where it comes from, ``s02s06/01/001`` or ``kicking/12``.
        group: Of SBU the pair of people, who are held out together; K3HI does not tell people,
            and names the folder of the label.
        label: What they do.
        action: Shape (T, 15, 3), metres, the person who is looked at.
        reaction: Shape (T, 15, 3), metres, the other one.
    """

    name: str
    group: str
    label: str
    action: Float32
    reaction: Float32


@dataclass(frozen=True, slots=True)
class InteractionSet:
    """A data set of interactions.

    Attributes:
        name: ``sbu`` or ``k3hi``.
        folder: Below the folder of the sets, where the lists of the splits lie.
        rate_hz: Frames a second, as they are read.
        every: Of so many frames one is read.
        labels: Class names, in order.
        order: Where the files keep our joints.
        label_of: Path of a file in parts -> its class.
        symmetric: Classes in which either person may be the first; in SBU's lists it is always
            the one who begins.
    """

    name: str
    folder: str
    rate_hz: int
    every: int
    labels: tuple[str, ...]
    order: tuple[int, ...]
    label_of: Callable[[Sequence[str]], str]
    symmetric: tuple[str, ...]

    def read(self, data: Path, part: Part) -> list[Interaction]:
        """The interactions of one of the thesis's splits.

        Args:
            data: Folder that holds the set folders.
            part: Which split.

        Raises:
            InvalidInput: If the split's list is missing or names a file that does not fit.
        """
        root = data / self.folder
        listing = root / f"{part.title()}.txt"
        if not listing.is_file():
            raise InvalidInput(
                f"{listing} is missing: give as --data the folder that holds {self.name}/",
                field="data",
            )
        rows = [line.split() for line in listing.read_text().splitlines() if line.strip()]
        return [self._read(root, *row) for row in rows]

    def read_people(self, action: Path, reaction: Path) -> tuple[Float32, Float32]:
        """Both people of a recording, each of shape (T, 15, 3), metres, all frames."""
        return read_body(action, self.order), read_body(reaction, self.order)

    def _read(self, root: Path, action: str, reaction: str) -> Interaction:
        people = self.read_people(root / action, root / reaction)
        first, second = (person[:: self.every] for person in people)
        if len(first) != len(second):
            raise InvalidInput(
                f"{root / action} has {len(first)} frames and {reaction} {len(second)}: "
                "the two people of a recording have as many"
            )
        parts = action.split("/")[1:-1]
        return Interaction("/".join(parts), parts[0], self.label_of(parts), first, second)


def read_body(path: Path, order: Sequence[int]) -> Float32:
    """The joints of one person, shape (T, 15, 3), metres.

    Raises:
        RecordingError: If the file cannot be read.
        InvalidInput: If it holds no ``curve_B`` of 45 rows.
    """
    metres: Float32 = (read_curve(path, order, "curve_B") * SCALE + OFFSET).astype(np.float32)
    return metres


def read_curve(path: Path, order: Sequence[int], variable: str) -> Float64:
    """The joints of one person as the file has them, shape (T, 15, 3).

    Args:
        path: A MAT file.
        order: Where it keeps our joints.
        variable: Of 45 rows, x of all joints, then y, then z.

    Raises:
        RecordingError: If the file cannot be read.
        InvalidInput: If it holds no such variable.
    """
    curve = read_mat5(path).get(variable)
    if curve is None or curve.ndim != 2 or len(curve) != 3 * JOINTS:
        found = "nothing" if curve is None else "x".join(map(str, curve.shape))
        raise InvalidInput(
            f"{path}: {variable} ought to be {3 * JOINTS} rows (x, y, z of {JOINTS} joints) x "
            f"frames, found {found}",
            field=variable,
            code="wrong_shape",
        )
    joints = curve.reshape(3, JOINTS, -1).transpose(2, 1, 0)[:, list(order)]
    return joints.astype(np.float64)


SBU = InteractionSet(
    "sbu",
    "sbu/thesis_split",
    15,
    1,
    ("walking", "kicking", "pushing", "shaking hands", "exchanging", "punching"),
    tuple(range(JOINTS)),
    lambda parts: SBU_NAMES[parts[1]],
    (),
)
_K3HI_LABELS = (
    *("approaching", "departing", "exchanging", "kicking"),
    *("pointing", "punching", "pushing", "shaking"),
)
K3HI = InteractionSet(
    "k3hi",
    "k3hi",
    15,
    2,
    _K3HI_LABELS,
    K3HI_ORDER,
    lambda parts: parts[0],
    _K3HI_LABELS,
)
INTERACTION_SETS = {one.name: one for one in (SBU, K3HI)}


def interaction_set(name: str) -> InteractionSet:
    """A set by its name.

    Raises:
        ConfigError: If there is none of this name.
    """
    if name not in INTERACTION_SETS:
        raise ConfigError(f"set '{name}' is none of {', '.join(INTERACTION_SETS)}")
    return INTERACTION_SETS[name]


def held_out(
    interactions: Sequence[Interaction], groups: Iterable[str]
) -> tuple[list[Interaction], list[Interaction]]:
    """Interactions of other groups, and those of ``groups``."""
    chosen = set(groups)
    return (
        [one for one in interactions if one.group not in chosen],
        [one for one in interactions if one.group in chosen],
    )


@dataclass(frozen=True, slots=True)
class PairFrame:
    """A frame of reference of two people, made of one pose of each.

    Its origin is the middle between their torsos; y is up, and x goes from the first person to
    the second.

    Attributes:
        origin: Shape (3,), metres.
        turn: Shape (3, 3): rows are positions times it.
    """

    origin: torch.Tensor
    turn: torch.Tensor

    @classmethod
    def of(cls, first: torch.Tensor, second: torch.Tensor) -> "PairFrame":
        """The frame of two poses (15, 3), in metres with y up."""
        start, end = first[TORSO], second[TORSO]
        ahead = (end - start) * torch.tensor([1.0, 0.0, 1.0])
        x, _, z = (ahead / ahead.norm().clamp(min=1e-6)).tolist()
        turn = torch.tensor([[x, 0.0, -z], [0.0, 1.0, 0.0], [z, 0.0, x]])
        return cls((start + end) / 2, turn)

    def into(self, motion: torch.Tensor) -> torch.Tensor:
        """Positions (..., 3) as this frame has them."""
        return (motion - self.origin) @ self.turn

    def back(self, motion: torch.Tensor) -> torch.Tensor:
        """Positions (..., 3) of this frame as they were."""
        return motion @ self.turn.T + self.origin


def facing(interaction: Interaction) -> tuple[torch.Tensor, torch.Tensor]:
    """Action and reaction in the frame of their first poses, each of shape (T, 15, 3)."""
    action, reaction = map(torch.from_numpy, (interaction.action, interaction.reaction))
    frame = PairFrame.of(action[0], reaction[0])
    return frame.into(action), frame.into(reaction)


@dataclass(frozen=True, slots=True)
class Pairs:
    """Interactions as tensors, of one length each; what lies behind it repeats the last frame.

    Attributes:
        action: Shape (N, T, 15, 3), metres, in the frame of :func:`facing`.
        reaction: Shape (N, T, 15, 3), likewise.
        lengths: Shape (N,), frames that count.
        labels: Shape (N,), index of the class.
    """

    action: torch.Tensor
    reaction: torch.Tensor
    lengths: torch.Tensor
    labels: torch.Tensor

    @classmethod
    def of(cls, interactions: Sequence[Interaction], labels: Sequence[str]) -> "Pairs":
        """Interactions in the frames of their own, padded to the longest."""
        longest = max(len(one.action) for one in interactions)
        people = [facing(one) for one in interactions]
        action, reaction = (
            torch.stack([_padded(pair[who], longest) for pair in people]) for who in (0, 1)
        )
        return cls(
            action,
            reaction,
            torch.tensor([len(one.action) for one in interactions]),
            torch.tensor([labels.index(one.label) for one in interactions]),
        )

    def __len__(self) -> int:
        return len(self.lengths)

    def take(self, index: torch.Tensor) -> "Pairs":
        """The interactions with these indices, cut to the longest of them."""
        lengths = self.lengths[index]
        longest = int(lengths.max())
        return Pairs(
            self.action[index, :longest],
            self.reaction[index, :longest],
            lengths,
            self.labels[index],
        )

    def head(self, frames: int) -> "Pairs":
        """The first frames of each."""
        return Pairs(
            self.action[:, :frames],
            self.reaction[:, :frames],
            self.lengths.clamp(max=frames),
            self.labels,
        )

    def draw(self, count: int, generator: torch.Generator) -> "Pairs":
        """A random batch of interactions that are about as long as each other."""
        order = (self.lengths + 6 * torch.rand(len(self), generator=generator)).argsort()
        start = int(torch.randint(1 - count, len(self), (), generator=generator))
        return self.take(order[max(start, 0) : start + count])

    def with_reactions(self, reaction: torch.Tensor, lengths: torch.Tensor) -> "Pairs":
        """The same actions and labels with other reactions."""
        return Pairs(self.action, reaction, lengths, self.labels)

    @property
    def mask(self) -> torch.Tensor:
        """Shape (N, T), true where a frame counts."""
        frames = torch.arange(self.reaction.shape[1], device=self.lengths.device)
        return frames < self.lengths[:, None]

    def to(self, device: torch.device) -> "Pairs":
        """The same on a device."""
        return Pairs(
            self.action.to(device),
            self.reaction.to(device),
            self.lengths.to(device),
            self.labels.to(device),
        )


def _padded(motion: torch.Tensor, frames: int) -> torch.Tensor:
    return torch.cat([motion, motion[-1:].expand(frames - len(motion), -1, -1)])


def held(motion: torch.Tensor, frames: int) -> torch.Tensor:
    """Motions (B, T, J, 3) as long as asked: cut, or with the last pose repeated."""
    missing = max(frames - motion.shape[1], 0)
    return torch.cat([motion, motion[:, -1:].expand(-1, missing, -1, -1)], dim=1)[:, :frames]


def at_places(motion: torch.Tensor, places: torch.Tensor) -> torch.Tensor:
    """Motions (B, T, J, 3) at places (B, N) between their frames, held at both ends."""
    last = motion.shape[1] - 1
    places = places.clamp(0, last)
    before = places.long()
    after = (before + 1).clamp(max=last)
    share = (places - before)[..., None, None]
    rows = torch.arange(len(motion))[:, None]
    return motion[rows, before].lerp(motion[rows, after], share)


def vary(
    pairs: Pairs, generator: torch.Generator, scale: float = 0.1, swap: torch.Tensor | None = None
) -> Pairs:
    """Mirrored half of the time and scaled; where it is sound, with the people changing places.

    Args:
        pairs: A batch.
        generator: Of everything random.
        scale: Largest change of size.
        swap: Shape (classes,), true for classes whose people change places half of the time.
    """
    count = len(pairs)
    action, reaction = pairs.action, pairs.reaction
    if swap is not None:
        swapped = swap[pairs.labels] & (torch.rand(count, generator=generator) < 0.5)
        around = torch.tensor([-1.0, 1.0, -1.0])  # half a turn: the second person is the first
        chosen = swapped[:, None, None, None]
        action, reaction = (
            torch.where(chosen, reaction * around, action),
            torch.where(chosen, action * around, reaction),
        )
    mirrored = (torch.rand(count, generator=generator) < 0.5)[:, None, None, None]
    side = torch.tensor([1.0, 1.0, -1.0])
    size = 1 + scale * (2 * torch.rand(count, 1, 1, 1, generator=generator) - 1)
    mirror = list(KINECT15.mirror)
    action, reaction = (
        size * torch.where(mirrored, person[:, :, mirror] * side, person)
        for person in (action, reaction)
    )
    return Pairs(action, reaction, pairs.lengths, pairs.labels)
