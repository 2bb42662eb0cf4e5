"""A trained affect model as a bundle."""

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import torch

from agent_server.inference.manifest import (
    FORMAT_VERSION,
    GOLDEN_FILE,
    MODEL_FILE,
    AffectManifest,
    DataSource,
)
from models.affect.runs import Trained
from models.data.labelled_faces import LICENCE, SOURCE, read_faces, test_split
from models.evaluation.affect import affect_measures, affect_report, read_affect
from models.evaluation.latency import latency_ms
from models.export.onnx import OPSET, check_parity, is_batch_exact, write_onnx
from models.export.publish import publish, training_of
from models.ops.session import OnnxModel

WEIGHTS_LICENCE = "Apache-2.0"
GOLDEN_ROWS = 6
WHAT = {
    "mesh": "x and y of the mesh's first 468 points, turned to the front, scaled and centred",
    "points68": "x and y of dlib's 68 points, levelled, scaled and centred",
    "blendshapes": "ARKit's blendshapes without the tongue, in alphabetical order",
}


def export_affect(
    trained: Trained, data: Path, out: Path, version: str, bundles: Path
) -> AffectManifest:
    """Write and check a bundle; nothing is left behind if a check fails.

    Args:
        trained: What a run came to.
        data: Folder of the pictures whose test fifth it is measured on.
        out: Folder of the bundle.
        version: Of the model.
        bundles: Folder of the face networks' bundles.

    Raises:
        BundleError: If ONNX does not compute what torch does.
    """
    network, features, info = trained.network, trained.examples, trained.info
    source = info["config"]["source"]
    faces = read_faces(data)
    test = faces.take(test_split(faces)[1])
    with tempfile.TemporaryDirectory() as scratch:
        draft = Path(scratch) / out.name
        draft.mkdir()
        path = draft / MODEL_FILE
        write_onnx(network, torch.from_numpy(features[:2]), path, "features", "affect")
        model = OnnxModel(path)
        golden = features[np.linspace(0, len(features) - 1, GOLDEN_ROWS).astype(int)]
        np.savez_compressed(draft / GOLDEN_FILE, features=golden, affect=model(golden))
        manifest = AffectManifest(
            format_version=FORMAT_VERSION,
            name=out.name,
            version=version,
            task="affect",
            opset=OPSET,
            parameters=sum(p.numel() for p in network.parameters()),
            batch_exact=is_batch_exact(model, features),
            files={},
            licence=WEIGHTS_LICENCE,
            results={
                "cross_validated": affect_measures(
                    trained.validated.estimates, trained.validated.affect
                ),
                "test": affect_report(read_affect(test, source, path, bundles)),
                "onnx_difference": check_parity(network, model, features),
                "latency": latency_ms(model, features[:1]),
            },
            source=source,
            features=features.shape[1],
            training=training_of(info, [DataSource(SOURCE, LICENCE, synthetic=True)]),
        )
        return publish(draft, out, manifest, _card(manifest))


def _card(manifest: AffectManifest) -> str:
    rows = "\n".join(_row(name, manifest.results[name]) for name in ("cross_validated", "test"))
    gate = manifest.results["test"]["gate"]
    training = manifest.training
    (source,) = training.data
    return f"""# {manifest.name} {manifest.version}

Reads valence and arousal off {WHAT[manifest.source]}.

Input `features` (B, {manifest.features}) float32, as `agent_server.face.features` makes them.
Output `affect` (B, 4): valence, arousal and their standard deviations, on [-1, 1].
{manifest.parameters:,} parameters, ONNX opset {manifest.opset}, weights under {manifest.licence}.

An ensemble of dense networks; the estimates of a face and of its mirror image are averaged. The
standard deviations come from the networks and their spread, and were fitted to the errors of
cross-validation.

## Measured
Faces made by a diffusion model (synthetic pictures), labelled by people; on [-1, 1]:

| | valence MAE | RMSE | CCC | arousal MAE | RMSE | CCC |
|---|---|---|---|---|---|---|
{rows}

Of {gate["uncomfortable"]} test faces labelled valence < -0.3 and |arousal| > 0.3,
{100 * gate["uncomfortable_pass"]:.0f} % pass the gate's thresholds; of {gate["pleasant"]} labelled
valence > 0, {100 * gate["pleasant_pass"]:.1f} %.

- one face on one thread: p50 {manifest.results["latency"]["p50_ms"]} ms
- torch and ONNX differ by at most {manifest.results["onnx_difference"]:.1e}

## How it was made
- {source.name}, licence: {source.licence}; the training four fifths
- `{training.command}`
- seed {training.seed}, {training.wall_s / 60:.0f} minutes on {training.hardware}
- everything was chosen by cross-validation among the training faces

These are generated faces, mostly posed and seen from the front, each of another person. How well
the model does on films, on other cameras, ages and skin tones, or in a conversation, was not
measured. An expression is not a feeling: what it says about a person's state is a guess.
"""


def _row(name: str, row: dict[str, Any]) -> str:
    words = {"cross_validated": "training faces, cross-validated", "test": "test fifth"}
    cells = [
        f"{row[what][key]:.3f}" for what in ("valence", "arousal") for key in ("mae", "rmse", "ccc")
    ]
    return f"| {words[name]} | {' | '.join(cells)} |"
