"""The diffusion: how motions are scaled, how noise is added, and how it is taken away again.

Ho et al., "Denoising Diffusion Probabilistic Models" (NeurIPS 2020), with the cosine schedule of
Nichol and Dhariwal (ICML 2021); drawn by Song et al., "Denoising Diffusion Implicit Models" (ICLR
2021), without noise on the way.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import torch

from agent_server.errors import InvalidInput
from models.data.interactions import TORSO, Pairs

DRAWN_STEPS = 50
"""Steps of a draw; as many calls of the network."""
HELD = 0.3
"""Share of the steps in which known frames stand in for what the network makes of them."""
LEAST_DEVIATION = 0.1
"""Metres; joints that hardly move are not made as large as hands."""

Denoise = Callable[[torch.Tensor, torch.Tensor, torch.Tensor, torch.Tensor], torch.Tensor]
"""As :meth:`models.bigraphdiff.network.Denoiser.forward`, by torch or ONNX."""


@dataclass(frozen=True, slots=True)
class Normaliser:
    """Joints as offsets from their person's torso, the torso as it is; all of about unit size.

    Attributes:
        mean: Shape (2, J, 3), metres.
        deviation: Shape (2, J, 3), metres.
    """

    mean: torch.Tensor
    deviation: torch.Tensor

    @classmethod
    def of(cls, pairs: Pairs) -> "Normaliser":
        """Measured on the training split."""
        offsets = _offsets(both_of(pairs)).transpose(1, 2)[pairs.mask]  # (frames, 2, J, 3)
        return cls(offsets.mean(0), offsets.std(0).clamp(min=LEAST_DEVIATION))

    def into(self, motion: torch.Tensor) -> torch.Tensor:
        """Metres in the frame of the pair (B, 2, T, J, 3) -> normalised."""
        return (_offsets(motion) - self.mean[:, None]) / self.deviation[:, None]

    def back(self, motion: torch.Tensor) -> torch.Tensor:
        """Normalised (B, 2, T, J, 3) -> metres in the frame of the pair."""
        offsets = motion * self.deviation[:, None] + self.mean[:, None]
        torso = offsets[..., TORSO : TORSO + 1, :]
        return offsets + torso * _not_torso(offsets)


def both_of(pairs: Pairs) -> torch.Tensor:
    """The motion of both people, (N, 2, T, J, 3)."""
    return torch.stack([pairs.action, pairs.reaction], dim=1)


def _offsets(motion: torch.Tensor) -> torch.Tensor:
    return motion - motion[..., TORSO : TORSO + 1, :] * _not_torso(motion)


def _not_torso(motion: torch.Tensor) -> torch.Tensor:
    """(J, 1), 0 for the torso and 1 for the others."""
    keep = torch.ones(motion.shape[-2], 1, device=motion.device)
    keep[TORSO] = 0.0
    return keep


def signal(steps: int) -> torch.Tensor:
    """How much of a motion's power is left after each step, shape (steps,), falling to about 0."""
    at = torch.arange(1, steps + 1, dtype=torch.float64) / steps
    left = (
        torch.cos((at + 0.008) / 1.008 * math.pi / 2) ** 2
        / math.cos(0.008 / 1.008 * math.pi / 2) ** 2
    )
    return left.clamp(min=1e-5).float()


def noised(
    clean: torch.Tensor, noise: torch.Tensor, step: torch.Tensor, left: torch.Tensor
) -> torch.Tensor:
    """Motions (B, ...) after ``step`` (B,) of the diffusion."""
    share = left[step].reshape(-1, *[1] * (clean.dim() - 1))
    return share.sqrt() * clean + (1 - share).sqrt() * noise


@torch.no_grad()
def draw(
    denoise: Denoise,
    noise: torch.Tensor,
    lengths: torch.Tensor,
    words: torch.Tensor,
    steps: int,
    drawn_steps: int = DRAWN_STEPS,
    known: torch.Tensor | None = None,
) -> torch.Tensor:
    """Draw motions.

    Args:
        denoise: The network.
        noise: White, shape (B, 2, T, J, 3); other noise, another motion.
        lengths: Shape (B,), frames that count.
        words: Shape (B, W).
        steps: Steps of the diffusion.
        drawn_steps: How many of them are taken; 1 takes all noise away at once.
        known: Shape (B, 2, K, J, 3), how the motions begin, or None; in the end it fades into
            what the network makes of it, so that there is no leap behind it.

    Returns:
        Normalised motions, of the shape of ``noise``.

    Raises:
        InvalidInput: If more steps are to be taken than there are.
    """
    if not 1 <= drawn_steps <= steps:
        raise InvalidInput(
            f"drawn_steps is {drawn_steps}: take 1 to {steps} steps", field="drawn_steps"
        )
    left = signal(steps)
    at = torch.linspace(steps - 1, 0, drawn_steps).round().long().tolist()
    moment = noise
    for place, step in enumerate(at):
        clean = denoise(moment, lengths, torch.full_like(lengths, step), words)
        is_last = place + 1 == len(at)
        # Known frames lead the coarse steps; to the end they would tear off from the next ones.
        if known is not None and (is_last or place < HELD * len(at)):
            clean = _with_beginning(clean, known, fades=is_last)
        if is_last:
            break
        rest = (moment - left[step].sqrt() * clean) / (1 - left[step]).sqrt()
        earlier = left[at[place + 1]]
        moment = earlier.sqrt() * clean + (1 - earlier).sqrt() * rest
    return clean


def _with_beginning(clean: torch.Tensor, known: torch.Tensor, fades: bool) -> torch.Tensor:
    """A motion whose first frames are known ones; each less so than the one before if it fades."""
    count = known.shape[2]
    if fades:
        share = torch.arange(1, count + 1)[:, None, None] / (count + 1)
        known = known.lerp(clean[:, :, :count], share)
    return torch.cat([known, clean[:, :, count:]], dim=2)
