"""Windows of plain motion: one array of frames and the places where windows start."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import torch

from agent_server.domain.arrays import Float32
from agent_server.errors import InvalidInput


@dataclass(frozen=True, slots=True)
class Clips:
    """All windows of some recordings; the frames are kept once.

    Attributes:
        frames: Shape (F, J, 3), metres, all recordings one after the other.
        starts: Shape (N,), first frame of each window.
        length: Frames a window.
    """

    frames: torch.Tensor
    starts: torch.Tensor
    length: int

    def __len__(self) -> int:
        return len(self.starts)

    def take(self, index: torch.Tensor) -> torch.Tensor:
        """The windows with these indices, shape (B, length, J, 3)."""
        return self.frames[self.starts[index, None] + torch.arange(self.length)]

    def draw(self, count: int, generator: torch.Generator) -> torch.Tensor:
        """Random windows, shape (count, length, J, 3)."""
        return self.take(torch.randint(len(self), (count,), generator=generator))

    def all(self) -> torch.Tensor:
        """Every window, shape (N, length, J, 3)."""
        return self.take(torch.arange(len(self)))


def cut_clips(recordings: Iterable[Float32], length: int, stride: int = 1) -> Clips:
    """Every window of ``length`` frames that fits into a recording, ``stride`` frames apart.

    Args:
        recordings: Each of shape (T, J, 3), metres.
        length: Frames a window.
        stride: Frames between the starts of two windows.

    Raises:
        InvalidInput: If no recording is long enough.
    """
    frames: list[Float32] = []
    starts: list[np.ndarray[tuple[int], np.dtype[np.int64]]] = []
    base = 0
    for recording in recordings:
        starts.append(base + np.arange(0, len(recording) - length + 1, stride, dtype=np.int64))
        frames.append(recording)
        base += len(recording)
    if not any(len(part) for part in starts):
        raise InvalidInput(f"no recording has {length} frames: give longer ones")
    return Clips(
        torch.from_numpy(np.concatenate(frames).astype(np.float32)),
        torch.from_numpy(np.concatenate(starts)),
        length,
    )


def reverse_some(
    motion: torch.Tensor, generator: torch.Generator, share: float = 0.5
) -> torch.Tensor:
    """Let a share of the windows (B, T, J, 3) run backwards."""
    backwards = torch.rand(len(motion), generator=generator) < share
    return torch.where(backwards[:, None, None, None], motion.flip(1), motion)


def mirror_some(
    motion: torch.Tensor, mirror: tuple[int, ...], generator: torch.Generator, share: float = 0.5
) -> torch.Tensor:
    """Swap left and right in a share of the windows (B, T, J, 3); x is negated."""
    swapped = torch.rand(len(motion), generator=generator) < share
    return torch.where(swapped[:, None, None, None], mirrored(motion, mirror), motion)


def mirrored(motion: torch.Tensor, mirror: tuple[int, ...]) -> torch.Tensor:
    """The same motion of the mirrored body; (B, T, J, 3), x to a side."""
    sign = torch.tensor([-1.0, 1.0, 1.0], device=motion.device)
    return motion[:, :, list(mirror)] * sign
