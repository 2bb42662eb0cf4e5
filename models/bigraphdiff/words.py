"""Labels as the numbers of their words; 0 stands behind the last one."""

from collections.abc import Sequence

import torch


def words_of(label: str) -> list[str]:
    """The words of a label."""
    return label.lower().split()


def vocabulary(labels: Sequence[str]) -> tuple[str, ...]:
    """All words of the labels, in order; the first one has the number 1."""
    return tuple(sorted({word for label in labels for word in words_of(label)}))


def tokens(labels: Sequence[str]) -> torch.Tensor:
    """The words of every label of a set, int64, shape (labels, words of the longest)."""
    number = {word: at + 1 for at, word in enumerate(vocabulary(labels))}
    rows = [[number[word] for word in words_of(label)] for label in labels]
    longest = max(map(len, rows))
    return torch.tensor([row + [0] * (longest - len(row)) for row in rows])
