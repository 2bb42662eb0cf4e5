"""Features and labels to train on, for each way in which a face is given."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from agent_server.domain.arrays import Float32
from agent_server.domain.face import ARKIT_BLENDSHAPES
from agent_server.face.features import (
    SHARED_POINTS,
    blendshape_features,
    mesh_features,
    points68_features,
)
from agent_server.face.layouts import MIRROR_DLIB68, to_dlib68
from models.affect.config import Source
from models.affect.views import MIRRORED, PLAIN, Views
from models.data.afew_va import AfewVa

Indices = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Mirror:
    """What a mirrored face does to its features.

    Attributes:
        order: Of each feature, which one it becomes.
        signs: By what it is multiplied.
    """

    order: Indices
    signs: Float32


@dataclass(frozen=True, slots=True)
class FaceFeatures:
    """Faces as a model sees them.

    Attributes:
        features: Shape (N, V, D): the views of each face, the plain one first.
        found: Shape (N, V): whether a view shows a face at all.
        affect: Shape (N, 2): valence and arousal on [-1, 1].
        people: Shape (N,): a number for each person; validation keeps a person's faces together.
        mirror: What a mirrored face does to the features.
    """

    features: Float32
    found: NDArray[np.bool_]
    affect: Float32
    people: Indices
    mirror: Mirror

    def take(self, indices: Indices) -> "FaceFeatures":
        """Some of the faces."""
        return FaceFeatures(
            self.features[indices],
            self.found[indices],
            self.affect[indices],
            self.people[indices],
            self.mirror,
        )

    def folds(self, count: int, seed: int) -> Iterator[tuple[Indices, Indices]]:
        """Indices to train on and to validate on, ``count`` times, with whole people."""
        people = np.random.default_rng(seed).permutation(np.unique(self.people))
        for part in np.array_split(people, count):
            held_out = np.isin(self.people, part)
            yield np.flatnonzero(~held_out), np.flatnonzero(held_out)


def features_of(source: Source, views: Views, affect: Float32) -> FaceFeatures:
    """What a model of ``source`` sees of the views.

    No two pictures are taken to show one person.
    """
    found = views.found
    match source:
        case "mesh":
            seen = mesh_features(views.mesh[found])
        case "points68":
            # Other programs place the 68 points otherwise than one network does, or two.
            meshes = np.concatenate((views.mesh[:, :, :SHARED_POINTS], views.fast), axis=1)
            found = np.concatenate((found, found), axis=1)
            seen = points68_features(to_dlib68(meshes[found]))
        case "blendshapes":
            seen = blendshape_features(views.shapes[found])
    features = np.zeros((*found.shape, seen.shape[1]), dtype=np.float32)
    features[found] = seen
    mirror = {"mesh": _mesh_mirror, "points68": _points68_mirror, "blendshapes": _shapes_mirror}
    people = np.arange(len(affect))
    return FaceFeatures(features, found, affect, people, mirror[source](features, found))


def features_of_clips(clips: AfewVa) -> FaceFeatures:
    """What a model of 68 points sees of film clips: one view a frame."""
    features = points68_features(clips.points)[:, None]
    found = np.ones(features.shape[:2], dtype=np.bool_)
    people = np.unique(clips.actors, return_inverse=True)[1]
    mirror = _points68_mirror(features, found)
    return FaceFeatures(features, found, clips.affect, people, mirror)


def _mesh_mirror(features: Float32, found: NDArray[np.bool_]) -> Mirror:
    """Which point becomes which, found by mirroring the pictures: nobody has to list 468 pairs."""
    both = found[:, PLAIN] & found[:, MIRRORED]
    plain = features[both, PLAIN].mean(axis=0).reshape(-1, 2) * (-1, 1)
    mirrored = features[both, MIRRORED].mean(axis=0).reshape(-1, 2)
    distances = np.linalg.norm(mirrored[:, None] - plain[None], axis=-1)
    return _point_mirror(linear_sum_assignment(distances)[1])


def _points68_mirror(features: Float32, found: NDArray[np.bool_]) -> Mirror:
    return _point_mirror(MIRROR_DLIB68)


def _shapes_mirror(features: Float32, found: NDArray[np.bool_]) -> Mirror:
    names = ARKIT_BLENDSHAPES[: features.shape[-1]]
    sides = {"Left": "Right", "Right": "Left"}
    other = [
        next((n.removesuffix(s) + o for s, o in sides.items() if n.endswith(s)), n) for n in names
    ]
    order = np.array([names.index(name) for name in other])
    return Mirror(order, np.ones(len(names), dtype=np.float32))


def _point_mirror(order: Indices) -> Mirror:
    """Of points whose x and y are features."""
    pairs = np.stack((2 * order, 2 * order + 1), axis=1).reshape(-1)
    return Mirror(pairs, np.tile(np.array((-1.0, 1.0), dtype=np.float32), len(order)))
