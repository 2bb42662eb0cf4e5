"""Several futures of one past: how widely drawn ones ought to lie apart."""

import math

import torch

from models.ma_wgan.network import Predictor
from models.ma_wgan.representation import Forecast, Target

SHARE = 4
"""One in so many windows of a batch gets two drawn futures."""


def spread_of_futures(
    network: Predictor, target: Target, expected: Forecast, generator: torch.Generator
) -> tuple[Forecast, torch.Tensor]:
    """Two drawn futures for some windows, and how far they are from what they ought to be.

    Their mean ought to be the expected future, and they ought to lie as far from each other as
    two draws from what may happen would: sqrt(2) times as far as the truth is from the expected
    future, at every frame. Not in the papers, whose noise nothing holds to the size of the error.

    Args:
        network: The predictor.
        target: The windows.
        expected: Their futures without noise.
        generator: Draws the noise.

    Returns:
        Both draws of the first quarter of the windows, a pair after the other, and the term in
        metres.
    """
    count = max(1, len(target.seen) // SHARE)
    noise = torch.randn(2 * count, network.config.noise, generator=generator)
    seen = target.seen[:count].repeat_interleave(2, 0)
    drawn = network.forecast(seen, noise.to(seen.device))
    pairs = drawn.poses.unflatten(0, (count, 2)).unflatten(3, (-1, 3))  # (n, 2, T, J, 3)
    middle = expected.poses[:count].detach().unflatten(2, (-1, 3))
    true = target.future[:count].unflatten(2, (-1, 3))
    error = (true - middle).norm(dim=-1).mean(dim=2)  # (n, T)
    apart = (pairs[:, 0] - pairs[:, 1] + 1e-9).norm(dim=-1).mean(dim=2)
    off = (pairs.mean(dim=1) - middle + 1e-9).norm(dim=-1).mean()
    return drawn, (apart - math.sqrt(2) * error).abs().mean() + off
