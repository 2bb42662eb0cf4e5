"""From a training run to the bundle of a predictor."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from torch import nn

from agent_server.domain.arrays import Float32
from agent_server.errors import ConfigError
from agent_server.inference.manifest import MotionManifest
from models.evaluation.forecasters import Forecaster
from models.evaluation.latency import latency_ms
from models.evaluation.prediction import MM
from models.evaluation.protocols import SERVER_PROTOCOLS, Protocol, protocol_named
from models.evaluation.report import benchmark_report, server_report
from models.export.bundle import SOURCES, Export, write_bundle
from models.export.card import predictor_card
from models.ma_wgan.network import Averaged
from models.ma_wgan.train import load_trained
from models.ops.session import OnnxModel
from models.simlpe.train import load_simlpe
from models.training.run import read_info

CHECKED_WINDOWS = 128
PROTOCOLS = {
    "server": SERVER_PROTOCOLS,
    "core": SERVER_PROTOCOLS,
    "h36m": ("h36m-256", "h36m-rms"),
    "cmu": ("cmu",),
}
"""By what a model is measured, by the data that it was trained on."""


def export_predictor(
    family: str, runs: Sequence[Path], folder: Path, version: str, data: Path, cache: Path
) -> MotionManifest:
    """Write the bundle of the runs' best networks, measured on held-out people and recordings.

    Args:
        family: ``ma_wgan`` or ``simlpe``.
        runs: Folders of training runs on the same data; their futures are averaged.
        folder: Folder of the bundle.
        version: Version of the model.
        data: Folder that holds the set folders.
        cache: Folder of generated recordings.
    """
    info = _joined([read_info(run) for run in runs])
    trained_on: str = info["config"]["data"]
    protocols = [protocol_named(name) for name in PROTOCOLS[trained_on]]
    first = protocols[0]
    networks = [_load(family, run, first) for run in runs]
    network = networks[0] if len(networks) == 1 else Averaged(networks).eval()
    windows = {protocol.name: protocol.windows(data, cache) for protocol in protocols}
    seen: int = info["config"]["network"]["seen"]

    def measure(path: Path) -> dict[str, Any]:
        model = OnnxModel(path)
        forecaster = Forecaster(
            name=folder.name,
            predict=model.batched,
            seen=seen,
            joints=len(first.layout.joints),
            parameters=sum(p.numel() for p in network.parameters()),
        )
        report = server_report if first.data == "core" else benchmark_report
        still = np.zeros((1, seen, len(first.layout.joints), 3), np.float32)
        return {**report(forecaster, windows), "latency": latency_ms(model, still)}

    export = Export(
        name=folder.name,
        version=version,
        task="predict",
        network=network,
        windows=_checked(windows, protocols, seen),
        output_frames=first.future,
        labels=(),
        info=info,
        sources=SOURCES[trained_on],
        skeleton=first.layout.name,
    )
    return write_bundle(export, folder, measure, predictor_card)


def _joined(infos: list[dict[str, Any]]) -> dict[str, Any]:
    """What several runs say about themselves, as one.

    Raises:
        ConfigError: If they were trained on different data or see different frames.
    """
    first = infos[0]
    for info in infos[1:]:
        one, other = (
            (each["config"]["data"], each["config"]["network"]["seen"]) for each in (first, info)
        )
        if one != other:
            raise ConfigError(
                f"--run: one run was trained on {one[0]} with {one[1]} frames seen, another on "
                f"{other[0]} with {other[1]}: average runs of one kind"
            )
    return {
        **first,
        "command": "`, averaged with `".join(info["command"] for info in infos),
        "wall_s": sum(info["wall_s"] for info in infos),
    }


def _load(family: str, run: Path, protocol: Protocol) -> nn.Module:
    if family == "simlpe":
        return load_simlpe(run)
    if family == "ma_wgan":
        return load_trained(run, protocol.layout)
    raise ConfigError(f"family '{family}' is none of ma_wgan, simlpe")


def _checked(
    windows: dict[str, dict[str, Float32]], protocols: list[Protocol], seen: int
) -> Float32:
    """Seen parts of windows from all over the test data, in metres."""
    parts = []
    for protocol in protocols:
        motion = np.concatenate(list(windows[protocol.name].values()))
        spread = np.linspace(0, len(motion) - 1, CHECKED_WINDOWS // len(protocols)).astype(int)
        joints = motion[spread][:, protocol.seen - seen : protocol.seen, protocol.layout.joints]
        parts.append((joints / MM).astype(np.float32))
    return np.concatenate(parts)
