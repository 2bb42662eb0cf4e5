"""Where the batches of predictors come from."""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Protocol

import torch

from agent_server.domain.motion import SEEN_FRAMES
from models.data.clips import Clips, mirror_some, reverse_some
from models.data.layouts import CORE, Layout
from models.data.sets import motion_set
from models.data.splits import cmu_split, synthetic_split
from models.data.windows import HALF_QUARTER_TURN, Augmentation, WindowSet, augment, cut

AUGMENTATION = Augmentation(yaw=HALF_QUARTER_TURN, scale=0.1, noise_m=0.005, drop=0.05)
VARIED = Augmentation(yaw=0.35, scale=0.1, noise_m=0.0, drop=0.0)
SYNTHETIC_SHARE = 0.6
VALIDATION_STRIDE = 40
SCALE = 0.05
"""Largest relative change of a recorded body's size."""


class Windows(NamedTuple):
    """Past and future of some windows, metres.

    Attributes:
        seen: Shape (B, seen, J, 3), as the sensor saw it.
        future: Shape (B, future, J, 3), without sensor noise.
    """

    seen: torch.Tensor
    future: torch.Tensor


class Source(Protocol):
    """Training and validation windows of one body layout."""

    @property
    def layout(self) -> Layout:
        """The joints."""

    @property
    def validation(self) -> dict[str, Windows]:
        """Windows by name."""

    def draw(self, count: int, generator: torch.Generator) -> Windows:
        """Random, augmented training windows."""


@dataclass(frozen=True, slots=True)
class SensorSource:
    """Windows of virtual people as sensors see them, and of motion capture: nine joints.

    Attributes:
        synthetic: Windows of virtual people.
        mocap: Windows of motion capture, of which half run backwards.
        validation: Windows by name.
        layout: The nine core joints.
    """

    synthetic: WindowSet
    mocap: WindowSet
    validation: dict[str, Windows]
    layout: Layout = CORE

    def draw(self, count: int, generator: torch.Generator) -> Windows:
        """An augmented batch, three in five of virtual people."""
        virtual = max(1, round(count * SYNTHETIC_SHARE))
        observed, clean = _some(self.synthetic, virtual, generator)
        captured, _ = _some(self.mocap, max(1, count - virtual), generator)
        # What people did may as well run backwards; a sensor's failures may not.
        captured = reverse_some(captured, generator)
        observed, clean = torch.cat([observed, captured]), torch.cat([clean, captured])
        return split(*augment(observed, clean, AUGMENTATION, generator))


@dataclass(frozen=True, slots=True)
class TaggedSource:
    """Windows of recordings of which some matter more: half of a batch are those.

    Attributes:
        windows: All of them.
        tagged: Those that matter.
        validation: Windows by name.
        layout: The nine core joints.
    """

    windows: WindowSet
    tagged: WindowSet
    validation: dict[str, Windows]
    layout: Layout = CORE

    def draw(self, count: int, generator: torch.Generator) -> Windows:
        """An augmented batch."""
        everywhere = _some(self.windows, count - count // 2, generator)
        tagged = _some(self.tagged, count // 2, generator)
        observed, clean = (torch.cat(both) for both in zip(everywhere, tagged, strict=True))
        return split(*augment(observed, clean, VARIED, generator))


@dataclass(frozen=True, slots=True)
class ClipSource:
    """Windows of plain motion; half run backwards, and half are mirrored if bodies are varied.

    Attributes:
        clips: Training windows.
        seen: Frames of them that are seen.
        validation: Windows by name.
        layout: The joints.
        vary: Mirror bodies and change their size too.
    """

    clips: Clips
    seen: int
    validation: dict[str, Windows]
    layout: Layout
    vary: bool

    def draw(self, count: int, generator: torch.Generator) -> Windows:
        """An augmented batch."""
        motion = reverse_some(self.clips.draw(count, generator), generator)
        if self.vary:
            motion = mirror_some(motion, self.layout.mirror, generator)
            scale = 1 + SCALE * (2 * torch.rand(count, 1, 1, 1, generator=generator) - 1)
            motion = motion * scale
        return Windows(motion[:, : self.seen], motion[:, self.seen :])


def _some(
    windows: WindowSet, count: int, generator: torch.Generator
) -> tuple[torch.Tensor, torch.Tensor]:
    return windows.frames(torch.randint(len(windows), (count,), generator=generator))


def split(observed: torch.Tensor, clean: torch.Tensor) -> Windows:
    """Seen and future part of normalised windows (B, 75, 9, 3)."""
    return Windows(observed[:, :SEEN_FRAMES], clean[:, SEEN_FRAMES:])


def whole(windows: WindowSet) -> Windows:
    """All of them."""
    return split(*windows.frames(torch.arange(len(windows))))


def make_source(
    name: str, seen: int, data: Path, cache: Path, *, sequences: int, vary: bool = True
) -> Source:
    """The source of a configuration.

    Args:
        name: ``server`` (synthetic people and CMU, nine joints) or a set of plain motion.
        seen: Frames that the model sees.
        data: Folder that holds the set folders.
        cache: Folder of generated recordings.
        sequences: Takes of virtual people to train on.
        vary: Mirror the bodies of plain motion and change their size.
    """
    if name == "server":
        return SensorSource(
            cut(synthetic_split(cache, "train", sequences)),
            cut(cmu_split(data, "train")),
            {
                "synthetic": whole(cut(synthetic_split(cache, "validation"), stride=25)),
                "cmu": whole(cut(cmu_split(data, "validation"), stride=5)),
            },
        )
    motions = motion_set(name)
    held = motions.clips(data, "validation", seen, VALIDATION_STRIDE).all()
    return ClipSource(
        motions.clips(data, "train", seen),
        seen,
        {name: Windows(held[:, :seen], held[:, seen:])},
        motions.layout,
        vary,
    )
