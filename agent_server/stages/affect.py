"""Valence and arousal from faces: an estimate a face, averaged over a second.

The average is the thesis's (25 frames, chapter 5), by time instead of frames, and weighted by
the inverse of each estimate's variance. It lags behind the face by about half its length, which
each sample states. What a person's neutral face comes to can be taken off (calibration).
"""

import math
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from operator import mul

import numpy as np

from agent_server.config import FaceSettings
from agent_server.domain.affect import AFFECT_LIMIT, AffectSample, Calibrated, Calibration
from agent_server.domain.arrays import Float32, Float64
from agent_server.domain.face import Face, FaceBlendshapes, FaceLayout
from agent_server.domain.model import AffectModel
from agent_server.domain.stamp import NS_PER_MS, NS_PER_S
from agent_server.errors import InvalidInput
from agent_server.face.features import blendshape_features, mesh_features, points68_features

MIN_CALIBRATION_FACES = 5
DECIMALS = 3


def read_affect(models: Mapping[str, AffectModel], faces: Sequence[Face]) -> list[Float64]:
    """What the models make of faces, each for itself.

    Several faces at once take much less time than one by one, and come to the same bits.

    Args:
        models: Input kind (``mesh``, ``points68``, ``blendshapes``) -> its model.
        faces: Of any kinds.

    Returns:
        For each face valence, arousal and their standard deviations, on [-10, 10]: shape (4,).

    Raises:
        InvalidInput: If there is no model for one of them, or its points are no face.
        InferenceError: If a model fails.
    """
    estimates: list[Float64] = [_NOTHING] * len(faces)
    kinds: dict[tuple[str, int], list[int]] = {}
    for index, face in enumerate(faces):
        kinds.setdefault((_source(face), _values(face).size), []).append(index)
    for (source, _), indices in kinds.items():
        model = _model(models, source)
        features = _FEATURES[source](np.stack([_values(faces[index]) for index in indices]))
        rows = model.estimate(features).astype(np.float64) * AFFECT_LIMIT
        for index, row in zip(indices, rows, strict=True):
            estimates[index] = row
    return estimates


def _model(models: Mapping[str, AffectModel], source: str) -> AffectModel:
    model = models.get(source)
    if model is None:
        raise InvalidInput(
            f"this server has no model that reads {source}: send valence and arousal",
            field="type",
            code="no_model",
        )
    return model


class AffectEstimator:
    """Reads one person's face.

    Args:
        models: Input kind (``mesh``, ``points68``, ``blendshapes``) -> its model.
        settings: How long to average.
    """

    def __init__(self, models: Mapping[str, AffectModel], settings: FaceSettings) -> None:
        self._models = models
        self._window_ns = settings.window_ms * NS_PER_MS
        self._source = ""
        self._recent: deque[tuple[int, float, float, float, float]] = deque()
        self._neutral = np.zeros(2)
        self._calibration: Calibration | None = None
        self._neutral_faces: list[Float64] = []

    def require_model(self, face: Face) -> None:
        """Refuse a face that no model reads.

        Raises:
            InvalidInput: If none does.
        """
        _model(self._models, _source(face))

    def push(
        self, face: Face, estimate: Float64 | None = None
    ) -> tuple[AffectSample, Calibrated | None]:
        """Take the next face; faces come in the order of their capture.

        Args:
            face: The face.
            estimate: What :func:`read_affect` made of it, if it has been read already.

        Returns:
            Affect at the time of the face, and what a calibration came to that ended with it.

        Raises:
            InvalidInput: If there is no model for it; nothing has changed then.
            InferenceError: If the model fails; nothing has changed then.
        """
        now_ns = face.originating_ns
        source = _source(face)
        if estimate is None:
            (estimate,) = read_affect(self._models, [face])
        if source != self._source:
            self._source = source
            self._recent.clear()
        self._recent.append((now_ns, *estimate.tolist()))
        while now_ns - self._recent[0][0] >= self._window_ns and len(self._recent) > 1:
            self._recent.popleft()
        return self._average(now_ns), self._calibrated(now_ns, estimate[:2])

    def calibrate(self, calibration: Calibration) -> Calibrated | None:
        """Begin a calibration, or take over what is known; gives the latter's result."""
        if calibration.neutral is None:
            self._calibration = calibration
            self._neutral_faces = []
            return None
        self._neutral = np.array(calibration.neutral)
        self._calibration = None
        return self._state(0, is_done=True)

    def _average(self, now_ns: int) -> AffectSample:
        """Weighted mean of the window.

        The deviations are those of a single face: the errors of neighbours are one person's,
        and do not average out.
        """
        stamps, valences, arousals, valence_sds, arousal_sds = zip(*self._recent, strict=True)
        ages_ns = [now_ns - stamp for stamp in stamps]
        valence, valence_sd, valence_age_ns = _weigh(valences, valence_sds, ages_ns)
        arousal, arousal_sd, arousal_age_ns = _weigh(arousals, arousal_sds, ages_ns)
        neutral_valence, neutral_arousal = self._neutral.tolist()
        return AffectSample(
            now_ns,
            _rounded(valence - neutral_valence),
            _rounded(arousal - neutral_arousal),
            round(valence_sd, DECIMALS),
            round(arousal_sd, DECIMALS),
            self._source,
            round((valence_age_ns + arousal_age_ns) / 2 / NS_PER_MS, 1),
        )

    def _calibrated(self, now_ns: int, estimate: Float64) -> Calibrated | None:
        calibration = self._calibration
        if calibration is None or calibration.seconds is None:
            return None
        end_ns = calibration.originating_ns + round(calibration.seconds * NS_PER_S)
        if calibration.originating_ns <= now_ns <= end_ns:
            self._neutral_faces.append(estimate)
        if now_ns < end_ns:
            return None
        self._calibration = None
        count = len(self._neutral_faces)
        if count < MIN_CALIBRATION_FACES:
            return self._state(count, is_done=False)
        self._neutral = np.median(self._neutral_faces, axis=0).round(DECIMALS)
        return self._state(count, is_done=True)

    def _state(self, faces: int, *, is_done: bool) -> Calibrated:
        valence, arousal = self._neutral.tolist()
        return Calibrated(valence, arousal, faces, is_done)


def _weigh(
    values: Sequence[float], deviations: Sequence[float], ages_ns: Sequence[int]
) -> tuple[float, float, float]:
    """Mean, deviation and age, weighted by the inverse variance.

    Of so few numbers Python's own arithmetic is faster than array calls. The weighted mean of the
    variances is their number over the sum of the weights.
    """
    weights = [1.0 / (deviation * deviation) for deviation in deviations]
    total = sum(weights)
    mean = sum(map(mul, weights, values)) / total
    age_ns = sum(map(mul, weights, ages_ns)) / total
    return mean, math.sqrt(len(weights) / total), age_ns


def _rounded(level: float) -> float:
    return round(min(max(level, -AFFECT_LIMIT), AFFECT_LIMIT), DECIMALS)


_NOTHING: Float64 = np.zeros(4)
_FEATURES: dict[str, Callable[[Float32], Float32]] = {
    "mesh": mesh_features,
    "points68": points68_features,
    "blendshapes": blendshape_features,
}
"""What a face is given as -> what its model sees of it, for several faces at once."""


def _source(face: Face) -> str:
    if isinstance(face, FaceBlendshapes):
        return "blendshapes"
    return "points68" if face.layout is FaceLayout.DLIB68 else "mesh"


def _values(face: Face) -> Float32:
    return face.values if isinstance(face, FaceBlendshapes) else face.points
