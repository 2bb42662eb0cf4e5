"""Where hands are when nothing happens: hanging, in a pocket, on the lap, on a desk, ..."""

from dataclasses import dataclass

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.synthetic.performance import Frame, Reach
from agent_server.synthetic.person import Person, Placement
from agent_server.synthetic.trajectory import LONG_AGO_S, ORIGIN, Vector


@dataclass(frozen=True, slots=True)
class _Rest:
    """Where a hand rests: frame, point, its spread, the elbow's swivel in degrees, fingers."""

    frame: Frame
    point: Vector
    spread: Vector
    swivel: float
    fingers: Vector = ORIGIN


_FOLDED = _Rest("chest", (-0.03, -0.30, -0.20), (0.02, 0.03, 0.02), 42, (-0.9, 0.0, 0.0))
_STANDING: dict[str, _Rest] = {
    "hanging": _Rest("upright", (0.22, -0.625, -0.06), (0.025, 0.018, 0.03), 30),
    "bent": _Rest("upright", (0.22, -0.50, -0.12), (0.03, 0.04, 0.04), 28),
    "clasped": _Rest("pelvis", (0.05, 0.03, -0.17), (0.015, 0.04, 0.03), 50, (-0.8, 0.0, 0.0)),
    "behind": _Rest("pelvis", (0.06, 0.08, 0.16), (0.02, 0.04, 0.02), 55, (-0.8, 0.0, 0.0)),
    "pocket": _Rest("pelvis", (0.215, 0.055, -0.04), (0.01, 0.02, 0.02), 45, (-0.2, -1.0, 0.0)),
    "hip": _Rest("pelvis", (0.205, 0.17, -0.05), (0.015, 0.02, 0.03), 80, (-0.6, -0.3, -0.5)),
    "folded": _FOLDED,
    "belly": _Rest("chest", (0.05, -0.36, -0.22), (0.03, 0.03, 0.03), 38, (-0.8, 0.0, -0.2)),
}
_SEATED: dict[str, _Rest] = {
    "lap": _Rest("pelvis", (0.07, 0.09, -0.22), (0.035, 0.02, 0.05), 38, (-0.7, 0.0, 0.0)),
    "thigh": _Rest("pelvis", (0.13, 0.10, -0.29), (0.025, 0.02, 0.06), 30, (0.0, -0.3, 0.0)),
    "desk": _Rest("pelvis", (0.15, 0.22, -0.36), (0.06, 0.03, 0.05), 38, (-0.4, 0.0, 0.0)),
    "desk_folded": _Rest("pelvis", (0.03, 0.22, -0.32), (0.03, 0.03, 0.03), 48, (-0.9, 0.0, 0.0)),
    "armrest": _Rest("pelvis", (0.27, 0.22, -0.22), (0.02, 0.02, 0.05), 25),
    "hanging": _Rest("upright", (0.24, -0.56, -0.02), (0.02, 0.02, 0.03), 20),
    "folded": _FOLDED,
}
_OVERLAPPING = frozenset({"folded", "clasped", "behind", "desk_folded", "belly", "lap"})
_Pairs = dict[tuple[str, str], float]
_STANDING_PAIRS: _Pairs = {
    ("hanging", "hanging"): 13.0,
    ("bent", "bent"): 2.0,
    ("clasped", "clasped"): 1.5,
    ("behind", "behind"): 0.8,
    ("pocket", "pocket"): 0.8,
    ("hanging", "pocket"): 1.2,
    ("hip", "hip"): 0.5,
    ("hanging", "hip"): 0.6,
    ("folded", "folded"): 0.6,
    ("belly", "belly"): 0.8,
    ("hanging", "bent"): 1.0,
}
_SEATED_PAIRS: _Pairs = {
    ("lap", "lap"): 4.0,
    ("thigh", "thigh"): 4.0,
    ("desk", "desk"): 4.0,
    ("desk_folded", "desk_folded"): 2.0,
    ("armrest", "armrest"): 1.5,
    ("desk", "lap"): 1.5,
    ("desk", "thigh"): 1.0,
    ("armrest", "lap"): 0.7,
    ("hanging", "thigh"): 0.4,
    ("folded", "folded"): 0.5,
}


def sample_rest(
    rng: np.random.Generator, person: Person, placement: Placement
) -> tuple[Reach, Reach]:
    """Draws where the left and the right hand rest."""
    table, pairs = (_SEATED, _SEATED_PAIRS) if placement.seated else (_STANDING, _STANDING_PAIRS)
    share = np.array(list(pairs.values()))
    names = list(pairs)[int(rng.choice(len(pairs), p=share / share.sum()))]
    if rng.random() < 0.5:
        names = (names[1], names[0])
    shared = rng.standard_normal(3)
    outer = 0 if person.handedness == "left" else 1
    overlap = names[0] == names[1] and names[0] in _OVERLAPPING
    left, right = (
        _draw(rng, table[name], shared, in_front=overlap and side == outer)
        for side, name in enumerate(names)
    )
    return left, right


def hanging(rng: np.random.Generator) -> tuple[Reach, Reach]:
    """Both hands hang down."""
    shared = rng.standard_normal(3)
    rest = _STANDING["hanging"]
    return _draw(rng, rest, shared, in_front=False), _draw(rng, rest, shared, in_front=False)


def _draw(rng: np.random.Generator, rest: _Rest, shared: Float64, *, in_front: bool) -> Reach:
    """A place near the typical one; a hand on top of the other one lies further out."""
    own = 0.8 * np.clip(shared, -2, 2) + 0.5 * np.clip(rng.standard_normal(3), -2, 2)
    x, y, z = np.asarray(rest.point) + own * rest.spread
    if in_front:
        y, z = y + 0.01, z + (0.04 if rest.point[2] > 0 else -0.04)
    swivel = float(np.radians(rest.swivel + np.clip(rng.normal(0, 10), -20, 25)))
    point = (float(x), float(y), float(z))
    return Reach(LONG_AGO_S, 1.0, rest.frame, point, swivel, rest.fingers)
