"""The skin that shows: head and neck with their morphs, and the arms from inside the sleeves."""

import numpy as np

from agent_server.web.tools.human.decimate import decimated
from agent_server.web.tools.human.figure import Figure
from agent_server.web.tools.human.makehuman import Array, MakeHuman, sampled
from agent_server.web.tools.human.mesh import Mesh, cut, normals, triangulated
from agent_server.web.tools.human.noise import step
from agent_server.web.tools.human.openings import SLEEVE, along_arm, from_neckline
from agent_server.web.tools.human.paint import PLAIN, unrolled
from agent_server.web.tools.human.scalp import above_eyes, above_hairline

UNDER_CLOTHES = 0.03
"""How far skin goes on under the collar, metres."""
BEHIND_LIPS = 0.125
"""What lies deeper inside the mouth may be coarse, metres in front of the x axis."""
UNDER_HAIR = 0.016
"""How far skin goes on under the hair, metres."""
HEAD_TRIANGLES, ARM_TRIANGLES = 5700, 2800


def body(data: MakeHuman, figure: Figure, moves: dict[str, Array]) -> Mesh:
    """The whole skin.

    Attributes: ``weights``, ``inner`` (1 inside the mouth), ``nail``, and each morph by name.
    """
    faces = data.groups["body"]
    uv = np.zeros((len(figure.positions), 2))
    uv[faces.vertices.reshape(-1)] = faces.uv.reshape(-1, 2)
    attributes = {
        "weights": figure.weights,
        "inner": sampled(data.mask("inside-mouth"), uv)[:, None],
        "nail": sampled(data.mask("fingernails"), uv)[:, None],
        **moves,
    }
    return triangulated(figure.positions, faces.vertices, attributes)


def head(skin: Mesh, figure: Figure) -> Mesh:
    """Head and neck, bald where the hair will be, with ``uv``, ``colour`` and ``normal``."""
    skin = cut(skin, UNDER_CLOTHES - from_neckline(skin, figure))
    skin = skin.with_attributes(normal=normals(skin.positions, skin.triangles))
    skin = cut(skin, UNDER_HAIR - above_hairline(skin.positions, figure))
    y = above_eyes(skin.positions, figure)
    front = step(0.05, 0.10, skin.positions[:, 2]) * step(-0.14, -0.12, y)
    inside = (skin["inner"][:, 0] > 0.9) & (skin.positions[:, 2] < BEHIND_LIPS)
    importance = 1 + 30 * front
    importance[inside] = 0.4
    skin = decimated(skin, HEAD_TRIANGLES, importance)
    inner = skin["inner"]
    colour = 1 - inner * (1 - np.array([0.55, 0.22, 0.20]))
    colour = np.concatenate([colour, np.ones_like(inner)], axis=1)
    return skin.with_attributes(uv=unrolled(skin.positions, figure), colour=colour)


def arms(skin: Mesh, figure: Figure) -> Mesh:
    """Both arms with their hands, with ``uv``, ``colour`` and ``normal``."""
    skin = skin.with_attributes(normal=normals(skin.positions, skin.triangles))
    skin = cut(skin, along_arm(skin, figure) - SLEEVE + 0.25)
    skin = decimated(skin, ARM_TRIANGLES, 1 + 8 * skin["nail"][:, 0])
    tips = sum(skin["weights"][:, k] for k, n in enumerate(figure.rig.names) if n[-1] in "23")
    red = (0.10 * np.asarray(tips))[:, None] + 0.06 * skin["nail"]
    colour = np.concatenate([1 - red * [0.1, 1.0, 1.0], np.ones_like(red)], axis=1)
    uv = np.tile(PLAIN, (len(skin.positions), 1))
    return skin.with_attributes(uv=uv, colour=colour)
