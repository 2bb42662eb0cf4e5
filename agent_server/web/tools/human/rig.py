"""Bones with Mixamo's names, and how much each vertex follows them."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from agent_server.web.tools.human.makehuman import Array, MakeHuman

EYES = {"LeftEye": "helper-l-eye", "RightEye": "helper-r-eye"}
PREFIX = "mixamorig"
"""Of every bone. Mixamo writes a colon after it, which three.js drops from names."""


@dataclass(frozen=True)
class Rig:
    """The skeleton at rest. No bone is turned: its axes are those of the world.

    Attributes:
        names: Parents before their children, (B,).
        parents: Index of each parent, -1 for the root, (B,).
        heads: Where each bone begins, metres, (B, 3).
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    heads: Array

    def __getitem__(self, name: str) -> Array:
        head: Array = self.heads[self.index(name)]
        return head

    def index(self, name: str) -> int:
        """Which bone has this name, written without its prefix."""
        return self.names.index(PREFIX + name)

    def only(self, name: str, count: int) -> Array:
        """Weights of vertices that follow one bone, (count, B)."""
        weights = np.zeros((count, len(self.names)))
        weights[:, self.index(name)] = 1
        return weights


def read_rig(data: MakeHuman, positions: Array) -> Rig:
    """Fit the Mixamo rig to a shape of the base mesh, and give it bones for the eyes.

    Args:
        data: MakeHuman's data.
        positions: Every vertex of the base mesh, (V, 3).
    """
    order: list[str] = []

    def add(bone: str) -> None:
        if bone and bone not in order:
            add(data.rig[bone]["parent"])
            order.append(bone)

    for bone in data.rig:
        add(bone)
    names = [bone.replace("mixamorig:", PREFIX) for bone in order]
    parents = [
        order.index(data.rig[bone]["parent"]) if data.rig[bone]["parent"] else -1 for bone in order
    ]
    places = [_place(data, positions, data.rig[bone]["head"]) for bone in order]
    for name, group in EYES.items():
        names.append(PREFIX + name)
        parents.append(names.index(f"{PREFIX}Head"))
        places.append(positions[np.unique(data.groups[group].vertices)].mean(0))
    heads = np.array(places)
    heads = (heads + heads[_across(names)] * [-1, 1, 1]) / 2
    return Rig(tuple(names), tuple(parents), heads)


def read_weights(data: MakeHuman, rig: Rig) -> Array:
    """The weights of every vertex of the base mesh, as much left as right, (V, B).

    A row sums to 1.
    """
    weights = np.zeros((len(data.base), len(rig.names)))
    for bone, pairs in data.weights.items():
        index = rig.names.index(bone.replace("mixamorig:", PREFIX))
        for vertex, weight in pairs:
            weights[vertex, index] = weight
    weights = (weights + weights[data.mirror][:, _across(rig.names)]) / 2
    sums = weights.sum(1, keepdims=True)
    # What no bone moves are helpers of the head: eyes, lashes, teeth and tongue.
    weights = np.where(sums > 0, weights / np.maximum(sums, 1e-9), rig.only("Head", len(weights)))
    for name, group in EYES.items():
        vertices = np.unique(data.groups[group].vertices)
        weights[vertices] = rig.only(name, len(vertices))
    return weights


def _place(data: MakeHuman, positions: Array, end: dict[str, Any]) -> Array:
    """Where one end of a bone lies."""
    match end["strategy"]:
        case "MEAN":
            vertices = end["vertex_indices"]
        case "CUBE":
            vertices = np.unique(data.groups[end["cube_name"]].vertices)
        case strategy:
            raise ValueError(f"the rig places a bone by {strategy}, which is unknown here")
    place: Array = positions[vertices].mean(0)
    return place


def _across(names: Sequence[str]) -> list[int]:
    """The bone on the other side of each bone."""
    sides = {"Left": "Right", "Right": "Left"}
    return [names.index(re.sub("Left|Right", lambda side: sides[side[0]], name)) for name in names]
