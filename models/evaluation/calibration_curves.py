"""Whether probabilities mean what they say, and what it costs to reject the unsure ones."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from agent_server.domain.arrays import Float32, Float64

BINS = 15


@dataclass(frozen=True, slots=True)
class Reliability:
    """Windows by the probability of their most probable class, in bins of equal width.

    Attributes:
        counts: Shape (bins,).
        confidence: Shape (bins,), mean probability; NaN where a bin is empty.
        accuracy: Shape (bins,), share that is named right; NaN where a bin is empty.
    """

    counts: NDArray[np.int64]
    confidence: Float64
    accuracy: Float64

    @property
    def over(self) -> float:
        """Mean probability less accuracy over all windows: above 0 is boastful."""
        filled = self.counts > 0
        gap = (self.confidence - self.accuracy)[filled]
        return float(np.average(gap, weights=self.counts[filled]))


@dataclass(frozen=True, slots=True)
class RiskCoverage:
    """What is accepted, and how much of it is wrong, as the threshold falls.

    Attributes:
        thresholds: Shape (L,), falling: what is at least as probable is accepted.
        coverage: Shape (L,), share of the windows that is accepted.
        risk: Shape (L,), share of those that is named wrong.
    """

    thresholds: Float64
    coverage: Float64
    risk: Float64

    @property
    def area(self) -> float:
        """Area under risk over coverage (AURC); equally probable windows come in together."""
        return float((np.diff(self.coverage, prepend=0.0) * self.risk).sum())


def reliability(probabilities: Float32, labels: NDArray[np.int64], bins: int = BINS) -> Reliability:
    """Confidence and accuracy of windows (N, C) with labels (N,), by bins of confidence."""
    confidence = probabilities.max(1).astype(np.float64)
    right = probabilities.argmax(1) == labels
    which = np.minimum((confidence * bins).astype(int), bins - 1)
    counts = np.bincount(which, minlength=bins)

    def mean(values: Float64) -> Float64:
        sums = np.bincount(which, weights=values, minlength=bins)
        means: Float64 = np.divide(sums, counts, out=np.full(bins, np.nan), where=counts > 0)
        return means

    return Reliability(counts, mean(confidence), mean(right.astype(np.float64)))


def risk_coverage(probabilities: Float32, labels: NDArray[np.int64]) -> RiskCoverage:
    """Risk over coverage of a reject option (Geifman and El-Yaniv, 2017).

    Args:
        probabilities: Shape (N, C).
        labels: Shape (N,).
    """
    wrong = probabilities.argmax(1) != labels
    levels, which = np.unique(probabilities.max(1), return_inverse=True)
    accepted = np.cumsum(np.bincount(which)[::-1])
    mistaken = np.cumsum(np.bincount(which, weights=wrong)[::-1])
    return RiskCoverage(
        levels[::-1].astype(np.float64), accepted / len(labels), mistaken / accepted
    )
