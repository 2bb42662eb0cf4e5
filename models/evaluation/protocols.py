"""How predictors are measured: which windows, which joints, which horizons, which error."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import PREDICTED_FRAMES, RATE_HZ, SEEN_FRAMES
from agent_server.errors import ConfigError
from models.data.layouts import CMU, CORE, H36M, Layout
from models.evaluation import h36m
from models.evaluation.cmu import cmu_windows
from models.evaluation.core_windows import (
    cmu_core_windows,
    msrc12_core_windows,
    synthetic_core_windows,
)

Measure = Callable[[Float32, Float32], Float32]
"""Predicted (N, F, J, 3) and true (N, F, all joints, 3) in mm -> error at each frame (F,)."""


@dataclass(frozen=True, slots=True)
class Protocol:
    """A way to measure predictors.

    Attributes:
        name: Name of the protocol, for example ``h36m-256``.
        data: Name of the data set, which is also that of the models trained for it.
        layout: The joints that models predict.
        seen: Frames of a window that a model may see; it takes the last ones that it needs.
        future: Frames that it predicts.
        horizons_ms: Where errors are reported.
        windows: Folder of the sets, folder of generated recordings -> action -> windows
            (N, seen + future, all joints, 3), mm.
        measure: Error at each frame.
        metric: What the error is, in words.
    """

    name: str
    data: str
    layout: Layout
    seen: int
    future: int
    horizons_ms: tuple[int, ...]
    windows: Callable[[Path, Path], dict[str, Float32]]
    measure: Measure
    metric: str

    @property
    def frames(self) -> list[int]:
        """Index of the frame at each horizon."""
        return [ms * RATE_HZ // 1000 - 1 for ms in self.horizons_ms]


def joint_errors(joints: tuple[int, ...]) -> Measure:
    """Mean joint distance at each frame over the joints of a layout."""

    def measure(expected: Float32, true: Float32) -> Float32:
        off = expected - true[:, :, joints]
        errors: Float32 = np.linalg.norm(off, axis=-1).mean(axis=(0, 2))
        return errors

    return measure


MEAN = "mean joint distance at the frame (MPJPE), mm"
ROOT_MEAN_SQUARE = "root mean squared joint distance up to the frame, mm"
SERVER_HORIZONS_MS = (80, 160, 320, 400, 560, 1000, 1500, 2000)

PROTOCOLS = {
    protocol.name: protocol
    for protocol in (
        Protocol(
            "h36m-256",
            "h36m",
            H36M,
            h36m.SEEN,
            h36m.FUTURE,
            (80, 160, 320, 400, 560, 720, 880, 1000),
            h36m.random_windows,
            h36m.joint_errors,
            MEAN,
        ),
        Protocol(
            "h36m-rms",
            "h36m",
            H36M,
            h36m.SEEN,
            h36m.FUTURE,
            (80, 160, 320, 400, 1000),
            h36m.regular_windows,
            h36m.rms_errors,
            ROOT_MEAN_SQUARE,
        ),
        Protocol(
            "cmu",
            "cmu",
            CMU,
            50,
            25,
            (80, 160, 320, 400, 560, 1000),
            cmu_windows,
            joint_errors(CMU.joints),
            MEAN,
        ),
        Protocol(
            "server",
            "core",
            CORE,
            SEEN_FRAMES,
            PREDICTED_FRAMES,
            SERVER_HORIZONS_MS,
            cmu_core_windows,
            joint_errors(CORE.joints),
            MEAN,
        ),
        Protocol(
            "server-msrc12",
            "core",
            CORE,
            SEEN_FRAMES,
            PREDICTED_FRAMES,
            SERVER_HORIZONS_MS,
            msrc12_core_windows,
            joint_errors(CORE.joints),
            MEAN,
        ),
        Protocol(
            "server-synthetic",
            "core",
            CORE,
            SEEN_FRAMES,
            PREDICTED_FRAMES,
            SERVER_HORIZONS_MS,
            synthetic_core_windows,
            joint_errors(CORE.joints),
            MEAN,
        ),
    )
}

SERVER_PROTOCOLS = ("server", "server-msrc12", "server-synthetic")
"""What a predictor of nine joints is measured by: CMU's test files, a Kinect, virtual people."""


def protocol_named(name: str) -> Protocol:
    """A protocol by its name.

    Raises:
        ConfigError: If there is none of this name.
    """
    if name not in PROTOCOLS:
        raise ConfigError(f"protocol '{name}' is none of {', '.join(PROTOCOLS)}")
    return PROTOCOLS[name]
