"""How sets of generated motions compare with real ones, by the features of a classifier."""

import numpy as np

from agent_server.domain.arrays import Float64
from agent_server.errors import InvalidInput


def frechet_distance(first: Float64, second: Float64) -> float:
    """Frechet distance of two normal distributions that fit two sets of features.

    Heusel et al., "GANs Trained by a Two Time-Scale Update Rule Converge to a Local Nash
    Equilibrium" (NeurIPS 2017). 0 for equal sets; it grows with fewer samples than features.

    Args:
        first: Shape (N, F), N of 2 or more.
        second: Shape (M, F), M of 2 or more.

    Raises:
        InvalidInput: If a set has one sample or none.
    """
    _check(first, second)
    apart = first.mean(axis=0) - second.mean(axis=0)
    covariances = [np.atleast_2d(np.cov(each, rowvar=False)) for each in (first, second)]
    # The trace of the root of a product is the sum of the roots of its eigenvalues.
    product = np.linalg.eigvals(covariances[0] @ covariances[1]).real
    root = np.sqrt(np.maximum(product, 0.0)).sum()
    traces = sum(np.trace(each) for each in covariances)
    return float(max(apart @ apart + traces - 2 * root, 0.0))


def spread(features: Float64) -> float:
    """Mean distance of two different rows of features (N, F)."""
    _check(features)
    apart = np.linalg.norm(features[:, None] - features[None], axis=-1)
    count = len(features)
    return float(apart.sum() / (count * (count - 1)))


def diversity_score(generated: Float64, real: Float64) -> float:
    """By how many per cent generated motions are spread more or less than real ones; 0 is best.

    Equation 3.12 of Chopin's thesis.

    Args:
        generated: Shape (N, F).
        real: Shape (M, F).
    """
    true = spread(real)
    return 100 * abs(spread(generated) - true) / true


def _check(*sets: Float64) -> None:
    for features in sets:
        if len(features) < 2:
            raise InvalidInput(
                f"a set of {len(features)} motions has no spread: give two or more",
                field="features",
            )
