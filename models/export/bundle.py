"""Putting a bundle together."""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
import torch
from torch import nn

from agent_server.domain.arrays import Float32
from agent_server.domain.motion import RATE_HZ
from agent_server.inference.manifest import (
    FORMAT_VERSION,
    GOLDEN_FILE,
    MODEL_FILE,
    DataSource,
    MotionManifest,
    SkeletonName,
)
from models.data import cmu, h36m, synthetic
from models.export.onnx import OPSET, check_parity, is_batch_exact, write_onnx
from models.export.publish import publish, training_of
from models.ops.session import OnnxModel

GOLDEN_ROWS = 6
LICENCE = "Apache-2.0"
RESEARCH_LICENCE = "research only: the training set is for academic evaluation"
CMU_SOURCE = DataSource(cmu.SOURCE, cmu.LICENCE, synthetic=False)
SERVER_SOURCES = (DataSource(synthetic.SOURCE, synthetic.LICENCE, synthetic=True), CMU_SOURCE)
SOURCES = {
    "server": SERVER_SOURCES,
    "cmu": (CMU_SOURCE,),
    "core": (CMU_SOURCE,),
    "h36m": (DataSource(h36m.SOURCE, h36m.LICENCE, synthetic=False),),
}
"""What a model was trained on, by the name in its configuration."""


@dataclass(frozen=True, slots=True)
class Export:
    """A network on its way into a bundle.

    Attributes:
        name: Name of the bundle.
        version: Version of the model.
        task: ``predict`` or ``classify``.
        network: In evaluation mode, on the CPU.
        windows: Held-out inputs (N, frames, J, 3), at least 16, to check and for the goldens.
        output_frames: Frames it gives, 0 for a classifier.
        labels: Class names, empty for a predictor.
        info: What the training run says about itself.
        sources: What it was trained on.
        skeleton: Name of the joints.
        licence: Licence of the weights; None is that of the strictest set.
    """

    name: str
    version: str
    task: Literal["predict", "classify"]
    network: nn.Module
    windows: Float32
    output_frames: int
    labels: tuple[str, ...]
    info: dict[str, Any]
    sources: tuple[DataSource, ...] = SERVER_SOURCES
    skeleton: SkeletonName = "core9"
    licence: str | None = None

    @property
    def weights_licence(self) -> str:
        """Licence of the weights."""
        if self.licence is not None:
            return self.licence
        free = all(source.licence != h36m.LICENCE for source in self.sources)
        return LICENCE if free else RESEARCH_LICENCE


def write_bundle(
    export: Export,
    folder: Path,
    measure: Callable[[Path], dict[str, Any]],
    card: Callable[[MotionManifest], str],
) -> MotionManifest:
    """Write, check and measure a bundle; nothing is left behind if a check fails.

    Args:
        export: What to write.
        folder: Where; replaced file by file.
        measure: Gives the results that the manifest and the card hold, from the ONNX file.
        card: Renders the card.

    Raises:
        BundleError: If ONNX does not compute what torch does.
    """
    input_name, output_name = (
        ("seen", "future") if export.task == "predict" else ("motion", "probabilities")
    )
    with tempfile.TemporaryDirectory() as scratch:
        draft = Path(scratch) / export.name
        draft.mkdir()
        path = draft / MODEL_FILE
        example = torch.from_numpy(export.windows[:2])
        write_onnx(export.network, example, path, input_name, output_name)
        model = OnnxModel(path)
        results = {
            **measure(path),
            "onnx_difference": check_parity(export.network, model, export.windows),
        }
        golden = _golden_input(export.windows)
        arrays: dict[str, Any] = {input_name: golden, output_name: model(golden)}
        np.savez_compressed(draft / GOLDEN_FILE, **arrays)
        manifest = MotionManifest(
            format_version=FORMAT_VERSION,
            name=export.name,
            version=export.version,
            task=export.task,
            skeleton=export.skeleton,
            rate_hz=RATE_HZ,
            input_frames=export.windows.shape[1],
            output_frames=export.output_frames,
            labels=list(export.labels),
            normaliser="navel_last_seen" if export.skeleton == "core9" else "root",
            opset=OPSET,
            parameters=sum(p.numel() for p in export.network.parameters()),
            batch_exact=is_batch_exact(model, export.windows),
            files={},
            licence=export.weights_licence,
            training=training_of(export.info, export.sources),
            results=results,
        )
        return publish(draft, folder, manifest, card(manifest))


def _golden_input(windows: Float32) -> Float32:
    """A few real windows and one that stands still, which is where quotients go wrong."""
    spread = np.linspace(0, len(windows) - 1, GOLDEN_ROWS - 1).astype(int)
    still = np.repeat(windows[:1, :1], windows.shape[1], axis=1)
    return np.concatenate([windows[spread], still])
