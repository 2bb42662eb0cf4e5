"""From a training run to the bundle of a classifier."""

from pathlib import Path
from typing import Any

import torch

from agent_server.domain.gesture import GESTURES
from agent_server.domain.motion import SEEN_FRAMES
from agent_server.inference.manifest import MODEL_FILE, MotionManifest, read_manifest
from models.data.splits import cmu_split, synthetic_split
from models.data.windows import AMBIGUOUS, cut, join
from models.evaluation.report import STRIDE, classifier_report
from models.export.bundle import Export, write_bundle
from models.export.calibration import fit_temperature
from models.export.card import classifier_card
from models.interformer.network import Calibrated, Classifier
from models.interformer.train import load_classifier
from models.ops.session import OnnxModel
from models.training.run import read_info

CHECKED_WINDOWS = 128


def export_classifier(
    run: Path,
    predictor: Path,
    folder: Path,
    version: str,
    data: Path,
    cache: Path,
) -> MotionManifest:
    """Write the bundle of the run's best network.

    Args:
        run: Training run.
        predictor: Bundle whose predictor completes the windows.
        folder: Where the bundle goes.
        version: Version of the model.
        data: Folder that holds ``cmu_mocap/``.
        cache: Folder where generated recordings are kept.
    """
    read_manifest(predictor)
    predict = OnnxModel(predictor / MODEL_FILE)
    network = calibrated(load_classifier(run), predict, data, cache)
    held = cut(synthetic_split(cache, "test"))
    observed = held.frames(torch.linspace(0, len(held) - 1, CHECKED_WINDOWS).long())[0]
    seen = observed[:, :SEEN_FRAMES]
    motion = torch.cat([seen, torch.from_numpy(predict(seen.numpy()))], dim=1)

    def measure(path: Path) -> dict[str, Any]:
        results = classifier_report(OnnxModel(path), predict, data, cache)
        return {**results, "temperature": float(network.temperature)}

    export = Export(
        name=folder.name,
        version=version,
        task="classify",
        network=network,
        windows=motion.numpy(),
        output_frames=0,
        labels=GESTURES,
        info=read_info(run),
    )
    return write_bundle(export, folder, measure, classifier_card)


def calibrated(classifier: Classifier, predict: OnnxModel, data: Path, cache: Path) -> Calibrated:
    """The classifier with the temperature that fits the validation windows."""
    windows = join(
        [
            cut(synthetic_split(cache, "validation"), STRIDE),
            cut(cmu_split(data, "validation"), STRIDE),
        ]
    )
    index = (windows.labels != AMBIGUOUS).nonzero()[:, 0]
    seen = windows.frames(index)[0][:, :SEEN_FRAMES]
    motion = torch.cat([seen, torch.from_numpy(predict.batched(seen.numpy()))], dim=1)
    with torch.no_grad():
        logits = torch.cat([classifier(part) for part in torch.split(motion, 256)])
    return Calibrated(classifier, fit_temperature(logits, windows.labels[index])).eval()
