"""Errors in mm that validation compares."""

import torch
from torch import nn

from models.training.source import Windows

CHUNK = 512


@torch.no_grad()
def position_error(network: nn.Module, windows: Windows, device: torch.device) -> float:
    """Mean distance of predicted and true joints over all windows and frames, in mm."""
    total = 0.0
    for seen, true in zip(windows.seen.split(CHUNK), windows.future.split(CHUNK), strict=True):
        future = network(seen.to(device)).cpu()
        total += float((future - true).norm(dim=-1).mean(dim=(1, 2)).sum())
    return 1000 * total / len(windows.seen)


def stand_still_error(windows: Windows) -> float:
    """The same for a prediction that repeats the last pose, in mm."""
    return 1000 * float((windows.seen[:, -1:] - windows.future).norm(dim=-1).mean())


def validation_errors(
    network: nn.Module, held: dict[str, Windows], device: torch.device
) -> dict[str, float]:
    """Errors in mm by name; ``score`` is their mean, each over that of standing still."""
    errors = {name: position_error(network, windows, device) for name, windows in held.items()}
    shares = [errors[name] / stand_still_error(windows) for name, windows in held.items()]
    return {"score": sum(shares) / len(shares), **errors}
