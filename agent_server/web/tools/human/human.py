"""Puts the human together: skin, eyes, hair and clothes, with their materials and soft shadows."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from agent_server.web.tools.human import cloth, eyes, face, hair, head, paint, shoes
from agent_server.web.tools.human.figure import read_figure
from agent_server.web.tools.human.glb import Part
from agent_server.web.tools.human.makehuman import Array, MakeHuman
from agent_server.web.tools.human.mesh import Mesh, cut, merged, normals
from agent_server.web.tools.human.noise import linear
from agent_server.web.tools.human.occlusion import openness
from agent_server.web.tools.human.rig import Rig
from agent_server.web.tools.human.tee import tee
from agent_server.web.tools.human.trousers import trousers

NOTICE = "Made from MakeHuman's base mesh, targets, rig and weights (CC0 1.0)"
MATERIALS: dict[str, tuple[str, float, dict[str, Any]]] = {
    "skin": ("#ffffff", 0.58, {"picture": "skin"}),
    "lashes": ("#0d0907", 0.8, {"alphaMode": "BLEND", "doubleSided": True}),
    "mouth": ("#ffffff", 0.4, {}),
    "eyes": ("#ffffff", 0.12, {"picture": "eye"}),
    "hair": ("#43301f", 0.85, {"doubleSided": True}),
    "tee": ("#6f8288", 0.92, {"doubleSided": True}),
    "trousers": ("#343943", 0.9, {"doubleSided": True}),
    "shoes": ("#5a4a3f", 0.7, {}),
    "soles": ("#d0ccc2", 0.8, {}),
    "socks": ("#22252b", 0.9, {}),
}
"""Name -> colour, roughness, and what else the material says."""
FINE, COARSE = 0.0018, 0.005
"""Cells of the soft shadows on the head and on the rest, metres."""
DEPTH = {"skin": 0.8, "hair": 0.45, "arms": 0.6, "tee": 0.75, "trousers": 0.75, "shoes": 0.6}
"""How dark the soft shadows are on each surface."""


@dataclass(frozen=True)
class Human:
    """All that the file holds.

    Attributes:
        rig: The bones.
        pictures: Name -> JPEG file.
        meshes: Name -> its surfaces.
    """

    rig: Rig
    pictures: dict[str, bytes]
    meshes: dict[str, list[Part]]


def build(data: MakeHuman) -> Human:
    """Make the human. It takes one or two minutes, and gives the same each time."""
    figure = read_figure(data)
    moves = face.morphs(data, figure)
    skin = head.body(data, figure, moves)
    tights = cloth.tights(data, figure)
    uppers, soles = shoes.shoes(data, figure)
    above = {"skin": head.head(skin, figure), "hair": hair.hair(skin, figure)}
    below = {
        "arms": head.arms(skin, figure),
        "tee": tee(tights, figure),
        "trousers": trousers(tights, figure),
        "shoes": uppers,
    }
    collar = cut(below["tee"], below["tee"].positions[:, 1] - figure.rig["LeftArm"][1])
    above = _shaded(above, [collar], FINE)
    below = _shaded(below, [soles], COARSE)
    lashes, mouth = eyes.lashes(data, figure, moves), eyes.mouth(data, figure, moves)
    return Human(
        figure.rig,
        {"skin": paint.skin_picture(data, figure), "eye": eyes.eye_picture()},
        {
            "Head": [
                _face(above["skin"], "skin", moves),
                _face(lashes, "lashes", moves),
                _face(mouth, "mouth", moves),
            ],
            "Eyes": [Part(eyes.eyes(data, figure), _material("eyes"))],
            "Hair": [Part(above["hair"], _material("hair"))],
            "Arms": [Part(below["arms"], _material("skin"))],
            "Clothes": [
                Part(below["tee"], _material("tee")),
                Part(below["trousers"], _material("trousers")),
                Part(below["shoes"], _material("shoes")),
                Part(soles, _material("soles")),
                Part(shoes.socks(tights), _material("socks")),
            ],
        },
    )


def _material(name: str) -> dict[str, Any]:
    colour, roughness, more = MATERIALS[name]
    surface: dict[str, Any] = {
        "baseColorFactor": [round(float(part), 4) for part in (*linear(colour), 1)],
        "metallicFactor": 0,
        "roughnessFactor": roughness,
    }
    more = dict(more)
    if "picture" in more:
        surface["picture"] = more.pop("picture")
    return {"name": name, "pbrMetallicRoughness": surface, **more}


def _face(mesh: Mesh, material: str, moves: dict[str, Array]) -> Part:
    """A surface with the morphs of the face."""
    rest = normals(mesh.positions, mesh.triangles)
    morphs = {}
    for name in moves:
        turned = normals(mesh.positions + mesh[name], mesh.triangles) - rest
        morphs[name] = np.concatenate([mesh[name], turned], axis=1)
    return Part(mesh, _material(material), morphs)


def _shaded(meshes: dict[str, Mesh], more: list[Mesh], cell: float) -> dict[str, Mesh]:
    """Surfaces whose colour is darker where little light comes past them and past others."""
    around = merged(mesh.only() for mesh in (*meshes.values(), *more))
    points = np.concatenate([mesh.positions for mesh in meshes.values()])
    out = np.concatenate([mesh["normal"] for mesh in meshes.values()])
    light = np.clip(openness(points, out, around, cell) / 0.9, 0, 1)
    shaded = {}
    for name, mesh in meshes.items():
        own, light = np.split(light, [len(mesh.positions)])
        tone = (1 - DEPTH[name] * (1 - own))[:, None]
        shaded[name] = mesh.with_attributes(
            colour=mesh["colour"] * np.concatenate([tone, tone, tone, np.ones_like(tone)], axis=1)
        )
    return shaded
