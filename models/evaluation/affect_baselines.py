"""What simpler models read off the same faces: ridge regression, boosted trees, the thesis's net.

Each is cross-validated among the training faces, on the folds that the shipped models were chosen
on, then trained on all of them and measured on the test fifth.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.ensemble import HistGradientBoostingRegressor
from sklearn.linear_model import RidgeCV
from sklearn.multioutput import MultiOutputRegressor
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

from agent_server.domain.arrays import Float32
from models.affect.config import Source, named
from models.affect.data import FaceFeatures
from models.affect.train import estimate, train
from models.affect.views import PLAIN
from models.evaluation.affect import NAMES, error_measures, gate_rates

PENALTIES = tuple(10.0**power for power in range(-2, 5))
SEED = 0
Fit = Callable[[FaceFeatures], Callable[[Float32], Float32]]


def affect_baselines(
    source: Source, faces: FaceFeatures, train_on: list[int], test_on: list[int], folds: int
) -> dict[str, Any]:
    """Figures of each simple model, by ``cross_validated`` and ``test``.

    Args:
        source: What a face is given as.
        faces: All faces.
        train_on: Indices of the faces to train on.
        test_on: Indices of the test fifth.
        folds: Of the cross-validation.
    """
    known, unknown = faces.take(np.array(train_on)), faces.take(np.array(test_on))
    return {
        name: {
            "cross_validated": _figures(_across(fit, known, folds)),
            "test": _figures([_both(fit, known, unknown)]),
        }
        for name, fit in _fits(source).items()
    }


def _fits(source: Source) -> Mapping[str, Fit]:
    config = named("paper", source)

    def paper(faces: FaceFeatures) -> Callable[[Float32], Float32]:
        network = train(config, faces, SEED)
        return lambda features: estimate(network, features)[:, : len(NAMES)]

    return {"ridge": _ridge, "boosted_trees": _trees, "paper": paper}


def _ridge(faces: FaceFeatures) -> Callable[[Float32], Float32]:
    """Ridge regression; its penalty is chosen by leaving one face out."""
    model = make_pipeline(StandardScaler(), RidgeCV(PENALTIES))
    features, affect = _plain(faces)
    return model.fit(features, affect).predict  # type: ignore[no-any-return]


def _trees(faces: FaceFeatures) -> Callable[[Float32], Float32]:
    """Gradient-boosted trees, one model a quantity."""
    model = MultiOutputRegressor(HistGradientBoostingRegressor(random_state=SEED))
    features, affect = _plain(faces)
    return model.fit(features, affect).predict  # type: ignore[no-any-return]


def _across(fit: Fit, faces: FaceFeatures, folds: int) -> Iterator[tuple[Float32, Float32]]:
    for train_on, test_on in faces.folds(folds, SEED):
        yield _both(fit, faces.take(train_on), faces.take(test_on))


def _both(fit: Fit, known: FaceFeatures, unknown: FaceFeatures) -> tuple[Float32, Float32]:
    """Estimates and labels of faces that were not trained on."""
    features, affect = _plain(unknown)
    return fit(known)(features), affect


def _plain(faces: FaceFeatures) -> tuple[Float32, Float32]:
    """Features and labels of the pictures as they are, where they show a face."""
    seen: NDArray[np.bool_] = faces.found[:, PLAIN]
    return faces.features[seen, PLAIN], faces.affect[seen]


def _figures(parts: Iterable[tuple[Float32, Float32]]) -> dict[str, Any]:
    estimates, labels = (np.concatenate(values) for values in zip(*parts, strict=True))
    rows = {name: error_measures(estimates[:, i], labels[:, i]) for i, name in enumerate(NAMES)}
    return {**rows, "gate": gate_rates(estimates, labels)}
