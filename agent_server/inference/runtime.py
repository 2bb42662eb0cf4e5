"""Model bundles on onnxruntime. The only module that imports it."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import onnxruntime as ort

from agent_server.domain.arrays import Float32
from agent_server.domain.gesture import IDLE
from agent_server.domain.motion import CLASSIFIED_FRAMES, PREDICTED_FRAMES, SEEN_FRAMES
from agent_server.domain.skeleton import CORE_JOINTS
from agent_server.errors import BundleError, InferenceError
from agent_server.inference.manifest import GOLDEN_FILE, MODEL_FILE, Manifest, read_manifest

GOLDEN_TOLERANCE = 1e-3
"""Largest difference to a golden output, in metres or probability, on any machine."""


class OnnxModel:
    """A checked bundle with a running session: one thread, no spinning.

    Args:
        folder: The bundle.
        task: What the bundle must be made for.

    Raises:
        BundleError: If the bundle is missing, altered, made for something else, or does not
            give its golden output.
    """

    def __init__(self, folder: Path, task: str) -> None:
        self.manifest: Manifest = read_manifest(folder)
        if self.manifest.task != task:
            raise BundleError(
                f"{folder} holds a model that can {self.manifest.task}, one that can {task} is "
                "needed: name another bundle"
            )
        if self.manifest.skeleton != "core9":
            raise BundleError(
                f"{folder} holds a research model of {self.manifest.skeleton}, the server runs "
                "models of core9: name another bundle"
            )
        options = ort.SessionOptions()
        options.intra_op_num_threads = 1
        options.inter_op_num_threads = 1
        options.log_severity_level = 3
        options.add_session_config_entry("session.intra_op.allow_spinning", "0")
        try:
            self._session = ort.InferenceSession(
                folder / MODEL_FILE, options, providers=["CPUExecutionProvider"]
            )
        except Exception as error:  # onnxruntime has no common base of its errors
            raise BundleError(f"{folder / MODEL_FILE} cannot be loaded: {error}") from error
        self._input: str = self._session.get_inputs()[0].name
        self._output: list[str] = [self._session.get_outputs()[0].name]
        self._replay_golden(folder / GOLDEN_FILE)

    @property
    def name(self) -> str:
        """Name of the bundle."""
        return self.manifest.name

    @property
    def sha256(self) -> str:
        """SHA-256 of the model file."""
        return self.manifest.files[MODEL_FILE]

    def run(self, batch: Float32) -> Float32:
        """Run the model on a batch; every row has the bits that it has alone.

        Raises:
            InferenceError: If onnxruntime fails or a result is not finite.
        """
        if self.manifest.batch_exact or len(batch) == 1:
            return self._run(batch)
        return np.concatenate([self._run(batch[i : i + 1]) for i in range(len(batch))])

    def _run(self, batch: Float32) -> Float32:
        try:
            result: Float32 = self._session.run(self._output, {self._input: batch})[0]
        except Exception as error:  # onnxruntime has no common base of its errors
            raise InferenceError(f"{self.name} failed: {error}") from error
        if not np.isfinite(result).all():
            raise InferenceError(f"{self.name} gave a result that is not finite")
        return result

    def _replay_golden(self, path: Path) -> None:
        try:
            with np.load(path, allow_pickle=False) as golden:
                given, expected = golden[self._input], golden[self._output[0]]
        except (OSError, KeyError, ValueError) as error:
            raise BundleError(f"{path} cannot be read: {error}") from error
        try:
            actual = self.run(given)
        except InferenceError as error:
            raise BundleError(
                f"{path}: the model does not run on its golden input: {error}"
            ) from error
        worst = float(np.abs(actual - expected).max()) if actual.shape == expected.shape else None
        if worst is None or worst > GOLDEN_TOLERANCE:
            raise BundleError(
                f"{path}: the model does not give its golden output (off by {worst}): "
                "export it again, or use the onnxruntime it was made with"
            )


class OnnxPredictor(OnnxModel):
    """A bundle that continues motion: (B, 25, 9, 3) -> (B, 50, 9, 3), normalised."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, "predict")
        _expect(folder, self.manifest, (SEEN_FRAMES, PREDICTED_FRAMES))

    def predict(self, seen: Float32) -> Float32:
        """Predict two seconds for every row of a batch."""
        return self.run(seen)


class OnnxClassifier(OnnxModel):
    """A bundle that names motion: (B, 75, 9, 3) -> (B, C), normalised."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, "classify")
        _expect(folder, self.manifest, (CLASSIFIED_FRAMES, 0))
        self.labels = tuple(self.manifest.labels)
        if IDLE not in self.labels:
            raise BundleError(f"{folder}: the labels {self.labels} lack {IDLE!r}")

    def classify(self, motion: Float32) -> Float32:
        """Give the probabilities of every row of a batch."""
        return self.run(motion)


def _expect(folder: Path, manifest: Manifest, frames: Sequence[int]) -> None:
    got = (manifest.input_frames, manifest.output_frames)
    if got != tuple(frames):
        raise BundleError(
            f"{folder}: frames in and out are {got}, the server needs {tuple(frames)} "
            f"of {CORE_JOINTS} joints"
        )
