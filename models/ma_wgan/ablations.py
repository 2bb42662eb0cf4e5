"""Ablations of the predictor on Human3.6M: what each part is worth on the same small budget.

Every row is the same training but for one thing. The papers' Table 6 leaves out losses and their
Table 7 observed frames; the others are about what this product does differently.
"""

from dataclasses import replace

from models.ma_wgan.config import BEST, TrainConfig

STEPS = 600
BATCH = 64

BASE = replace(
    BEST,
    network=replace(BEST.network, output="tangent", flip=False, dropout=0.0),
    steps=STEPS,
    batch=BATCH,
    validate_every=STEPS,
    ema=0.99,
)
"""Tangent vectors out, a sphere for each joint, lengths predicted, all losses."""

LOSSES = (
    "adversarial",
    "reconstruction",
    "skeleton",
    "bones",
    "length",
    "position",
    "velocity",
)
OBSERVED = (5, 10, 15, 25)


def _without(loss: str) -> TrainConfig:
    return replace(BASE, **{loss: 0.0})  # type: ignore[arg-type]


def _with(**changes: object) -> TrainConfig:
    return replace(BASE, network=replace(BASE.network, **changes))  # type: ignore[arg-type]


ROWS: dict[str, TrainConfig] = {
    "all": BASE,
    **{f"without {name}": _without(name) for name in LOSSES},
    **{f"{frames} frames seen": _with(seen=frames) for frames in OBSERVED},
    "one sphere for the body": _with(spheres="body"),
    "lengths not predicted": _with(length=False),
    "16 numbers of noise": _with(noise=16),
    "the curve itself out": _with(output="curve"),
    "the curve itself out, without reconstruction and critic": replace(
        _with(output="curve"), reconstruction=0.0, adversarial=0.0
    ),
}
