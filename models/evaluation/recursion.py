"""How errors grow when a predictor goes on from its own predictions."""

from pathlib import Path

import numpy as np
import torch
from torch import nn

from agent_server.domain.motion import RATE_HZ
from models.data.h36m import complete_actions, read_h36m
from models.data.layouts import H36M
from models.ma_wgan.network import carry_on

SEEN = 50
SECONDS = (1, 2, 3, 4)
STRIDE = 25
MM = 1000.0


@torch.no_grad()
def recursion_errors(network: nn.Module, seen: int, data: Path) -> dict[str, dict[str, float]]:
    """Mean joint distance in mm after 1, 2, 3 and 4 s, beside standing still.

    Windows start every 25 frames of the complete actions of Human3.6M's S5; their average counts
    every action alike.

    Args:
        network: (B, seen, 22, 3) -> (B, 25, 22, 3), metres.
        seen: Frames that it sees.
        data: Folder that holds ``h36m/``.
    """
    frames = SECONDS[-1] * RATE_HZ
    rows: dict[str, list[list[float]]] = {"mpjpe": [], "zero_velocity": []}
    for takes in complete_actions(read_h36m(data, "test")).values():
        motion = torch.from_numpy(
            np.stack(
                [
                    take[start : start + SEEN + frames, H36M.joints]
                    for take in takes
                    for start in range(0, len(take) - SEEN - frames + 1, STRIDE)
                ]
            ).astype(np.float32)
            / np.float32(MM)
        )
        past, true = motion[:, SEEN - seen : SEEN], motion[:, SEEN:]
        for name, future in (
            ("mpjpe", carry_on(network, past, frames)),
            ("zero_velocity", past[:, -1:]),
        ):
            errors = MM * (future - true).norm(dim=-1).mean(dim=(0, 2))
            rows[name].append([float(errors[s * RATE_HZ - 1]) for s in SECONDS])
    return {
        name: {
            str(1000 * s): round(value, 1)
            for s, value in zip(SECONDS, np.mean(actions, axis=0), strict=True)
        }
        for name, actions in rows.items()
    }
