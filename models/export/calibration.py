"""The temperature that makes a classifier's probabilities honest."""

import torch
import torch.nn.functional as F


def fit_temperature(logits: torch.Tensor, labels: torch.Tensor) -> float:
    """The temperature with the lowest cross entropy on held-out windows.

    Args:
        logits: Shape (N, C).
        labels: Shape (N,).
    """
    candidates = torch.exp(torch.linspace(-1.5, 1.5, 301))
    losses = [float(F.cross_entropy(logits / t, labels)) for t in candidates]
    return float(candidates[losses.index(min(losses))])
