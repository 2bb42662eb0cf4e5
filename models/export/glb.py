"""Writing two people's motion as a binary glTF 2.0 file: joints that move, with bones to be seen.

Every joint is a node below its parent and has a translation that is animated and no rotation:
positions alone do not tell how a bone is turned about itself. A bone is a node of its own below its
first joint, with a mesh that is turned and stretched to reach the second.
"""

import json
import struct
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32

COLOURS = ((0.55, 0.57, 0.6, 1.0), (0.16, 0.36, 0.68, 1.0))
"""Of the first and of the second person."""
_RADIUS, _BELLY = 0.04, 0.15
_FLOAT = 5126
_TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4"}


class _Buffer:
    """The arrays of a file, one behind the other, and the accessors that describe them."""

    def __init__(self) -> None:
        self.data = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []

    def add(self, values: NDArray[np.floating[Any]], bounds: bool = False) -> int:
        """Append float32 rows (N, C) or (N,); the index of their accessor."""
        rows = np.ascontiguousarray(values, "<f4").reshape(len(values), -1)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": rows.nbytes}
        accessor: dict[str, Any] = {
            "bufferView": len(self.views),
            "componentType": _FLOAT,
            "count": len(rows),
            "type": _TYPES[rows.shape[1]],
        }
        if bounds:
            accessor |= {"min": rows.min(0).tolist(), "max": rows.max(0).tolist()}
        self.data += rows.tobytes()
        self.views.append(view)
        self.accessors.append(accessor)
        return len(self.accessors) - 1


class _Scene:
    """Nodes and the channels that move them."""

    def __init__(self, buffer: _Buffer, times: int) -> None:
        self.buffer, self.times = buffer, times
        self.nodes: list[dict[str, Any]] = []
        self.samplers: list[dict[str, Any]] = []
        self.channels: list[dict[str, Any]] = []

    def add(self, parent: int | None, node: dict[str, Any], **moved: Float32) -> int:
        """A node whose ``moved`` properties are animated; its index."""
        at = len(self.nodes)
        self.nodes.append({**node, **{path: rows[0].tolist() for path, rows in moved.items()}})
        if parent is not None:
            self.nodes[parent].setdefault("children", []).append(at)
        for path, rows in moved.items():
            self.channels.append(
                {"sampler": len(self.samplers), "target": {"node": at, "path": path}}
            )
            self.samplers.append({"input": self.times, "output": self.buffer.add(rows)})
        return at


def write_glb(
    path: Path,
    names: Sequence[str],
    parents: Sequence[int],
    people: Sequence[Float32],
    rate_hz: float,
) -> None:
    """Write a motion.

    Args:
        path: The file.
        names: Name of each joint, J of them.
        parents: Index of each joint's parent, -1 for the one root.
        people: Of each person, at most two, the positions (T, J, 3), metres, y up.
        rate_hz: Frames a second.
    """
    buffer = _Buffer()
    frames = len(people[0])
    scene = _Scene(buffer, buffer.add(np.arange(frames) / rate_hz, bounds=True))
    corners, normals = _bone_mesh()
    attributes = {"POSITION": buffer.add(corners, bounds=True), "NORMAL": buffer.add(normals)}
    roots = [
        _add_person(scene, who, names, parents, positions) for who, positions in enumerate(people)
    ]
    document = {
        "asset": {"version": "2.0", "generator": "agent-server"},
        "scene": 0,
        "scenes": [{"nodes": roots}],
        "nodes": scene.nodes,
        "meshes": [
            {"primitives": [{"attributes": attributes, "material": who}]}
            for who in range(len(people))
        ],
        "materials": [
            {
                "pbrMetallicRoughness": {
                    "baseColorFactor": list(colour),
                    "metallicFactor": 0.0,
                    "roughnessFactor": 0.8,
                }
            }
            for colour in COLOURS[: len(people)]
        ],
        "animations": [
            {"name": "interaction", "samplers": scene.samplers, "channels": scene.channels}
        ],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.data)}],
    }
    path.write_bytes(_packed(document, bytes(buffer.data)))


def _add_person(
    scene: _Scene, who: int, names: Sequence[str], parents: Sequence[int], positions: Float32
) -> int:
    """The joints of a person and the bones between them; the index of the root."""
    prefix = ("first", "second")[who]
    placed: dict[int, int] = {}
    while len(placed) < len(names):  # parents before their children, in whatever order they come
        for joint, parent in enumerate(parents):
            if joint in placed or not (parent == -1 or parent in placed):
                continue
            above = positions[:, parent] if parent >= 0 else np.zeros_like(positions[:, joint])
            way = positions[:, joint] - above
            place = None if parent == -1 else placed[parent]
            name = {"name": f"{prefix}_{names[joint]}"}
            placed[joint] = scene.add(place, name, translation=way)
            if place is not None:
                bone = {"name": f"{prefix}_{names[parent]}_to_{names[joint]}", "mesh": who}
                scene.add(place, bone, rotation=_towards(way), scale=_stretched(way))
    return placed[list(parents).index(-1)]


def _towards(way: Float32) -> Float32:
    """Smallest rotations from +y to the ways (T, 3), unit quaternions x, y, z, w, (T, 4)."""
    x, y, z = (way / np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), 1e-9)).T
    turned = np.stack([z, np.zeros_like(x), -x, 1 + y], axis=-1)
    turned[1 + y < 1e-6] = (1.0, 0.0, 0.0, 0.0)  # straight down: half a turn about any axis
    unit: Float32 = (turned / np.linalg.norm(turned, axis=-1, keepdims=True)).astype(np.float32)
    return unit


def _stretched(way: Float32) -> Float32:
    """The scale (T, 3) that makes a bone of 1 m as long as the ways (T, 3)."""
    scale = np.ones_like(way)
    scale[:, 1] = np.linalg.norm(way, axis=-1)
    return scale


def _bone_mesh() -> tuple[Float32, Float32]:
    """Corners and normals (24, 3) of eight triangles: a bone from the origin to (0, 1, 0)."""
    ring = [(_RADIUS, _BELLY, 0.0), (0.0, _BELLY, -_RADIUS)]
    ring += [(-x, y, -z) for x, y, z in ring]
    corners = []
    for here, there in zip(ring, [*ring[1:], ring[0]], strict=True):
        corners += [(0.0, 1.0, 0.0), here, there, (0.0, 0.0, 0.0), there, here]
    triangles = np.array(corners, np.float32).reshape(8, 3, 3)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    return triangles.reshape(-1, 3), np.repeat(normals, 3, axis=0)


def _packed(document: dict[str, Any], data: bytes) -> bytes:
    """A GLB file of a JSON chunk and a binary one, each padded to four bytes."""
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    header = struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(data))
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    return header + chunks + struct.pack("<I4s", len(data), b"BIN\0") + data
