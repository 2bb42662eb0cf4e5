"""Made-up faces: what they show is what the models that ship read off them."""

import numpy as np
import pytest

from agent_server import assets
from agent_server.domain.affect import AffectSample
from agent_server.domain.face import ARKIT_BLENDSHAPES, FaceBlendshapes, FaceLandmarks
from agent_server.face.features import blendshape_features, mesh_features, points68_features
from agent_server.inference.runtime import OnnxAffect
from agent_server.synthetic.face import HEIGHT, WIDTH, SyntheticFace, face_shapes, mood_terms

S = 1_000_000_000
PEOPLE = 12
KINDS = {
    "mesh478": ("mesh", mesh_features),
    "mesh468": ("mesh", mesh_features),
    "dlib68": ("points68", points68_features),
    "blendshapes": ("blendshapes", blendshape_features),
}


def shown(kind, valence, arousal, seed=0, seconds=2):
    person = SyntheticFace(np.random.default_rng(seed))
    times = range(0, seconds * S, S // 10)
    return [person.show(AffectSample(at, valence, arousal), kind) for at in times]


def numbers(face):
    return face.points if isinstance(face, FaceLandmarks) else face.values


def read(kind, valence, arousal):
    """What the shipped model makes of some people in a mood: (people, 2) on [-10, 10]."""
    source, features = KINDS[kind]
    model = OnnxAffect(assets.bundles() / f"affect_{source}", source)
    return np.array(
        [
            np.median(
                [
                    10 * model.estimate(features(numbers(face))[None])[0, :2]
                    for face in shown(kind, valence, arousal, seed)
                ],
                axis=0,
            )
            for seed in range(PEOPLE)
        ]
    )


@pytest.mark.parametrize("kind", KINDS)
def test_the_models_that_ship_read_the_mood_back(kind):
    unpleasant, pleasant, neutral = (
        read(kind, *mood) for mood in ((-6.0, 5.0), (5.0, 4.5), (0.6, 0.8))
    )
    # Single people may look otherwise than they feel; most do not.
    opened = (unpleasant[:, 0] < -3) & (np.abs(unpleasant[:, 1]) > 3)
    assert opened.mean() >= 0.75
    assert (pleasant[:, 0] > 2).all()
    assert np.abs(np.median(neutral, axis=0)).max() < 2


@pytest.mark.parametrize("kind", ["mesh478", "mesh468", "dlib68"])
def test_landmarks_stay_in_the_image_and_look_like_a_face(kind):
    for face in shown(kind, 0, 0, seconds=8):
        assert face.points.shape == (face.layout.points, face.layout.axes)
        assert not face.points.flags.writeable
        assert (face.points[:, :2] > 0).all()
        assert (face.points[:, 0] < WIDTH).all()
        assert (face.points[:, 1] < HEIGHT).all()


def test_eyes_blink():
    lid = [face.points[159, 1] - face.points[145, 1] for face in shown("mesh478", 0, 0, seconds=12)]
    openness = np.abs(lid)
    assert openness.min() < 0.5 * np.median(openness)
    left = ARKIT_BLENDSHAPES.index("eyeBlinkLeft")
    closed = [face.values[left] for face in shown("blendshapes", 0, 0, seconds=12)]
    assert max(closed) > 0.5 > np.median(closed)


def test_two_people_differ_and_one_person_stays_the_same():
    first, again, other = (shown("mesh478", 0, 0, seed)[0].points for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert np.abs(mesh_features(first) - mesh_features(other)).mean() > 0.01


def test_blendshapes_lie_in_their_range():
    values = np.array([numbers(face) for face in shown("blendshapes", -9, 9)])
    assert values.min() >= 0
    assert values.max() <= 1
    assert isinstance(shown("blendshapes", 0, 0)[0], FaceBlendshapes)


def test_the_terms_of_a_mood_fit_the_model():
    terms = mood_terms(np.zeros((3, 2)))
    assert terms.shape == (3, len(face_shapes().expression))
    np.testing.assert_array_equal(terms[:, 0], 1)
    np.testing.assert_array_equal(terms[:, 1:], 0)
