"""Writing reactions frame by frame, with what earlier frames are asked for kept.

The loop is one for torch and for an exported model: both are a :class:`Core`.
"""

from typing import NamedTuple, Protocol

import torch
import torch.nn.functional as F
from torch import nn

from models.data.interactions import PairFrame
from models.interformer.generator.attention import Seen, nearness
from models.interformer.generator.network import Generator

EMPHASIS = 2.0
"""How much farther than in training the kind lies from the mean of all; by pairs held out."""
OVERLAP = 8
"""Frames that a segment of a long action shares with the one before it."""


class Read(NamedTuple):
    """An action that has been read, in plain tensors.

    Attributes:
        tokens: The encoder's, (B, S, D).
        bias: Hides padding, (B, 1, 1, S).
        seen: Keys and values for the decoder's layers, (L, 2, B, H, S, D / H).
        kind: What the decoder is told of the kind of interaction, (B, classes): :func:`emphasised`.
    """

    tokens: torch.Tensor
    bias: torch.Tensor
    seen: torch.Tensor
    kind: torch.Tensor


class Told(NamedTuple):
    """What one step says.

    Attributes:
        pose: The next pose, (B, J, 3), metres.
        stop: Logit that this was the last one, (B,).
        past: Keys and values of the reaction so far, (L, 2, B, H, T, D / H).
    """

    pose: torch.Tensor
    stop: torch.Tensor
    past: torch.Tensor


def emphasised(kind: torch.Tensor) -> torch.Tensor:
    """Logits of kinds (B, classes) -> what the decoder is told, (B, classes); the sum is 1.

    The most probable kind alone, for what is written for a mixture is a mean of several reactions,
    and farther from the mean of all kinds than in training: guidance as Ho and Salimans have it
    for diffusion ("Classifier-Free Diffusion Guidance", 2022).
    """
    one = F.one_hot(kind.argmax(-1), kind.shape[-1]).to(kind.dtype)
    mean = 1 / kind.shape[-1]
    return mean + EMPHASIS * (one - mean)


class Encode(nn.Module):
    """The encoder with what the decoder asks of it: action (B, S, J, 3), lengths (B,) -> Read."""

    def __init__(self, network: Generator) -> None:
        super().__init__()
        self.network = network

    def forward(self, action: torch.Tensor, lengths: torch.Tensor) -> Read:
        """Read actions."""
        memory = self.network.encode(action, lengths)
        seen = torch.stack([torch.stack(layer) for layer in memory.seen])
        return Read(memory.tokens, memory.bias, seen, emphasised(memory.kind))


class Step(nn.Module):
    """One frame of the decoder."""

    def __init__(self, network: Generator) -> None:
        super().__init__()
        self.network = network

    def forward(
        self,
        first: torch.Tensor,
        pose: torch.Tensor,
        before: torch.Tensor,
        at: torch.Tensor,
        noise: torch.Tensor,
        kind: torch.Tensor,
        past: torch.Tensor,
        action_pose: torch.Tensor,
        action_token: torch.Tensor,
        action_bias: torch.Tensor,
        action_seen: torch.Tensor,
    ) -> Told:
        """Give the next pose.

        Args:
            first: First pose of the reaction, (B, J, 3), metres.
            pose: Of the reaction now, (B, J, 3), metres.
            before: The one before; the same for the first.
            at: Number of this frame, int64, (1,).
            noise: (B, latent).
            kind: As :func:`emphasised`, (B, classes).
            past: Of the frames before this one, (L, 2, B, H, T, D / H).
            action_pose: Of the action now, (B, J, 3).
            action_token: The encoder's, (B, D).
            action_bias: (B, 1, 1, S).
            action_seen: (L, 2, B, H, S, D / H).
        """
        network = self.network
        reaction = pose[:, None]
        x = network.write(first[:, None], reaction, reaction - before[:, None])
        x = x + network.write.times[at] + network.told(kind, noise)
        near = nearness(reaction, action_pose[:, None]) if network.config.distance else None
        kept = []
        for place, layer in enumerate(network.decoder_layers):
            new = torch.stack(layer.temporal.see(layer.norm(x)))
            both = torch.cat([past[place], new], dim=-2)
            kept.append(both)
            x = layer.within(x, Seen(both[0], both[1]), x.new_zeros(1, 1))
            action = Seen(action_seen[place, 0], action_seen[place, 1])
            x = layer.between(x, action, action_bias, action_token[:, None], near)
        written = network.written(first[:, None], x)
        return Told(written.pose[:, 0], written.stop[:, 0], torch.stack(kept))


class Core(Protocol):
    """A generator in its two halves."""

    def encode(self, action: torch.Tensor, lengths: torch.Tensor) -> Read:
        """As :class:`Encode`."""

    def step(
        self,
        first: torch.Tensor,
        pose: torch.Tensor,
        before: torch.Tensor,
        at: torch.Tensor,
        noise: torch.Tensor,
        kind: torch.Tensor,
        past: torch.Tensor,
        action_pose: torch.Tensor,
        action_token: torch.Tensor,
        action_bias: torch.Tensor,
        action_seen: torch.Tensor,
    ) -> Told:
        """As :class:`Step`."""


class TorchCore:
    """A network as a core.

    Args:
        network: On the CPU; put into evaluation mode.
    """

    def __init__(self, network: Generator) -> None:
        network.eval()
        self.encode, self.step = Encode(network), Step(network)


@torch.no_grad()
def generate(
    core: Core,
    action: torch.Tensor,
    lengths: torch.Tensor,
    given: torch.Tensor,
    noise: torch.Tensor,
    longest: int,
    stops: bool = True,
) -> tuple[torch.Tensor, torch.Tensor]:
    """Reactions to actions, with ends of their own.

    Args:
        core: The generator.
        action: Shape (B, S, J, 3), metres, in the frame of the pair.
        lengths: Shape (B,), frames of each action.
        given: Shape (B, G, J, 3), how the reactions begin: one pose, or more.
        noise: Shape (B, latent); zeros for the expected reaction.
        longest: Frames at most.
        stops: Whether reactions end by themselves; if not, all have ``longest`` frames.

    Returns:
        Reactions (B, T, J, 3), which repeat their last pose, and their lengths (B,).
    """
    read = core.encode(action, lengths)
    past = read.seen[..., :0, :]
    poses = list(given.unbind(1))
    ends = torch.full_like(lengths, longest)
    rows = torch.arange(len(action))
    for at in range(longest):
        beside = torch.clamp(lengths - 1, max=at)
        told = core.step(
            poses[0],
            poses[at],
            poses[max(at - 1, 0)],
            torch.tensor([at]),
            noise,
            read.kind,
            past,
            action[rows, beside],
            read.tokens[rows, beside],
            read.bias,
            read.seen,
        )
        past = told.past
        if at + 1 < len(poses):
            continue
        # A reaction ends where its end is more probable than not.
        ends = torch.where((told.stop > 0) & (ends == longest) & stops, at + 1, ends)
        if bool((ends <= at + 1).all()):
            break
        ended = (ends <= at + 1)[:, None, None]
        poses.append(torch.where(ended, poses[at], told.pose))
    return torch.stack(poses, dim=1), torch.clamp(ends, max=len(poses))


def react_to(
    core: Core, action: torch.Tensor, first: torch.Tensor, noise: torch.Tensor, frames: int
) -> torch.Tensor:
    """The reaction to one action of any length, anywhere in a room with y up.

    An action longer than ``frames`` is reacted to piece by piece: each piece is seen from where
    the two people are at its start, and its reaction begins with the last frames of the one
    before. The last piece ends by itself, and the others where the next one begins.

    Args:
        core: The generator.
        action: Shape (S, J, 3), metres.
        first: Shape (J, 3), how the reaction begins, metres, in the same frame.
        noise: Shape (latent,).
        frames: Longest piece.

    Returns:
        Shape (T, J, 3), metres, in the same frame.
    """
    made, start = first[None], 0
    while True:
        piece, given = action[start : start + frames], made[start:]
        is_last = start + frames >= len(action)
        frame = PairFrame.of(piece[0], given[0])
        reaction, ends = generate(
            core,
            frame.into(piece)[None],
            torch.tensor([len(piece)]),
            frame.into(given)[None],
            noise[None],
            frames,
            stops=is_last,
        )
        made = torch.cat([made[:start], frame.back(reaction[0, : int(ends[0])])])
        if is_last:
            return made
        start += frames - OVERLAP
