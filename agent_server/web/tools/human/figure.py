"""The person: which of MakeHuman's targets shape the body, and how tall it stands."""

from dataclasses import dataclass

import numpy as np

from agent_server.web.tools.human.makehuman import Array, MakeHuman
from agent_server.web.tools.human.rig import Rig, read_rig, read_weights

SHAPE = {
    "macrodetails/universal-male-young-averagemuscle-averageweight": 1.0,
    "macrodetails/caucasian-male-young": 0.5,
    "macrodetails/african-male-young": 0.15,
    "macrodetails/asian-male-young": 0.35,
    "expression/units/caucasian/mouth-open": -0.035,  # else the teeth show between the lips
}
HEIGHT = 1.75
"""Metres, without shoes and hair."""
SOLE = 0.024
"""Metres from the floor to the bare foot."""


@dataclass(frozen=True)
class Figure:
    """The undressed body with its helpers, standing in its shoes on y = 0.

    Attributes:
        positions: Every vertex of the base mesh, metres, (V, 3).
        scale: What targets must be multiplied by.
        weights: How far it follows each bone, (V, B).
        rig: The bones.
    """

    positions: Array
    scale: float
    weights: Array
    rig: Rig


def read_figure(data: MakeHuman) -> Figure:
    """Shape the base mesh into the person and fit the bones to it."""
    positions = data.base + sum(share * data.target(name) for name, share in SHAPE.items())
    body = np.unique(data.groups["body"].vertices)
    low, high = positions[body, 1].min(), positions[body, 1].max()
    scale = HEIGHT / (high - low)
    positions = (positions - [0.0, low, 0.0]) * scale + [0.0, SOLE, 0.0]
    rig = read_rig(data, positions)
    return Figure(positions, scale, read_weights(data, rig), rig)
