"""The manifest of a model bundle: what a model expects, what it is, and how it was made.

A bundle is a folder ``NAME/`` with ``model.onnx``, ``manifest.json``, ``golden.npz`` (an input
and the output that the model must give for it, under their names in the graph) and ``CARD.md``.
"""

import hashlib
from pathlib import Path
from typing import Any, Literal, TypeVar, overload

import msgspec

from agent_server.domain.reaction import TrainingRange
from agent_server.errors import BundleError

FORMAT_VERSION = 1
MODEL_FILE = "model.onnx"
GOLDEN_FILE = "golden.npz"
CARD_FILE = "CARD.md"
MANIFEST_FILE = "manifest.json"
SkeletonName = Literal["core9", "h36m22", "cmu25", "kinect15"]
HASHED_FILES = (MODEL_FILE, GOLDEN_FILE, CARD_FILE)


class DataSource(msgspec.Struct, frozen=True):
    """One set that a model was trained on."""

    name: str
    licence: str
    synthetic: bool


class Training(msgspec.Struct, frozen=True):
    """How a model was made."""

    command: str
    seed: int
    data: list[DataSource]
    wall_s: float
    hardware: str


class Manifest(msgspec.Struct, frozen=True):
    """What every ``manifest.json`` holds.

    Attributes:
        format_version: Version of this layout.
        name: Name of the bundle, the same as its folder's.
        version: Version of the model.
        task: What it can do.
        opset: ONNX operator set.
        parameters: Number of trained parameters.
        batch_exact: Whether a row of a batch has the bits of a batch of one.
        files: File name -> SHA-256 in hexadecimal.
        licence: Licence of the weights.
        results: Measured figures, by name.
    """

    format_version: int
    name: str
    version: str
    task: str
    opset: int
    parameters: int
    batch_exact: bool
    files: dict[str, str]
    licence: str
    results: dict[str, Any]


class MotionManifest(Manifest, frozen=True):
    """The manifest of a model of motion.

    Attributes:
        task: ``predict`` (seen -> future positions), ``sample`` (seen and the index of a draw ->
            future positions and quality) or ``classify`` (motion -> probabilities).
        skeleton: ``core9``, the one that the server runs, or that of a research model.
        rate_hz: Frames a second of input and output.
        input_frames: Frames the model takes.
        output_frames: Frames it gives (0 for a classifier).
        labels: Class names in output order (empty for a predictor).
        normaliser: ``navel_last_seen``: metres, origin at the navel of the last seen frame;
            ``root``: metres, origin at the root, which neither moves nor turns.
        training: How it was made.
        draws: Futures that a sampler can draw of one motion.
    """

    task: Literal["predict", "sample", "classify"]
    skeleton: SkeletonName
    rate_hz: int
    input_frames: int
    output_frames: int
    labels: list[str]
    normaliser: Literal["navel_last_seen", "root"]
    training: Training
    draws: int = 0


class Origin(msgspec.Struct, frozen=True):
    """Where converted weights come from."""

    package: str
    version: str
    sha256: str
    file: str


class FaceManifest(Manifest, frozen=True):
    """The manifest of a network of the face pipeline.

    Attributes:
        task: ``face``.
        role: What it finds.
        input_shape: Of its one input: images (1, height, width, 3) RGB, or points (1, N, 2).
        input_range: Smallest and largest value of an image's pixels; None for points.
        outputs: Output name -> shape.
        origin: Where the weights come from.
    """

    task: Literal["face"]
    role: Literal["detector", "mesh", "blendshapes"]
    input_shape: list[int]
    input_range: tuple[float, float] | None
    outputs: dict[str, list[int]]
    origin: Origin


class AffectManifest(Manifest, frozen=True):
    """The manifest of a model that reads affect: features -> valence, arousal and deviations.

    Attributes:
        task: ``affect``.
        source: What a face is given as.
        features: Number of features, as :mod:`agent_server.face.features` makes them.
        training: How it was made.
    """

    task: Literal["affect"]
    source: Literal["mesh", "points68", "blendshapes"]
    features: int
    training: Training


class ReactionManifest(Manifest, frozen=True):
    """The manifest of a generator of reactions, whose encoder is a file beside ``model.onnx``.

    Attributes:
        task: ``react`` (the action and the first pose of a reaction -> the reaction).
        skeleton: Joints of both people.
        rate_hz: Frames a second.
        frames: Longest action that is read at once.
        latent: Size of the noise.
        labels: What the people of the training set do.
        training: How it was made.
        range: What the reactions of the training set are like.
    """

    task: Literal["react"]
    skeleton: SkeletonName
    rate_hz: int
    frames: int
    latent: int
    labels: list[str]
    training: Training
    range: TrainingRange


class _Task(msgspec.Struct, frozen=True):
    """Enough of a manifest to tell which kind it is."""

    task: str


KindOfManifest = TypeVar("KindOfManifest", bound=Manifest)


def sha256_of(path: Path) -> str:
    """SHA-256 of a file in hexadecimal."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def read_task(folder: Path) -> str:
    """What the model of the bundle in ``folder`` can do.

    Raises:
        BundleError: If there is no manifest, or none that says so.
    """
    return _decoded(folder, _Task).task


@overload
def read_manifest(folder: Path) -> MotionManifest: ...
@overload
def read_manifest(folder: Path, kind: type[KindOfManifest]) -> KindOfManifest: ...
def read_manifest(folder: Path, kind: type[Manifest] = MotionManifest) -> Manifest:
    """Read and check the manifest of the bundle in ``folder``, hashes included.

    Args:
        folder: The bundle.
        kind: What its manifest must be.

    Raises:
        BundleError: If a file is missing, altered, or the manifest does not fit its schema.
    """
    path = folder / MANIFEST_FILE
    manifest = _decoded(folder, kind)
    _check(folder, path, manifest)
    return manifest


_Any = TypeVar("_Any")


def _decoded(folder: Path, kind: type[_Any]) -> _Any:
    path = folder / MANIFEST_FILE
    try:
        return msgspec.json.decode(path.read_bytes(), type=kind)
    except FileNotFoundError:
        raise BundleError(
            f"no {MANIFEST_FILE} in {folder}: a bundle is a folder with {MODEL_FILE}, "
            f"{MANIFEST_FILE}, {GOLDEN_FILE} and {CARD_FILE}"
        ) from None
    except msgspec.MsgspecError as error:
        raise BundleError(f"{path} is not a valid manifest: {error}") from error


def _check(folder: Path, path: Path, manifest: Manifest) -> None:
    if manifest.format_version != FORMAT_VERSION:
        raise BundleError(
            f"{path} has format version {manifest.format_version}, this server reads "
            f"{FORMAT_VERSION}: export the model again"
        )
    if manifest.name != folder.resolve().name:
        raise BundleError(
            f"{path} is the manifest of {manifest.name!r}, not of {folder.name!r}: a bundle has "
            "its folder's name, so rename the folder or export the model again"
        )
    for name in {**dict.fromkeys(HASHED_FILES), **manifest.files}:
        expected = manifest.files.get(name)
        if expected is None:
            raise BundleError(f"{path} gives no hash for {name}: export the model again")
        try:
            actual = sha256_of(folder / name)
        except FileNotFoundError:
            raise BundleError(f"{folder / name} is missing: export the model again") from None
        if actual != expected:
            raise BundleError(
                f"{folder / name} was altered: its SHA-256 is {actual[:12]}..., the manifest says "
                f"{expected[:12]}...; restore the file or export the model again"
            )


def write_manifest(folder: Path, manifest: Manifest) -> None:
    """Write ``manifest.json`` into ``folder``, with the hashes of the files beside it.

    Args:
        folder: Of the bundle.
        manifest: Its ``files`` may name more than the three that every bundle has.
    """
    names = {**dict.fromkeys(HASHED_FILES), **manifest.files}
    filled = msgspec.structs.replace(
        manifest, files={name: sha256_of(folder / name) for name in names}
    )
    data = msgspec.json.format(msgspec.json.encode(filled), indent=2)
    (folder / MANIFEST_FILE).write_bytes(data + b"\n")
