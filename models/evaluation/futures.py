"""What several drawn futures are worth: how close the best comes, and how far they lie apart."""

import numpy as np
import torch

from agent_server.domain.arrays import Float32
from models.ma_wgan.network import Predictor

DRAWS = 10
EVERY = 8
MM = 1000.0


@torch.no_grad()
def futures_figures(
    network: Predictor, windows: dict[str, Float32], joints: tuple[int, ...], seed: int
) -> dict[str, float]:
    """Figures of ten drawn futures over every eighth window, mean over joints and time, in mm.

    Args:
        network: With noise.
        windows: Action -> windows (N, seen + future, all joints, 3), mm.
        joints: The joints that it predicts.
        seed: Of the draws.

    Returns:
        ``expected_mm``, the error without noise; ``best_of_10_mm``, that of the draw nearest to
        the truth; ``apart_mm``, the mean distance of two draws.
    """
    generator = torch.Generator().manual_seed(seed)
    rows = []
    for motion in windows.values():
        chosen = torch.from_numpy((motion[::EVERY, :, joints] / MM).astype(np.float32))
        past, true = chosen[:, : network.config.seen], chosen[:, network.config.seen :]
        drawn = network.futures(past, DRAWS, generator)  # (N, 10, T, J, 3)
        errors = (drawn - true[:, None]).norm(dim=-1).mean(dim=(2, 3))
        pairs = (drawn[:, :-1] - drawn[:, 1:]).norm(dim=-1)
        expected = (network(past) - true).norm(dim=-1)
        rows.append([expected.mean(), errors.min(dim=1).values.mean(), pairs.mean()])
    expected_mm, best_mm, apart_mm = MM * np.mean(np.array(rows, dtype=float), axis=0)
    return {
        "expected_mm": round(float(expected_mm), 1),
        "best_of_10_mm": round(float(best_mm), 1),
        "apart_mm": round(float(apart_mm), 1),
    }
