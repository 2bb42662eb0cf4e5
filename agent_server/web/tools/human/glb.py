"""Writes a rigged human as binary glTF 2.0, without any extension."""

import json
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from agent_server.web.tools.human.makehuman import Array
from agent_server.web.tools.human.mesh import Mesh
from agent_server.web.tools.human.noise import unit
from agent_server.web.tools.human.rig import Rig

COMPONENTS = {"float32": 5126, "uint32": 5125, "uint16": 5123, "uint8": 5121}
SHAPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 2: "VEC2", 16: "MAT4"}
SAMPLER = {"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071}
"""Smooth, and clamped at the edges."""
VERTICES, INDICES = 34962, 34963
STILL = 1e-5
"""Metres: a vertex that a morph moves by less is left out of it."""


@dataclass(frozen=True)
class Part:
    """A surface with one material.

    Attributes:
        mesh: With the attributes ``normal``, ``weights`` and perhaps ``colour`` and ``uv``.
        material: As glTF writes it.
        morphs: Name -> displacement of each vertex, metres, and of its normal, (N, 6).
    """

    mesh: Mesh
    material: dict[str, Any]
    morphs: dict[str, Array] = field(default_factory=dict)


class Writer:
    """Collects what a GLB file holds."""

    def __init__(self, rig: Rig, pictures: dict[str, bytes], notice: str) -> None:
        """Begin with the bones and the pictures.

        Args:
            rig: The skeleton.
            pictures: Name -> JPEG or PNG file. Materials name them as their texture.
            notice: Whose work it is.
        """
        self._data = bytearray()
        self._pictures = {name: k for k, name in enumerate(pictures)}
        bones = len(rig.names)
        inverse = np.tile(np.eye(4), (bones, 1, 1))
        inverse[:, 3, :3] = -rig.heads  # columns first
        self._document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "agent-server", "copyright": notice},
            "scene": 0,
            "scenes": [{"nodes": [rig.parents.index(-1)]}],
            "nodes": _bones(rig),
            "meshes": [],
            "materials": [],
            "accessors": [],
            "bufferViews": [],
        }
        if pictures:
            self._document["images"] = [
                {
                    "name": name,
                    "mimeType": "image/png" if data.startswith(b"\x89PNG") else "image/jpeg",
                    "bufferView": self._view(data),
                }
                for name, data in pictures.items()
            ]
            self._document["samplers"] = [SAMPLER]
            self._document["textures"] = [{"source": k, "sampler": 0} for k in range(len(pictures))]
        self._document["skins"] = [
            {
                "joints": list(range(bones)),
                "skeleton": rig.parents.index(-1),
                "inverseBindMatrices": self._accessor(inverse.reshape(-1, 16).astype(np.float32)),
            }
        ]

    def add(self, name: str, parts: list[Part]) -> None:
        """Add a mesh that follows the bones.

        Args:
            name: Of the node and the mesh.
            parts: Its surfaces; all have the same morphs.
        """
        mesh: dict[str, Any] = {"name": name, "primitives": [self._primitive(p) for p in parts]}
        names = list(parts[0].morphs)
        if names:
            mesh["extras"] = {"targetNames": names}
            mesh["weights"] = [0] * len(names)
        document = self._document
        document["meshes"].append(mesh)
        document["nodes"].append({"name": name, "mesh": len(document["meshes"]) - 1, "skin": 0})
        document["scenes"][0]["nodes"].append(len(document["nodes"]) - 1)

    def write(self, path: Path) -> None:
        """Write the file."""
        self._pad()
        self._document["buffers"] = [{"byteLength": len(self._data)}]
        text = json.dumps(self._document, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        path.write_bytes(
            struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self._data))
            + struct.pack("<I4s", len(text), b"JSON")
            + text
            + struct.pack("<I4s", len(self._data), b"BIN\0")
            + self._data
        )

    def _primitive(self, part: Part) -> dict[str, Any]:
        mesh = part.mesh
        joints, weights = _four_bones(mesh["weights"])
        attributes = {
            "POSITION": self._accessor(mesh.positions.astype(np.float32), VERTICES, bounds=True),
            "NORMAL": self._accessor(unit(mesh["normal"]).astype(np.float32), VERTICES),
            "JOINTS_0": self._accessor(joints, VERTICES),
            "WEIGHTS_0": self._accessor(weights, VERTICES, normalized=True),
        }
        if "colour" in mesh.attributes:
            colours = np.round(255 * np.clip(mesh["colour"], 0, 1)).astype(np.uint8)
            attributes["COLOR_0"] = self._accessor(colours, VERTICES, normalized=True)
        if "uv" in mesh.attributes:
            uv = np.round(65535 * np.clip(mesh["uv"], 0, 1)).astype(np.uint16)
            attributes["TEXCOORD_0"] = self._accessor(uv, VERTICES, normalized=True)
        primitive: dict[str, Any] = {
            "attributes": attributes,
            "indices": self._accessor(mesh.triangles.reshape(-1, 1).astype(np.uint16), INDICES),
            "material": self._material(part.material),
        }
        if part.morphs:
            primitive["targets"] = [
                {"POSITION": self._sparse(move[:, :3]), "NORMAL": self._sparse(move[:, 3:])}
                for move in part.morphs.values()
            ]
        return primitive

    def _material(self, material: dict[str, Any]) -> int:
        surface = dict(material["pbrMetallicRoughness"])
        picture = surface.pop("picture", None)
        if picture is not None:
            surface["baseColorTexture"] = {"index": self._pictures[picture]}
        written = {**material, "pbrMetallicRoughness": surface}
        materials = self._document["materials"]
        if written not in materials:
            materials.append(written)
        return int(materials.index(written))

    def _accessor(
        self,
        values: NDArray[Any],
        target: int | None = None,
        *,
        normalized: bool = False,
        bounds: bool = False,
    ) -> int:
        view = self._view(values.tobytes(), target)
        accessor = _described(values) | {"bufferView": view}
        if normalized:
            accessor["normalized"] = True
        if bounds:
            accessor["min"], accessor["max"] = values.min(0).tolist(), values.max(0).tolist()
        self._document["accessors"].append(accessor)
        return len(self._document["accessors"]) - 1

    def _sparse(self, moves: Array) -> int:
        """An accessor that is zero but for what moves."""
        values = moves.astype(np.float32)
        vertices = np.flatnonzero(np.abs(values).max(1) > STILL)
        accessor = _described(values)
        accessor["min"], accessor["max"] = values.min(0).tolist(), values.max(0).tolist()
        if len(vertices):
            accessor["sparse"] = {
                "count": len(vertices),
                "indices": {
                    "bufferView": self._view(vertices.astype(np.uint16).tobytes()),
                    "componentType": COMPONENTS["uint16"],
                },
                "values": {"bufferView": self._view(values[vertices].tobytes())},
            }
        self._document["accessors"].append(accessor)
        return len(self._document["accessors"]) - 1

    def _view(self, data: bytes, target: int | None = None) -> int:
        self._pad()
        view = {"buffer": 0, "byteOffset": len(self._data), "byteLength": len(data)}
        if target is not None:
            view["target"] = target
        self._data += data
        self._document["bufferViews"].append(view)
        return len(self._document["bufferViews"]) - 1

    def _pad(self) -> None:
        self._data += bytes(-len(self._data) % 4)


def _described(values: NDArray[Any]) -> dict[str, Any]:
    return {
        "componentType": COMPONENTS[values.dtype.name],
        "count": len(values),
        "type": SHAPES[values.shape[1]],
    }


def _bones(rig: Rig) -> list[dict[str, Any]]:
    nodes: list[dict[str, Any]] = []
    for name, parent, head in zip(rig.names, rig.parents, rig.heads, strict=True):
        place = head - rig.heads[parent] if parent >= 0 else head
        nodes.append({"name": name, "translation": np.round(place, 6).tolist()})
        if parent >= 0:
            nodes[parent].setdefault("children", []).append(len(nodes) - 1)
    return nodes


def _four_bones(weights: Array) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """The four bones that move a vertex most, and their shares of 255."""
    joints = np.argsort(-weights, axis=1, kind="stable")[:, :4]
    shares = np.take_along_axis(weights, joints, axis=1)
    shares = 255 * shares / shares.sum(1, keepdims=True)
    whole = np.floor(shares).astype(int)
    # The rest goes where most was cut off, so that the sum stays 255.
    rank = np.argsort(np.argsort(whole - shares, axis=1, kind="stable"), axis=1, kind="stable")
    whole += rank < (255 - whole.sum(1, keepdims=True))
    joints = np.where(whole > 0, joints, 0)
    return joints.astype(np.uint8), whole.astype(np.uint8)
