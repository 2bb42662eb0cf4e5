"""Running an exported model the way the server does: one thread that does not spin."""

from pathlib import Path

import numpy as np
import onnxruntime as ort

from agent_server.domain.arrays import Float32


def open_session(path: Path) -> ort.InferenceSession:
    """A session on one thread that does not spin."""
    options = ort.SessionOptions()
    options.intra_op_num_threads = 1
    options.inter_op_num_threads = 1
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")
    return ort.InferenceSession(path, options, providers=["CPUExecutionProvider"])


class OnnxModel:
    """An ONNX file with one input.

    Args:
        path: The file.
    """

    def __init__(self, path: Path) -> None:
        self._session = open_session(path)
        self.input = self._session.get_inputs()[0].name
        self.output = self._session.get_outputs()[0].name

    def __call__(self, values: Float32) -> Float32:
        """The first output for a batch."""
        result: Float32 = self._session.run(None, {self.input: values})[0]
        return result

    def named(self, values: Float32) -> dict[str, Float32]:
        """All outputs by name."""
        names = [output.name for output in self._session.get_outputs()]
        return dict(zip(names, self._session.run(names, {self.input: values}), strict=True))

    def batched(self, values: Float32, size: int = 256) -> Float32:
        """Run any number of rows, ``size`` at a time."""
        parts = [self(values[at : at + size]) for at in range(0, len(values), size)]
        return np.concatenate(parts)
