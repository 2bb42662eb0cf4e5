"""Affect from faces: averaging, its delay, calibration, what cannot be read."""

import numpy as np
import pytest

from agent_server.config import FaceSettings
from agent_server.domain.affect import Calibration
from agent_server.domain.face import FaceLandmarks, FaceLayout
from agent_server.errors import InferenceError, InvalidInput
from agent_server.stages.affect import AffectEstimator
from tests.support.faces import ShapeReader, shapes

MS = 1_000_000


def estimator(window_ms=1000, **options):
    models = {"blendshapes": ShapeReader(**options)}
    return AffectEstimator(models, FaceSettings(window_ms=window_ms))


def feed(stage, levels, start_ms=0, step_ms=100):
    samples = []
    for index, (valence, arousal) in enumerate(levels):
        face = shapes((start_ms + index * step_ms) * MS, valence, arousal)
        samples.append(stage.push(face)[0])
    return samples


def test_an_estimate_is_the_mean_of_the_last_second():
    levels = [(-8, 2)] * 3 + [(4, 6)] * 10 + [(-2, 1)] * 5
    samples = feed(estimator(), levels)
    for index, sample in enumerate(samples):
        recent = levels[max(0, index - 9) : index + 1]
        assert sample.valence == pytest.approx(np.mean([v for v, _ in recent]), abs=2e-3)
        assert sample.arousal == pytest.approx(np.mean([a for _, a in recent]), abs=2e-3)
        assert sample.source == "blendshapes"


def test_the_delay_is_stated_and_the_uncertainty_is_that_of_one_face():
    samples = feed(estimator(), [(0, 0)] * 20)
    assert samples[0].delay_ms == 0
    assert samples[-1].delay_ms == 450.0
    assert (samples[-1].valence_sd, samples[-1].arousal_sd) == (1.0, 1.0)


def test_without_a_window_each_estimate_stands_for_itself():
    samples = feed(estimator(window_ms=0), [(-8, 2), (4, 6)])
    assert [sample.valence for sample in samples] == pytest.approx([-8, 4], abs=2e-3)


def test_after_a_pause_old_faces_do_not_count():
    stage = estimator()
    feed(stage, [(-8, 2)] * 5)
    (sample,) = feed(stage, [(4, 6)], start_ms=2000)
    assert sample.valence == pytest.approx(4, abs=2e-3)


def test_a_neutral_face_becomes_the_zero():
    stage = estimator(window_ms=0)
    assert stage.calibrate(Calibration(0, 1.0, None)) is None
    feed(stage, [(-2, 1)] * 10)
    _, calibrated = stage.push(shapes(1000 * MS, -2, 1))
    assert calibrated is not None
    assert calibrated.is_done
    assert (calibrated.valence, calibrated.arousal) == pytest.approx((-2, 1), abs=2e-3)
    assert calibrated.faces == 11
    (sample,) = feed(stage, [(-6, 5)], start_ms=1100)
    assert (sample.valence, sample.arousal) == pytest.approx((-4, 4), abs=2e-3)


def test_a_calibration_that_saw_too_few_faces_changes_nothing():
    stage = estimator(window_ms=0)
    stage.calibrate(Calibration(0, None, (-1.0, 0.5)))
    stage.calibrate(Calibration(0, 1.0, None))
    feed(stage, [(-2, 1)] * 3)
    _, calibrated = stage.push(shapes(5000 * MS, 9, 9))
    assert calibrated is not None
    assert not calibrated.is_done
    # What was known before is in force still.
    assert (calibrated.valence, calibrated.arousal, calibrated.faces) == (-1.0, 0.5, 3)
    assert stage.push(shapes(5100 * MS, 9, 9))[1] is None


def test_a_known_neutral_face_is_taken_over_at_once():
    stage = estimator(window_ms=0)
    calibrated = stage.calibrate(Calibration(0, None, (-3.0, 2.0)))
    assert calibrated is not None
    assert (calibrated.valence, calibrated.arousal, calibrated.is_done) == (-3.0, 2.0, True)
    (sample,) = feed(stage, [(-3, 2)])
    assert (sample.valence, sample.arousal) == pytest.approx((0, 0), abs=2e-3)


def test_what_is_read_stays_on_the_scale():
    stage = estimator(window_ms=0)
    stage.calibrate(Calibration(0, None, (-5.0, -5.0)))
    (sample,) = feed(stage, [(9, 9)])
    assert (sample.valence, sample.arousal) == (10.0, 10.0)


def test_a_face_that_no_model_reads_is_refused():
    points = np.zeros((68, 2), dtype=np.float32)
    points[:, 0] = np.arange(68)
    points[:, 1] = np.arange(68) ** 1.5
    face = FaceLandmarks(0, FaceLayout.DLIB68, points, 640, 480)
    with pytest.raises(InvalidInput, match="no model that reads points68"):
        estimator().push(face)


def test_a_model_that_fails_leaves_the_average_as_it_was():
    reader = ShapeReader()
    stage = AffectEstimator({"blendshapes": reader}, FaceSettings())
    feed(stage, [(-8, 2)] * 2)
    reader.fails = True
    with pytest.raises(InferenceError):
        stage.push(shapes(200 * MS, 4, 4))
    reader.fails = False
    (sample,) = feed(stage, [(-8, 2)], start_ms=300)
    assert sample.valence == pytest.approx(-8, abs=2e-3)
