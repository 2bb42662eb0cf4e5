"""Reactions that are none: what the quality network learns to tell from recorded ones."""

from collections.abc import Callable

import torch

from models.data.interactions import Pairs, at_places, held

MOVES_M = 0.25
"""A reaction in which no joint gets this far from where it began may as well stand still."""
TREMBLE_M = (0.02, 0.06)
FAST, SLOW = (2.0, 3.0), (0.25, 0.5)
BLOCK_FRAMES = (2, 8)

Counterfeit = Callable[[Pairs, Pairs, torch.Generator], torch.Tensor]
"""A batch, recorded interactions to borrow from, chance -> reactions (B, T, 15, 3)."""


def of_another(pairs: Pairs, others: Pairs, generator: torch.Generator) -> torch.Tensor:
    """A recorded reaction to another kind of action, from the pose in which this one begins."""
    frames = pairs.reaction.shape[1]
    differs = (others.labels != pairs.labels[:, None]).float()
    borrowed = others.reaction[torch.multinomial(differs, 1, generator=generator)[:, 0]]
    way = held(borrowed, frames) - borrowed[:, :1]
    return pairs.reaction[:, :1] + way


def still(pairs: Pairs, others: Pairs, generator: torch.Generator) -> torch.Tensor:
    """The first pose, held."""
    return pairs.reaction[:, :1].expand_as(pairs.reaction)


def disordered(pairs: Pairs, others: Pairs, generator: torch.Generator) -> torch.Tensor:
    """Pieces of the reaction in another order."""
    frames = pairs.reaction.shape[1]
    piece = int(torch.randint(*BLOCK_FRAMES, (), generator=generator))
    order = torch.randperm(-(-frames // piece), generator=generator)
    places = (order[:, None] * piece + torch.arange(piece)).flatten()
    return pairs.reaction[:, places[places < frames]]


def at_another_pace(pairs: Pairs, others: Pairs, generator: torch.Generator) -> torch.Tensor:
    """Much too fast, or much too slow."""
    size, frames = pairs.reaction.shape[:2]
    share = torch.rand(size, 1, generator=generator)
    fast, slow = (low + (high - low) * share for low, high in (FAST, SLOW))
    is_fast = torch.rand(size, 1, generator=generator) < 0.5
    return at_places(pairs.reaction, torch.arange(frames) * torch.where(is_fast, fast, slow))


def trembling(pairs: Pairs, others: Pairs, generator: torch.Generator) -> torch.Tensor:
    """Every joint beside its place, in every frame elsewhere."""
    low, high = TREMBLE_M
    far = low + (high - low) * torch.rand(len(pairs), 1, 1, 1, generator=generator)
    return pairs.reaction + far * torch.randn(pairs.reaction.shape, generator=generator)


def backwards(pairs: Pairs, others: Pairs, generator: torch.Generator) -> torch.Tensor:
    """From its end to its beginning."""
    frames = torch.arange(pairs.reaction.shape[1])
    return at_places(pairs.reaction, (pairs.lengths[:, None] - 1 - frames).float())


COUNTERFEITS: dict[str, Counterfeit] = {
    "of_another": of_another,
    "still": still,
    "disordered": disordered,
    "at_another_pace": at_another_pace,
    "trembling": trembling,
    "backwards": backwards,
}
NEEDS_MOTION = frozenset(("still", "at_another_pace", "backwards"))
"""Of a reaction that stands still these are no counterfeits."""


def moves(pairs: Pairs) -> torch.Tensor:
    """Whose reaction moves, (B,)."""
    away: torch.Tensor = (pairs.reaction - pairs.reaction[:, :1]).norm(dim=-1)
    return away.amax((1, 2)) > MOVES_M
