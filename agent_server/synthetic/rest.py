"""Where hands are when nothing happens: hanging, in a pocket, on the lap, on a desk, ..."""

import numpy as np

from agent_server.synthetic.performance import Frame, Reach, resting
from agent_server.synthetic.person import Person, Placement
from agent_server.synthetic.trajectory import ORIGIN, Vector

_Rest = tuple[Frame, Vector, Vector, Vector, Vector]
"""Frame, point, its spread, elbow pole, finger direction."""

_STANDING: dict[str, _Rest] = {
    "hanging": (
        "upright", (0.215, -0.585, -0.015), (0.025, 0.018, 0.03), (0.35, -0.1, 0.9), ORIGIN,
    ),
    "bent": ("upright", (0.22, -0.50, -0.12), (0.03, 0.04, 0.04), (0.4, -0.3, 0.9), ORIGIN),
    "clasped": ("pelvis", (0.05, 0.03, -0.17), (0.015, 0.04, 0.03), (0.8, -0.3, 0.5), (-0.8, 0, 0)),
    "behind": ("pelvis", (0.06, 0.08, 0.16), (0.02, 0.04, 0.02), (0.8, 0.0, 0.7), (-0.8, 0, 0)),
    "pocket": ("pelvis", (0.215, 0.055, -0.04), (0.012, 0.02, 0.02), (0.5, 0.0, 0.9), (-0.2, -1, 0)),
    "hip": ("pelvis", (0.205, 0.17, -0.05), (0.015, 0.02, 0.03), (0.9, 0.0, 0.5), (-0.6, -0.3, -0.5)),
    "folded": ("chest", (-0.03, -0.30, -0.20), (0.02, 0.03, 0.02), (0.8, -0.6, 0.0), (-0.9, 0, 0)),
    "belly": ("chest", (0.05, -0.36, -0.22), (0.03, 0.03, 0.03), (0.7, -0.6, 0.4), (-0.8, 0, -0.2)),
}  # fmt: skip
_SEATED: dict[str, _Rest] = {
    "lap": ("pelvis", (0.07, 0.09, -0.22), (0.035, 0.02, 0.05), (0.6, -0.4, 0.6), (-0.7, 0, 0)),
    "thigh": ("pelvis", (0.13, 0.10, -0.29), (0.025, 0.02, 0.06), (0.6, -0.3, 0.7), (0, -0.3, 0)),
    "desk": ("pelvis", (0.15, 0.22, -0.36), (0.06, 0.03, 0.05), (0.7, -0.7, 0.3), (-0.4, 0, 0)),
    "desk_folded": ("pelvis", (0.03, 0.22, -0.32), (0.03, 0.03, 0.03), (0.9, -0.4, 0.1), (-0.9, 0, 0)),
    "armrest": ("pelvis", (0.27, 0.22, -0.22), (0.02, 0.02, 0.05), (0.5, -0.6, 0.7), ORIGIN),
    "hanging": ("upright", (0.24, -0.56, -0.02), (0.02, 0.02, 0.03), (0.4, -0.1, 0.9), ORIGIN),
    "folded": ("chest", (-0.03, -0.30, -0.20), (0.02, 0.03, 0.02), (0.8, -0.6, 0.0), (-0.9, 0, 0)),
}  # fmt: skip
_STANDING_WEIGHTS = {
    ("hanging", "hanging"): 10.0, ("bent", "bent"): 2.0, ("clasped", "clasped"): 1.5,
    ("behind", "behind"): 0.8, ("pocket", "pocket"): 0.8, ("hanging", "pocket"): 1.2,
    ("hip", "hip"): 0.5, ("hanging", "hip"): 0.6, ("folded", "folded"): 0.6,
    ("belly", "belly"): 0.8, ("hanging", "bent"): 1.0,
}  # fmt: skip
_SEATED_WEIGHTS = {
    ("lap", "lap"): 4.0, ("thigh", "thigh"): 4.0, ("desk", "desk"): 4.0,
    ("desk_folded", "desk_folded"): 2.0, ("armrest", "armrest"): 1.5, ("desk", "lap"): 1.5,
    ("desk", "thigh"): 1.0, ("armrest", "lap"): 0.7, ("hanging", "thigh"): 0.4,
    ("folded", "folded"): 0.5,
}  # fmt: skip


def sample_rest(
    rng: np.random.Generator, person: Person, placement: Placement
) -> tuple[Reach, Reach]:
    """Draws where the left and the right hand rest."""
    table, weights = (
        (_SEATED, _SEATED_WEIGHTS) if placement.seated else (_STANDING, _STANDING_WEIGHTS)
    )
    share = np.array(list(weights.values()))
    names = list(weights)[int(rng.choice(len(weights), p=share / share.sum()))]
    if rng.random() < 0.5:
        names = (names[1], names[0])
    shared = rng.standard_normal(3)
    left, right = (_rest(rng, table[name], shared) for name in names)
    if names[0] == names[1] and names[0] in {"folded", "clasped", "desk_folded", "belly", "lap"}:
        left = _before(left) if person.handedness == "left" else left
        right = _before(right) if person.handedness == "right" else right
    return left, right


def _rest(rng: np.random.Generator, rest: _Rest, shared: np.ndarray) -> Reach:
    frame, point, spread, pole, fingers = rest
    own = 0.8 * np.clip(shared, -2, 2) + 0.5 * np.clip(rng.standard_normal(3), -2, 2)
    x, y, z = np.asarray(point) + own * spread
    px, py, pz = np.asarray(pole) + rng.normal(0, 0.12, 3)
    return resting(Reach(0.0, 1.0, frame, (float(x), float(y), float(z)), (px, py, pz), fingers))


def _before(rest: Reach) -> Reach:
    """The same rest, the thickness of a hand further to the front."""
    x, y, z = rest.point
    return Reach(
        rest.start_s, rest.duration_s, rest.frame, (x, y + 0.01, z - 0.04), rest.pole, rest.hand
    )
