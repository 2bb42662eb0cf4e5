"""What the face can do: morphs made of MakeHuman's expression units."""

import numpy as np

from agent_server.web.tools.human.figure import Figure
from agent_server.web.tools.human.makehuman import Array, MakeHuman

UNITS = "expression/units/caucasian"
MORPHS: dict[str, dict[str, float]] = {
    "blinkLeft": {"eye-left-closure": 1.0},
    "blinkRight": {"eye-right-closure": 1.0},
    "attention": {
        "eyebrows-left-up": 0.75,
        "eyebrows-right-up": 0.75,
        "eye-left-opened-up": 0.55,
        "eye-right-opened-up": 0.55,
        "mouth-corner-puller": 0.40,
    },
    "discomfort": {
        "eyebrows-left-down": 0.75,
        "eyebrows-right-down": 0.75,
        "eyebrows-left-inner-up": 0.35,
        "eyebrows-right-inner-up": 0.35,
        "eye-left-slit": 0.35,
        "eye-right-slit": 0.35,
        "mouth-depression": 0.45,
    },
    "mouthOpen": {"mouth-open": 0.6},
}
"""Name of each morph -> its units and their shares."""
TONGUE = (0.0, -0.005, -0.010)
"""How much further than the jaw the tongue goes when the mouth opens, metres."""


def morphs(data: MakeHuman, figure: Figure) -> dict[str, Array]:
    """The displacement of every vertex of the base mesh, metres, name -> (V, 3)."""
    moves = {}
    for name, units in MORPHS.items():
        moves[name] = np.zeros_like(data.base)
        for unit, share in units.items():
            moves[name] += figure.scale * share * data.target(f"{UNITS}/{unit}")
    # MakeHuman leaves the tongue where it was when the jaw drops.
    opened = moves["mouthOpen"]
    jaw = opened[np.unique(data.groups["helper-lower-teeth"].vertices)].mean(0)
    opened[np.unique(data.groups["helper-tongue"].vertices)] = jaw + np.array(TONGUE)
    return moves
