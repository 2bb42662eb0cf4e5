"""Training windows with the class of what they show."""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import torch

from agent_server.domain.motion import SEEN_FRAMES
from models.data.clips import reverse_some
from models.data.layouts import CORE, Layout
from models.data.splits import cmu_split, synthetic_split
from models.data.windows import Augmentation, WindowSet, augment, cut
from models.training.source import AUGMENTATION, SYNTHETIC_SHARE

VALIDATION_STRIDE = 25


class Named(NamedTuple):
    """Some windows.

    Attributes:
        seen: Shape (B, seen, J, 3), metres, as the sensor saw it.
        future: Shape (B, future, J, 3), metres, without sensor noise.
        labels: Shape (B,), the class of all 3 s, or AMBIGUOUS.
    """

    seen: torch.Tensor
    future: torch.Tensor
    labels: torch.Tensor


@dataclass(frozen=True, slots=True)
class Part:
    """Windows of one kind.

    Attributes:
        windows: All of them.
        share: How much of a batch they are.
        reverse: Whether half of them may run backwards.
    """

    windows: WindowSet
    share: float
    reverse: bool = False


@dataclass(frozen=True, slots=True)
class NamedSource:
    """Windows to train on and to validate with.

    Attributes:
        parts: To train on.
        validation: Windows by name.
        how: How they are varied.
        layout: The joints.
    """

    parts: tuple[Part, ...]
    validation: dict[str, Named]
    how: Augmentation = AUGMENTATION
    layout: Layout = CORE

    def draw(self, count: int, generator: torch.Generator) -> Named:
        """A random, augmented batch."""
        drawn = [_some(part, round(count * part.share), generator) for part in self.parts]
        observed, clean, labels = (torch.cat(same) for same in zip(*drawn, strict=True))
        observed, clean = augment(observed, clean, self.how, generator)
        return Named(observed[:, :SEEN_FRAMES], clean[:, SEEN_FRAMES:], labels)


def _some(
    part: Part, count: int, generator: torch.Generator
) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
    chosen = torch.randint(len(part.windows), (count,), generator=generator)
    observed, clean = part.windows.frames(chosen)
    if part.reverse:
        observed = clean = reverse_some(clean, generator)
    return observed, clean, part.windows.whole[chosen]


def named_windows(windows: WindowSet) -> Named:
    """All of them, as they are."""
    observed, clean = windows.frames(torch.arange(len(windows)))
    return Named(observed[:, :SEEN_FRAMES], clean[:, SEEN_FRAMES:], windows.whole)


def server_source(data: Path, cache: Path, sequences: int) -> NamedSource:
    """Virtual people as sensors see them, and CMU's motion capture: what weights that ship see.

    Args:
        data: Folder that holds ``cmu_mocap/``.
        cache: Folder of generated recordings.
        sequences: Takes of virtual people to train on.
    """
    return NamedSource(
        (
            Part(cut(synthetic_split(cache, "train", sequences)), SYNTHETIC_SHARE),
            Part(cut(cmu_split(data, "train")), 1 - SYNTHETIC_SHARE, reverse=True),
        ),
        server_validation(data, cache),
    )


def server_validation(data: Path, cache: Path) -> dict[str, Named]:
    """Windows of other virtual people and of other recordings of CMU's, by name."""
    return {
        "synthetic": named_windows(cut(synthetic_split(cache, "validation"), VALIDATION_STRIDE)),
        "cmu": named_windows(cut(cmu_split(data, "validation"), VALIDATION_STRIDE)),
    }
