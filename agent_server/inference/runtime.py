"""Model bundles on onnxruntime. The only module that imports it."""

from pathlib import Path
from typing import Any, Generic

import numpy as np
import onnxruntime as ort
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32
from agent_server.domain.gesture import IDLE
from agent_server.domain.motion import CLASSIFIED_FRAMES, PREDICTED_FRAMES, SEEN_FRAMES
from agent_server.domain.skeleton import CORE_JOINTS
from agent_server.errors import BundleError, InferenceError
from agent_server.inference.manifest import (
    GOLDEN_FILE,
    MODEL_FILE,
    AffectManifest,
    FaceManifest,
    KindOfManifest,
    MotionManifest,
    read_manifest,
    read_task,
)

GOLDEN_TOLERANCE = 1e-3
"""Largest difference to a golden output, in metres, probability or affect, on any machine; of
the largest value of an output where that is over 1, as with landmarks in pixels."""


class Session:
    """A graph that runs on one thread, which does not spin.

    Args:
        path: The graph.
        name: What errors call it.

    Raises:
        BundleError: If it cannot be loaded.
    """

    def __init__(self, path: Path, name: str) -> None:
        self._name = name
        options = ort.SessionOptions()
        options.intra_op_num_threads = 1
        options.inter_op_num_threads = 1
        options.log_severity_level = 3
        options.add_session_config_entry("session.intra_op.allow_spinning", "0")
        try:
            self._session = ort.InferenceSession(path, options, providers=["CPUExecutionProvider"])
        except Exception as error:  # onnxruntime has no common base of its errors
            raise BundleError(f"{path} cannot be loaded: {error}") from error
        self.inputs: list[str] = [given.name for given in self._session.get_inputs()]
        self.shapes: list[list[int]] = [given.shape for given in self._session.get_inputs()]
        self.outputs: list[str] = [output.name for output in self._session.get_outputs()]

    def run(self, *given: NDArray[Any]) -> list[Float32]:
        """All outputs for all inputs, both in the graph's order.

        Raises:
            InferenceError: If onnxruntime fails or a result is not finite.
        """
        feed = dict(zip(self.inputs, given, strict=True))
        try:
            results: list[Float32] = self._session.run(self.outputs, feed)
        except Exception as error:  # onnxruntime has no common base of its errors
            raise InferenceError(f"{self._name} failed: {error}") from error
        # NaN and infinity survive a sum, and a sum is cheaper than a look at each value.
        if not all(np.isfinite(result.sum()) for result in results):
            raise InferenceError(f"{self._name} gave a result that is not finite")
        return results


class OnnxModel(Generic[KindOfManifest]):
    """A checked bundle with a running session.

    Args:
        folder: The bundle.
        task: What the bundle must be made for.
        kind: What its manifest must be.

    Raises:
        BundleError: If the bundle is missing, altered, made for something else, or does not
            give its golden output.
    """

    def __init__(self, folder: Path, task: str, kind: type[KindOfManifest]) -> None:
        can = read_task(folder)
        if can != task:
            raise BundleError(
                f"{folder} holds a model that can {can}, one that can {task} is "
                "needed: name another bundle"
            )
        self.manifest: KindOfManifest = read_manifest(folder, kind)
        self._check(folder)
        self._session = Session(folder / MODEL_FILE, self.name)
        self._replay_golden(folder / GOLDEN_FILE)

    @property
    def name(self) -> str:
        """Name of the bundle."""
        return self.manifest.name

    @property
    def sha256(self) -> str:
        """SHA-256 of the model file."""
        return self.manifest.files[MODEL_FILE]

    def _check(self, folder: Path) -> None:
        """Refuse a bundle whose manifest promises something else than is needed."""

    def _rows(self, batch: Float32) -> Float32:
        """Run the model on a batch; every row has the bits that it has alone.

        Raises:
            InferenceError: If onnxruntime fails or a result is not finite.
        """
        if self.manifest.batch_exact or len(batch) == 1:
            return self._session.run(batch)[0]
        return np.concatenate([self._session.run(batch[i : i + 1])[0] for i in range(len(batch))])

    def _replay_golden(self, path: Path) -> None:
        try:
            with np.load(path, allow_pickle=False) as golden:
                given = [golden[name] for name in self._session.inputs]
                expected = [golden[name] for name in self._session.outputs]
        except (OSError, KeyError, ValueError) as error:
            raise BundleError(f"{path} cannot be read: {error}") from error
        try:
            rows = [
                self._session.run(*(each[i : i + 1] for each in given))
                for i in range(len(given[0]))
            ]
        except InferenceError as error:
            raise BundleError(
                f"{path}: the model does not run on its golden input: {error}"
            ) from error
        actual = [np.concatenate(parts) for parts in zip(*rows, strict=True)]
        if not all(map(_is_golden, actual, expected)):
            raise BundleError(
                f"{path}: the model does not give its golden output: "
                "export it again, or use the onnxruntime it was made with"
            )


def _is_golden(actual: Float32, expected: Float32) -> bool:
    if actual.shape != expected.shape:
        return False
    scale = max(1.0, float(np.abs(expected).max()))
    return bool(np.abs(actual - expected).max() <= GOLDEN_TOLERANCE * scale)


class _MotionModel(OnnxModel[MotionManifest]):
    """A bundle that continues or names the motion of the nine core joints."""

    frames: tuple[int, int]

    def __init__(self, folder: Path, task: str) -> None:
        super().__init__(folder, task, MotionManifest)

    def _check(self, folder: Path) -> None:
        manifest = self.manifest
        if manifest.skeleton != "core9":
            raise BundleError(
                f"{folder} holds a research model of {manifest.skeleton}, the server runs "
                "models of core9: name another bundle"
            )
        got = (manifest.input_frames, manifest.output_frames)
        if got != self.frames:
            raise BundleError(
                f"{folder}: frames in and out are {got}, the server needs {self.frames} "
                f"of {CORE_JOINTS} joints"
            )


class OnnxPredictor(_MotionModel):
    """A bundle that continues motion: (B, 25, 9, 3) -> (B, 50, 9, 3), normalised."""

    frames = (SEEN_FRAMES, PREDICTED_FRAMES)

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, "predict")

    def predict(self, seen: Float32) -> Float32:
        """Predict two seconds for every row of a batch."""
        return self._rows(seen)


class OnnxSampler(_MotionModel):
    """A bundle that draws futures: seen and the index of a draw -> future and quality.

    What is drawn lies in the bundle: the same index gives the same future of a motion.

    Args:
        folder: The bundle.
        count: How many futures of a motion will be asked for.
    """

    frames = (SEEN_FRAMES, PREDICTED_FRAMES)

    def __init__(self, folder: Path, count: int) -> None:
        super().__init__(folder, "sample")
        if self.manifest.draws < count:
            raise BundleError(
                f"{folder} can draw {self.manifest.draws} futures, {count} are asked for: set "
                "futures in [models] lower, or name another bundle as sampler"
            )

    def draw(self, seen: Float32, count: int) -> tuple[Float32, Float32]:
        """Futures of one window (25, 9, 3), in one batch, and the quality of each."""
        batch = np.repeat(seen[None], count, axis=0)
        future, quality = self._session.run(batch, np.arange(count))
        return future, quality


class OnnxClassifier(_MotionModel):
    """A bundle that names motion: (B, 75, 9, 3) -> (B, C), normalised."""

    frames = (CLASSIFIED_FRAMES, 0)

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, "classify")
        self.labels = tuple(self.manifest.labels)
        if IDLE not in self.labels:
            raise BundleError(f"{folder}: the labels {self.labels} lack {IDLE!r}")

    def classify(self, motion: Float32) -> Float32:
        """Give the probabilities of every row of a batch."""
        return self._rows(motion)


class OnnxFaceNetwork(OnnxModel[FaceManifest]):
    """A bundle of the face pipeline.

    Args:
        folder: The bundle.
        role: What it must find: ``detector``, ``mesh`` or ``blendshapes``.
    """

    def __init__(self, folder: Path, role: str) -> None:
        self._role = role
        super().__init__(folder, "face", FaceManifest)

    def _check(self, folder: Path) -> None:
        if self.manifest.role != self._role:
            raise BundleError(
                f"{folder} holds a face network for {self.manifest.role}, one for {self._role} "
                "is needed: name another bundle"
            )

    @property
    def input_shape(self) -> tuple[int, ...]:
        """Shape of its input."""
        return tuple(self.manifest.input_shape)

    def run(self, given: Float32) -> dict[str, Float32]:
        """Run the network: one input, outputs by name."""
        return dict(zip(self._session.outputs, self._session.run(given), strict=True))


class OnnxAffect(OnnxModel[AffectManifest]):
    """A bundle that reads affect: (B, D) features -> (B, 4) on [-1, 1].

    Args:
        folder: The bundle.
        source: What it must read: ``mesh``, ``points68`` or ``blendshapes``.
    """

    def __init__(self, folder: Path, source: str) -> None:
        self._source = source
        super().__init__(folder, "affect", AffectManifest)

    def _check(self, folder: Path) -> None:
        if self.manifest.source != self._source:
            raise BundleError(
                f"{folder} reads affect from {self.manifest.source}, one for {self._source} is "
                "needed: name another bundle"
            )

    def estimate(self, features: Float32) -> Float32:
        """Valence, arousal and their standard deviations of every row."""
        return self._rows(features)
