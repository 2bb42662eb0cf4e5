"""From labels to the motion of two people, in one piece or in several.

It is one for torch and for an exported model: both are a :data:`Denoise`.
"""

from dataclasses import dataclass

import torch

from models.bigraphdiff.config import NetworkConfig
from models.bigraphdiff.diffusion import DRAWN_STEPS, Denoise, Normaliser, draw
from models.data.interactions import PairFrame, Pairs

OVERLAP = 8
"""Frames that a piece of a long interaction shares with the one before it."""


@dataclass(frozen=True, slots=True)
class Generator:
    """A denoiser with all that draws need.

    Attributes:
        denoise: The network, on the CPU.
        normaliser: How its motions are scaled.
        words: Shape (labels, W), the words of each label.
        frames: Longest piece.
        steps: Steps of the diffusion.
        drawn_steps: How many of them are taken.
    """

    denoise: Denoise
    normaliser: Normaliser
    words: torch.Tensor
    frames: int
    steps: int
    drawn_steps: int

    @classmethod
    def of(
        cls,
        denoise: Denoise,
        normaliser: Normaliser,
        words: torch.Tensor,
        config: NetworkConfig,
    ) -> "Generator":
        """The generator of a network."""
        drawn = DRAWN_STEPS if config.diffusion else 1
        return cls(denoise, normaliser, words, config.frames, config.steps, drawn)

    def interactions(
        self, labels: torch.Tensor, lengths: torch.Tensor, generator: torch.Generator
    ) -> Pairs:
        """Draw an interaction for every label.

        One that is longer than ``frames`` is made piece by piece: a piece is seen from where the
        two people are at its start, and begins with the last frames of the one before.

        Args:
            labels: Shape (B,), places among the labels.
            lengths: Shape (B,), frames, at least one.
            generator: Of the noise.

        Returns:
            Their motion, in metres and the frame of the pair; behind an end it repeats the last
            pose.
        """
        words = self.words[labels]
        made = self._piece(words, lengths.clamp(max=self.frames), generator, None)
        while made.shape[2] < int(lengths.max()):
            start = made.shape[2] - OVERLAP
            given = made[:, :, start:]
            frames = [PairFrame.of(first[0], second[0]) for first, second in given]
            known = torch.stack([at.into(one) for at, one in zip(frames, given, strict=True)])
            # An interaction that is over already keeps what it has.
            rest = (lengths - start).clamp(OVERLAP, self.frames)
            piece = self._piece(words, rest, generator, known)
            back = torch.stack([at.back(one) for at, one in zip(frames, piece, strict=True)])
            made = torch.cat([made[:, :, :start], back], dim=2)
        at = torch.minimum(torch.arange(made.shape[2]), lengths[:, None] - 1)
        index = at[:, None, :, None, None].expand_as(made)
        action, reaction = made.gather(2, index).unbind(1)
        return Pairs(action, reaction, lengths, labels)

    def _piece(
        self,
        words: torch.Tensor,
        lengths: torch.Tensor,
        generator: torch.Generator,
        known: torch.Tensor | None,
    ) -> torch.Tensor:
        """Motions (B, 2, T, J, 3), metres."""
        mean = self.normaliser.mean
        shape = (len(words), len(mean), int(lengths.max()), *mean.shape[1:])
        noise = torch.randn(shape, generator=generator)
        given = None if known is None else self.normaliser.into(known)
        args = (noise, lengths, words, self.steps, self.drawn_steps, given)
        return self.normaliser.back(draw(self.denoise, *args))
