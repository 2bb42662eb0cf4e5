"""What the face pipeline makes of pictures, and of the same pictures seen otherwise.

Points scatter by the camera, the light and the place of the face. Each picture is therefore
looked at several times: as it is, mirrored, and turned, moved, scaled, lit and blurred by
kornia; the points that come of it are what models are trained on.
"""

import hashlib
from dataclasses import dataclass
from pathlib import Path

import kornia.augmentation as aug
import numpy as np
import torch
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32
from agent_server.face.blendshapes import FaceBlendshaper
from agent_server.face.image import Pixels
from agent_server.face.mesh import FaceMesh
from agent_server.face.regions import region_of_points
from agent_server.face.tracker import FaceTracker
from agent_server.inference.manifest import MODEL_FILE, FaceManifest, read_manifest
from models.data.labelled_faces import LabelledFaces
from models.ops.session import OnnxModel

VIEWS = 12
PLAIN, MIRRORED = 0, 1
SETTLE = 2
"""Looks at a still picture: the second starts from points, as in a video."""


class Network:
    """A face network of a bundle, for use outside the server."""

    def __init__(self, folder: Path) -> None:
        manifest = read_manifest(folder, FaceManifest)
        self.name = manifest.name
        self.sha256 = manifest.files[MODEL_FILE]
        self.input_shape = tuple(manifest.input_shape)
        self._model = OnnxModel(folder / MODEL_FILE)

    def run(self, given: Float32) -> dict[str, Float32]:
        """Run the network."""
        return self._model.named(given)


class Pipeline:
    """The server's face pipeline on still pictures.

    Args:
        bundles: Folder of the face networks' bundles.
    """

    def __init__(self, bundles: Path) -> None:
        detector, mesh = Network(bundles / "face_detector"), Network(bundles / "face_mesh")
        self._tracker = FaceTracker(detector, mesh)
        self._fast = FaceMesh(Network(bundles / "face_mesh_fast"))
        self._shapes = FaceBlendshaper(Network(bundles / "face_blendshapes"))
        networks = (detector, mesh)
        self.key = hashlib.sha256("".join(n.sha256 for n in networks).encode()).hexdigest()[:12]

    def points(self, image: Pixels) -> Float32 | None:
        """The 478 points of the largest face, or None."""
        self._tracker.reset()
        found = None
        for _ in range(SETTLE):
            found = self._tracker.look(image)
        return None if found is None else found.points

    def fast_points(self, image: Pixels, points: Float32) -> Float32:
        """The 468 points of the fast network, where ``points`` say that the face is."""
        return self._fast.look(image, region_of_points(points)).points

    def shapes(self, points: Float32) -> Float32:
        """Blendshapes of 478 points."""
        return self._shapes.read(points)


@dataclass(frozen=True, slots=True)
class Views:
    """Faces as the pipeline found them; what was not found is zero.

    Attributes:
        mesh: Shape (N, V, 478, 3), in pixels.
        fast: Shape (N, V, 468, 3), in pixels.
        shapes: Shape (N, V, 52).
        found: Shape (N, V).
    """

    mesh: Float32
    fast: Float32
    shapes: Float32
    found: NDArray[np.bool_]


def look_at(faces: LabelledFaces, pipeline: Pipeline, cache: Path, views: int = VIEWS) -> Views:
    """All views of all pictures; kept in ``cache``, as they take some minutes.

    Raises:
        InvalidInput: If a picture is missing.
    """
    names = hashlib.sha256("\n".join(faces.files).encode()).hexdigest()[:12]
    path = cache / f"faces-{names}-{pipeline.key}-{views}.npz"
    if path.exists():
        with np.load(path) as kept:
            return Views(**{name: kept[name] for name in Views.__dataclass_fields__})
    count = len(faces.files)
    made = Views(
        np.zeros((count, views, 478, 3), np.float32),
        np.zeros((count, views, 468, 3), np.float32),
        np.zeros((count, views, 52), np.float32),
        np.zeros((count, views), np.bool_),
    )
    for index in range(count):
        for view, image in enumerate(_seen_otherwise(faces.picture(index), views, index)):
            points = pipeline.points(image)
            if points is not None:
                made.mesh[index, view] = points
                made.fast[index, view] = pipeline.fast_points(image, points)
                made.shapes[index, view] = pipeline.shapes(points)
                made.found[index, view] = True
    cache.mkdir(parents=True, exist_ok=True)
    np.savez(path, **{name: getattr(made, name) for name in Views.__dataclass_fields__})
    return made


def _seen_otherwise(image: Pixels, views: int, seed: int) -> list[Pixels]:
    """The picture, its mirror image, and random variations."""
    # A generator of its own: kornia draws from torch's.
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        given = torch.from_numpy(image).permute(2, 0, 1).float()[None] / 255
        varied = _CHANGES(given.repeat(max(0, views - 2), 1, 1, 1)).clamp(0, 1)
    pictures = (varied * 255).round().byte().permute(0, 2, 3, 1).numpy()
    return [image, np.ascontiguousarray(image[:, ::-1]), *pictures][:views]


_CHANGES = aug.ImageSequential(
    aug.RandomHorizontalFlip(p=0.5),
    aug.RandomAffine(
        degrees=20.0, translate=(0.07, 0.07), scale=(0.6, 1.3), padding_mode="border", p=1.0
    ),
    aug.ColorJiggle(brightness=(0.85, 1.12), contrast=(0.8, 1.2), saturation=(0.8, 1.2), p=1.0),
    aug.RandomGaussianBlur((5, 5), (0.5, 1.5), p=0.3),
    aug.RandomGaussianNoise(mean=0.0, std=0.02, p=0.5),
)
