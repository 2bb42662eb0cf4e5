"""Eyeballs with a picture of the iris, eyelashes, teeth and tongue."""

import cv2
import numpy as np

from agent_server.web.tools.human.decimate import decimated
from agent_server.web.tools.human.figure import Figure
from agent_server.web.tools.human.makehuman import Array, MakeHuman
from agent_server.web.tools.human.mesh import Mesh, merged, normals, triangulated
from agent_server.web.tools.human.noise import bump, noise, step, unit
from agent_server.web.tools.human.rig import EYES

RINGS, AROUND = 10, 20
REACH = np.radians(112)
"""How far an eyeball reaches from its pole; what lies behind is never seen."""
IRIS = np.radians(24.5)
PUPIL = 0.40
"""Of the iris."""
CORNEA = 0.0009
"""How far it stands out, metres."""
SIZE = 256


def eyes(data: MakeHuman, figure: Figure) -> Mesh:
    """Both eyeballs, each on its bone, with ``uv``, ``normal`` and ``weights``."""
    return merged([_eyeball(data, figure, name) for name in EYES])


def eye_picture() -> bytes:
    """Paint the white, the iris and the pupil as seen from the front.

    Returns:
        A JPEG file.
    """
    row, column = np.mgrid[0:SIZE, 0:SIZE]
    x, y = (column + 0.5) / SIZE * 2 - 1, 1 - (row + 0.5) / SIZE * 2
    angle = np.hypot(x, y) * REACH
    turn = np.arctan2(y, x)
    inner = angle / IRIS
    ring = np.stack([np.cos(turn) * 9, np.sin(turn) * 9, inner * 1.2], axis=-1)
    fibres = noise(ring, 81) + 0.7 * noise(ring * [2.6, 2.6, 1.5], 82)
    iris = np.array([0.36, 0.24, 0.14]) * (0.85 + 0.30 * fibres)[..., None]
    iris = iris * (1 + 0.55 * step(0.75, 0.45, inner))[..., None]
    iris = iris * (1 - 0.72 * step(0.80, 1.0, inner))[..., None]
    white = np.array([0.86, 0.83, 0.80]) - 0.18 * step(0.9, 1.7, angle)[..., None] * [0.3, 1, 1]
    white = white * (1 - 0.10 * bump(((inner - 1) / 0.2) ** 2))[..., None]
    edge = step(0.94, 1.06, inner)[..., None]
    colours = iris * (1 - edge) + white * edge
    colours = colours * step(PUPIL - 0.04, PUPIL + 0.04, inner)[..., None] + 0.012
    picture = np.round(255 * np.clip(colours, 0, 1)).astype(np.uint8)[..., ::-1]
    done, packed = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, 90])
    if not done:
        raise RuntimeError("the picture of the eye could not be packed")
    return packed.tobytes()


def lashes(data: MakeHuman, figure: Figure, moves: dict[str, Array]) -> Mesh:
    """The eyelashes, which fade to their tips, with each morph by name."""
    names = [name for name in data.groups if "eyelashes" in name]
    quads = np.concatenate([data.groups[name].vertices for name in names])
    mesh = triangulated(figure.positions, quads, {"weights": figure.weights, **moves})
    skin = figure.positions[np.unique(data.groups["body"].vertices)]
    skin = skin[skin[:, 1] > figure.rig["Head"][1]]
    distance = np.sqrt(((mesh.positions[:, None] - skin[None]) ** 2).sum(2).min(1))
    upper = step(-0.004, 0.0, mesh.positions[:, 1] - figure.rig["LeftEye"][1])
    alpha = (0.35 + 0.55 * upper) * step(0.006, 0.0, distance)
    colour = np.concatenate([np.full((len(alpha), 3), 1.0), alpha[:, None]], axis=1)
    return mesh.with_attributes(normal=normals(mesh.positions, mesh.triangles), colour=colour)


def mouth(data: MakeHuman, figure: Figure, moves: dict[str, Array]) -> Mesh:
    """Teeth and tongue, with each morph by name."""
    parts = []
    for name, colour in (
        ("helper-upper-teeth", [0.50, 0.46, 0.40]),
        ("helper-lower-teeth", [0.36, 0.33, 0.28]),
        ("helper-tongue", [0.20, 0.06, 0.055]),
    ):
        quads = data.groups[name].vertices
        mesh = triangulated(figure.positions, quads, {"weights": figure.weights, **moves})
        paint = np.tile([*colour, 1.0], (len(mesh.positions), 1))
        out = normals(mesh.positions, mesh.triangles)
        mesh = mesh.with_attributes(normal=out, colour=paint)
        parts.append(decimated(mesh, int(0.6 * len(mesh.triangles))))
    return merged(parts)


def _eyeball(data: MakeHuman, figure: Figure, name: str) -> Mesh:
    helper = figure.positions[np.unique(data.groups[EYES[name]].vertices)]
    centre = figure.rig[name]
    radius = float(np.linalg.norm(helper - centre, axis=1).mean())
    angle = np.concatenate(
        [np.linspace(0, IRIS * 1.15, 6), np.linspace(IRIS * 1.6, REACH, RINGS - 6)]
    )
    turn = np.arange(AROUND) * 2 * np.pi / AROUND
    spread = np.sin(angle)[1:, None]
    ring = np.stack(
        [spread * np.cos(turn), spread * np.sin(turn), np.cos(angle)[1:, None] + 0 * turn], axis=2
    )
    direction = np.concatenate([[[0.0, 0.0, 1.0]], ring.reshape(-1, 3)])
    bulge = CORNEA * np.concatenate([[1.0], np.repeat(step(IRIS * 1.3, 0, angle[1:]), AROUND)])
    positions = centre + direction * (radius + bulge)[:, None]
    share = np.concatenate([[0.0], np.repeat(angle[1:] / REACH, AROUND)])
    flat = unit(direction * [1, 1, 0]) * share[:, None]
    uv = np.stack([0.5 + flat[:, 0] / 2, 0.5 - flat[:, 1] / 2], axis=1)
    k = np.arange(AROUND)
    following = (k + 1) % AROUND
    triangles = [np.stack([0 * k, 1 + k, 1 + following], axis=1)]
    for row in range(RINGS - 2):
        a, b = 1 + row * AROUND + k, 1 + row * AROUND + following
        triangles.append(np.stack([a, a + AROUND, b + AROUND], axis=1))
        triangles.append(np.stack([a, b + AROUND, b], axis=1))
    faces = np.concatenate(triangles)
    return Mesh(
        positions,
        faces,
        {
            "uv": uv,
            "normal": normals(positions, faces),
            "weights": figure.rig.only(name, len(positions)),
        },
    )
