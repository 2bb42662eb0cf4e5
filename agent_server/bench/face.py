"""What one image of a face costs, stage by stage, on one thread."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import cv2
import numpy as np

from agent_server import assets
from agent_server.bench.figures import Percentiles, percentiles, resident_mb
from agent_server.domain.affect import AffectSample
from agent_server.domain.face import FaceLandmarks, FaceLayout
from agent_server.errors import InvalidInput
from agent_server.face.blendshapes import FaceBlendshaper
from agent_server.face.detector import FaceDetector
from agent_server.face.features import mesh_features
from agent_server.face.image import Pixels, decode_jpeg, use_one_thread
from agent_server.face.mesh import FaceMesh, Mesh
from agent_server.face.regions import region_of_points
from agent_server.face.tracker import FaceTracker
from agent_server.inference.runtime import OnnxAffect, OnnxFaceNetwork
from agent_server.service.loading import DETECTOR, MESHES
from agent_server.synthetic.face import SyntheticFace
from agent_server.synthetic.portrait import portrait

WIDTH, HEIGHT = 640, 480
WARM_UP = 5
BLENDSHAPES = "face_blendshapes"
_Result = TypeVar("_Result")


@dataclass(frozen=True, slots=True)
class MeshTimes:
    """Times with one of the two meshes.

    Attributes:
        crop: Cut the region out of the image.
        mesh: The same, and find its points.
        blendshapes: Read 52 shapes off the points; None where the mesh has too few for them.
        affect: Read valence and arousal off the points.
        frame: A whole image of a face that is followed, once decoded: all of these.
    """

    crop: Percentiles
    mesh: Percentiles
    blendshapes: Percentiles | None
    affect: Percentiles
    frame: Percentiles


@dataclass(frozen=True, slots=True)
class FaceResult:
    """Times of the face pipeline.

    Attributes:
        width: Of the image, in pixels.
        height: Of the image, in pixels.
        picture: What was looked at: a file, or ``painted``.
        decode: From JPEG to pixels.
        detect: Find faces in the whole image; only while none is followed.
        meshes: ``full`` (478 points) and ``fast`` (468) -> their times.
        rounds: How often each was measured.
        rss_mb: Resident memory of this process with all its networks, in MB; None where it is
            not known.
    """

    width: int
    height: int
    picture: str
    decode: Percentiles
    detect: Percentiles
    meshes: dict[str, MeshTimes]
    rounds: int
    rss_mb: float | None


def measure_faces(picture: Path | None, rounds: int) -> FaceResult:
    """Look at one picture again and again.

    Args:
        picture: A file with a face; None paints one.
        rounds: How often.

    Raises:
        InvalidInput: If the picture cannot be read or shows no face.
        BundleError: If a bundle is missing, altered or wrong.
    """
    use_one_thread()
    bundles = assets.bundles()
    image = _painted() if picture is None else _framed(picture)
    detector = OnnxFaceNetwork(bundles / DETECTOR, "detector")
    networks = {name: OnnxFaceNetwork(bundles / MESHES[name], "mesh") for name in MESHES}
    shapes = FaceBlendshaper(OnnxFaceNetwork(bundles / BLENDSHAPES, "blendshapes"))
    affect = OnnxAffect(bundles / "affect_mesh", "mesh")
    jpeg = cv2.imencode(".jpg", cv2.cvtColor(image, cv2.COLOR_RGB2BGR))[1].tobytes()
    image, decode = _timed(lambda: decode_jpeg(jpeg), rounds)
    _, detect = _timed(lambda: FaceDetector(detector).detect(image), rounds)
    return FaceResult(
        width=WIDTH,
        height=HEIGHT,
        picture="painted" if picture is None else str(picture),
        decode=decode,
        detect=detect,
        meshes={
            name: _with_mesh(image, detector, network, shapes, affect, rounds)
            for name, network in networks.items()
        },
        rounds=rounds,
        rss_mb=resident_mb(os.getpid()),
    )


def _with_mesh(
    image: Pixels,
    detector: OnnxFaceNetwork,
    network: OnnxFaceNetwork,
    shapes: FaceBlendshaper,
    affect: OnnxAffect,
    rounds: int,
) -> MeshTimes:
    tracker, mesh = FaceTracker(detector, network), FaceMesh(network)

    def whole() -> Mesh | None:
        found = tracker.look(image)
        if found is not None:
            if found.layout is FaceLayout.MESH478:
                shapes.read(found.points)
            affect.estimate(mesh_features(found.points)[None])
        return found

    found, frame = _timed(whole, rounds)
    if found is None:
        raise InvalidInput("no face is found in the picture: give one that shows a face")
    region, points = region_of_points(found.points), found.points
    has_shapes = found.layout is FaceLayout.MESH478
    return MeshTimes(
        crop=_timed(lambda: region.crop(image, network.input_shape[1]), rounds)[1],
        mesh=_timed(lambda: mesh.look(image, region), rounds)[1],
        blendshapes=_timed(lambda: shapes.read(points), rounds)[1] if has_shapes else None,
        affect=_timed(lambda: affect.estimate(mesh_features(points)[None]), rounds)[1],
        frame=frame,
    )


def _timed(call: Callable[[], _Result], rounds: int) -> tuple[_Result, Percentiles]:
    """What a call gives, and what it takes once it has been warmed up."""
    for _ in range(WARM_UP):
        result = call()
    times = []
    for _ in range(rounds):
        began = time.perf_counter_ns()
        result = call()
        times.append((time.perf_counter_ns() - began) / 1e6)
    return result, percentiles(times)


def _painted() -> Pixels:
    person = SyntheticFace(np.random.default_rng(0))
    face = person.show(AffectSample(0, 0.0, 0.0), FaceLayout.MESH478.value)
    if not isinstance(face, FaceLandmarks):
        raise TypeError("a face of points was asked for")
    return portrait(face.points, WIDTH, HEIGHT)


def _framed(path: Path) -> Pixels:
    """A picture as large as fits, at the centre of a grey one of 640 x 480."""
    given = cv2.imread(str(path), cv2.IMREAD_COLOR_RGB) if path.exists() else None
    if given is None:
        raise InvalidInput(f"{path} cannot be read: name a picture, such as a JPEG or PNG")
    height, width = given.shape[:2]
    scale = min(WIDTH / width, HEIGHT / height)
    wide, high = max(1, int(width * scale)), max(1, int(height * scale))
    framed = np.full((HEIGHT, WIDTH, 3), 90, dtype=np.uint8)
    x, y = (WIDTH - wide) // 2, (HEIGHT - high) // 2
    framed[y : y + high, x : x + wide] = cv2.resize(
        given, (wide, high), interpolation=cv2.INTER_AREA
    )
    return framed
