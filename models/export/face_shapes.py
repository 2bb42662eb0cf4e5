"""The generator's face: how the points and blendshapes of faces go with valence and arousal.

A linear model on the faces that the pipeline finds in the training pictures of DiffusionFER
(CC0): points in front view, as a cubic of valence and arousal plus the principal components of
what is left, which is who somebody is. What is made with it is synthetic.
"""

from pathlib import Path
from typing import Any

import numpy as np

from agent_server.domain.arrays import Float32, Float64
from agent_server.face.features import front_view
from agent_server.face.layouts import LEFT_PUPIL, RIGHT_PUPIL
from agent_server.synthetic.face import IDENTITIES, mood_terms
from models.affect.views import MIRRORED, PLAIN, Pipeline, look_at
from models.data.labelled_faces import LICENCE, SOURCE, read_faces, test_split

RIDGE = 1.0
VIEWS = (PLAIN, MIRRORED)
"""A mirrored picture is as good a face, and makes the model even on both sides."""
NOTE = f"{SOURCE} ({LICENCE}); points by MediaPipe's face networks (Apache-2.0); training pictures"


def export_face_shapes(data: Path, bundles: Path, cache: Path, out: Path) -> int:
    """Fit the model and write it; the same pictures give the same bytes.

    Args:
        data: Folder of the pictures.
        bundles: Folder of the face networks' bundles.
        cache: Where what the networks see is kept.
        out: File to write, ``.npz``.

    Returns:
        Size of the file in bytes.
    """
    faces = read_faces(data)
    views = look_at(faces, Pipeline(bundles), cache, len(VIEWS))
    train = np.array(test_split(faces)[0])
    pairs = [(index, view) for view in VIEWS for index in train]
    pairs = [pair for pair in pairs if views.found[pair]]
    rows, columns = np.array(pairs).T
    terms = mood_terms(faces.affect[rows].astype(np.float64))
    points, _, _ = front_view(views.mesh[rows, columns])
    apart = np.linalg.norm(points[:, LEFT_PUPIL] - points[:, RIGHT_PUPIL], axis=-1)
    points = points / apart[:, None, None]
    flat = points.reshape(len(points), -1)
    expression = _ridge(terms, flat)
    # Most blendshapes lie near 0; their roots vary more evenly.
    shapes = np.sqrt(views.shapes[rows, columns].astype(np.float64))
    shape_terms = _ridge(terms, shapes)
    arrays: dict[str, Any] = {
        "expression": _half(expression.reshape(-1, *points.shape[1:])),
        "identity": _half(_components(flat - terms @ expression).reshape(-1, *points.shape[1:])),
        "shapes": _half(shape_terms),
        "shape_identity": _half(_components(shapes - terms @ shape_terms)),
        "note": np.array(NOTE),
    }
    out.parent.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(out, **arrays)
    return out.stat().st_size


def _ridge(terms: Float64, values: Float32 | Float64) -> Float64:
    """Coefficients (T, D) of ``values`` (N, D) by ``terms`` (N, T); the constant is not shrunk."""
    penalty = RIDGE * np.eye(terms.shape[1])
    penalty[0, 0] = 0.0
    solved = np.linalg.solve(terms.T @ terms + penalty, terms.T @ values)
    return solved.astype(np.float64)


def _components(rest: Float64) -> Float64:
    """Principal components (12, D) of what is left (N, D), each as large as it deviates."""
    _, strengths, axes = np.linalg.svd(rest, full_matrices=False)
    deviations = strengths[:IDENTITIES, None] / np.sqrt(len(rest))
    components: Float64 = axes[:IDENTITIES] * deviations
    return components


def _half(values: Float64) -> Any:
    return values.astype(np.float16)
