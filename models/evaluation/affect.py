"""How well valence and arousal are read off pictures, by the pipeline that ships."""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from agent_server.config import GateSettings
from agent_server.domain.affect import AFFECT_LIMIT
from agent_server.domain.arrays import Float32, Float64
from agent_server.errors import InvalidInput
from agent_server.face.features import blendshape_features, mesh_features, points68_features
from agent_server.face.layouts import to_dlib68
from models.affect.config import Source
from models.affect.views import Pipeline
from models.data.labelled_faces import LabelledFaces
from models.ops.session import OnnxModel

Values = Float32 | Float64
NAMES = ("valence", "arousal")
_GATE = GateSettings()


@dataclass(frozen=True, slots=True)
class Reading:
    """What was read off pictures.

    Attributes:
        faces: The pictures.
        found: Shape (N,): in which of them a face was found.
        estimates: Shape (N, 4): valence, arousal and their standard deviations on [-1, 1]; 0
            where no face was found.
        ms_per_frame: Median time of a picture, decoding left out.
    """

    faces: LabelledFaces
    found: NDArray[np.bool_]
    estimates: Float32
    ms_per_frame: float


def read_affect(faces: LabelledFaces, source: Source, model_file: Path, bundles: Path) -> Reading:
    """Run the pipeline on every picture.

    Args:
        faces: The pictures.
        source: What the model reads.
        model_file: The affect model.
        bundles: Folder of the face networks' bundles.

    Raises:
        InvalidInput: If no picture shows a face.
    """
    model = OnnxModel(model_file)
    pipeline = Pipeline(bundles)
    count = len(faces.files)
    found = np.zeros(count, dtype=np.bool_)
    estimates = np.zeros((count, 4), dtype=np.float32)
    times = []
    for index in range(count):
        image = faces.picture(index)
        began = time.perf_counter()
        points = pipeline.points(image)
        if points is not None:
            found[index] = True
            estimates[index] = model(_features(source, points, pipeline)[None])[0]
            times.append(time.perf_counter() - began)
    if not times:
        raise InvalidInput(f"no face was found in any picture of {faces.folder}")
    return Reading(faces, found, estimates, round(1000 * float(np.median(times)), 2))


def _features(source: Source, points: Float32, pipeline: Pipeline) -> Float32:
    match source:
        case "mesh":
            return mesh_features(points)
        case "points68":
            return points68_features(to_dlib68(points))
        case "blendshapes":
            return blendshape_features(pipeline.shapes(points))


def affect_report(reading: Reading) -> dict[str, Any]:
    """All figures of a reading; errors are over the faces that were found."""
    labels = reading.faces.affect[reading.found].astype(np.float64)
    estimates = reading.estimates[reading.found].astype(np.float64)
    return {
        **affect_measures(estimates, labels),
        "faces": len(reading.found),
        "faces_found": round(float(reading.found.mean()), 4),
        "ms_per_frame": reading.ms_per_frame,
    }


def affect_measures(estimates: Values, labels: Values) -> dict[str, Any]:
    """Errors, the gate's verdicts, and how well the uncertainty fits.

    Args:
        estimates: Shape (N, 4), on [-1, 1].
        labels: Shape (N, 2), on [-1, 1].
    """
    errors = {
        name: error_measures(estimates[:, axis], labels[:, axis]) for axis, name in enumerate(NAMES)
    }
    return {
        **errors,
        "gate": gate_rates(estimates, labels),
        "calibration": _calibration(estimates, labels),
    }


def concordance(estimates: Values, labels: Values) -> float:
    """Lin's concordance correlation coefficient."""
    covariance = float(np.mean((estimates - estimates.mean()) * (labels - labels.mean())))
    apart = float(estimates.mean() - labels.mean()) ** 2
    spread = float(estimates.var() + labels.var()) + apart
    return 2 * covariance / spread if spread else 0.0


def passes(affect: Values) -> NDArray[np.bool_]:
    """Which rows (N, 2 or more) the gate's thresholds let through."""
    return (affect[:, 0] * AFFECT_LIMIT < _GATE.enter_valence) & (
        np.abs(affect[:, 1]) * AFFECT_LIMIT > _GATE.enter_arousal
    )


def gate_rates(estimates: Values, labels: Values) -> dict[str, float | int | None]:
    """How many uncomfortable faces pass the gate, and how many pleasant ones."""
    # Labels come in steps of a tenth, and -0.3 in 32 bits is not quite -0.3.
    uncomfortable = passes(labels.round(3))
    pleasant = labels[:, 0].round(3) > 0
    open_ = passes(estimates)
    return {
        "uncomfortable": int(uncomfortable.sum()),
        "uncomfortable_pass": _share(open_[uncomfortable]),
        "pleasant": int(pleasant.sum()),
        "pleasant_pass": _share(open_[pleasant]),
    }


def error_measures(estimates: Values, labels: Values) -> Mapping[str, float]:
    """RMSE, MAE, CCC and Pearson's correlation of one quantity, both of shape (N,)."""
    error = estimates - labels
    varies = estimates.std() > 0 and labels.std() > 0
    return {
        "rmse": round(float(np.sqrt(np.mean(error**2))), 4),
        "mae": round(float(np.abs(error).mean()), 4),
        "ccc": round(concordance(estimates, labels), 4),
        "pearson": round(float(np.corrcoef(estimates, labels)[0, 1]), 4) if varies else 0.0,
    }


def _calibration(estimates: Values, labels: Values) -> dict[str, dict[str, float]]:
    """Of each quantity, how many errors lie within one and two standard deviations."""
    ratios = np.abs(estimates[:, :2] - labels) / estimates[:, 2:]
    return {
        name: {
            "within_1_sd": round(float((ratios[:, axis] <= 1).mean()), 3),
            "within_2_sd": round(float((ratios[:, axis] <= 2).mean()), 3),
            "mean_sd": round(float(estimates[:, 2 + axis].mean()), 4),
        }
        for axis, name in enumerate(NAMES)
    }


def _share(passed: NDArray[np.bool_]) -> float | None:
    return round(float(passed.mean()), 4) if len(passed) else None
