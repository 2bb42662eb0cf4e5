"""Predictors by name: the baselines, the shipped model and the research bundles."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.errors import ConfigError
from agent_server.inference.manifest import MODEL_FILE, read_manifest
from models.data.sets import motion_set
from models.evaluation.protocols import Protocol
from models.ops.session import OnnxModel

MODELS = Path(__file__).parents[1]
SERVER_BUNDLE = MODELS / "artifacts" / "ma_wgan_server"
BENCHMARKS = MODELS / "benchmarks"
"""Research bundles, one a model and data set: ``best_h36m``, ``simlpe_core``."""
FITTED_STRIDE = 5
TIMED = 200

Predict = Callable[[Float32], Float32]
"""Seen (N, T, J, 3) -> future (N, F, J, 3), metres."""


@dataclass(frozen=True, slots=True)
class Forecaster:
    """A predictor as protocols see it.

    Attributes:
        name: Its name in tables.
        predict: Takes the last ``seen`` frames.
        seen: How many frames that is.
        joints: Joints of a pose.
        parameters: Trained numbers.
    """

    name: str
    predict: Predict
    seen: int
    joints: int
    parameters: int

    def __call__(self, seen: Float32) -> Float32:
        """Seen (N, T, J, 3) -> future (N, F, J, 3), metres; T may be more than it needs."""
        return self.predict(np.ascontiguousarray(seen[:, -self.seen :], dtype=np.float32))

    def window_ms(self) -> float:
        """Median milliseconds for one window, on one thread."""
        window = np.zeros((1, self.seen, self.joints, 3), np.float32)
        times = []
        for _ in range(TIMED):
            began = time.perf_counter_ns()
            self.predict(window)
            times.append(time.perf_counter_ns() - began)
        return round(float(np.median(times)) / 1e6, 3)


def forecaster(name: str, protocol: Protocol, data: Path) -> Forecaster:
    """A predictor by its name, for the joints and frames of a protocol.

    Args:
        name: ``zero_velocity``, ``one_fc``, ``simlpe``, ``paper``, ``best`` or ``server``.
        protocol: What it will be measured by.
        data: Folder that holds the set folders; ``one_fc`` is fitted on its training split.

    Raises:
        ConfigError: If there is no such model for the protocol's data.
    """
    if name == "zero_velocity":
        return zero_velocity(protocol)
    if name == "one_fc":
        return one_fc(protocol, data)
    folder = SERVER_BUNDLE if name == "server" else BENCHMARKS / f"{name}_{protocol.data}"
    if not folder.is_dir():
        raise ConfigError(
            f"model '{name}' has no bundle for protocol {protocol.name} ({folder} is missing): "
            f"choose one of {', '.join(names_for(protocol))}, or train and export it"
        )
    return bundled(name, folder, protocol)


def names_for(protocol: Protocol) -> list[str]:
    """Names of the models that are at hand for a protocol."""
    names = ["zero_velocity", "one_fc"]
    suffix = f"_{protocol.data}"
    names += sorted(path.name.removesuffix(suffix) for path in BENCHMARKS.glob(f"*{suffix}"))
    return [*names, "server"] if protocol.data == "core" else names


def zero_velocity(protocol: Protocol) -> Forecaster:
    """Repeats the last seen pose."""

    def predict(seen: Float32) -> Float32:
        return np.repeat(seen[:, -1:], protocol.future, axis=1)

    return Forecaster("zero_velocity", predict, 1, len(protocol.layout.joints), 0)


def one_fc(protocol: Protocol, data: Path) -> Forecaster:
    """One linear map over time, the same for every coordinate, fitted by least squares.

    It maps the offsets of the seen positions from the last one to those of the future ones.
    """
    clips = motion_set(protocol.data).clips(data, "train", protocol.seen, FITTED_STRIDE)
    lines = clips.all().flatten(2).transpose(1, 2).flatten(0, 1).numpy()  # (N * J * 3, T)
    past, future = lines[:, : protocol.seen], lines[:, protocol.seen :]
    last = past[:, -1:]
    inputs = (past - last)[:, :-1].astype(np.float64)
    weights = np.linalg.lstsq(inputs.T @ inputs, inputs.T @ (future - last), rcond=None)[0]

    def predict(seen: Float32) -> Float32:
        offsets = (seen - seen[:, -1:])[:, :-1]
        moved = np.einsum("ntjc,tf->nfjc", offsets, weights.astype(np.float32))
        result: Float32 = seen[:, -1:] + moved
        return result

    return Forecaster(
        "one_fc", predict, protocol.seen, len(protocol.layout.joints), int(weights.size)
    )


def bundled(name: str, folder: Path, protocol: Protocol) -> Forecaster:
    """The model of a bundle.

    Raises:
        ConfigError: If it predicts other joints or frames than the protocol asks for.
        BundleError: If the bundle is not whole.
    """
    manifest = read_manifest(folder)
    if (manifest.skeleton, manifest.output_frames) != (protocol.layout.name, protocol.future):
        raise ConfigError(
            f"{folder} predicts {manifest.output_frames} frames of {manifest.skeleton}, protocol "
            f"{protocol.name} asks for {protocol.future} of {protocol.layout.name}: choose one of "
            f"{', '.join(names_for(protocol))}"
        )
    return Forecaster(
        name,
        OnnxModel(folder / MODEL_FILE).batched,
        manifest.input_frames,
        len(protocol.layout.joints),
        manifest.parameters,
    )
