"""Which point is which: by where it lies in a face, and in its mirror image."""

import numpy as np
import pytest

from agent_server.face.layouts import (
    CONTOURS,
    LEFT_PUPIL,
    MESH_TO_DLIB68,
    MIRROR_DLIB68,
    RIGHT_PUPIL,
    to_dlib68,
)
from agent_server.face.tracker import FaceTracker
from agent_server.synthetic.face import face_shapes
from tests.support.pictures import labelled, needs_faces, picture


@pytest.fixture(scope="module")
def neutral():
    """The mean face from the front, x right and y down, the eyes one unit apart."""
    return face_shapes().expression[0][:, :2]


def area(outline):
    x, y = outline.T
    return abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) / 2


def test_each_point_of_dlib_lies_where_dlib_has_it(neutral):
    points = to_dlib68(neutral)
    assert points.shape == (68, 2)
    x, y = points.T
    pupils = neutral[RIGHT_PUPIL], neutral[LEFT_PUPIL]
    assert (np.diff(x[0:17]) > -0.02).all(), "the jaw runs from the person's right to the left"
    assert y[8] == y.max(), "the chin is in its middle"
    assert (np.diff(x[17:27]) > 0).all(), "brows"
    assert (y[17:27] < min(pupils[0][1], pupils[1][1])).all()
    assert (np.diff(y[27:31]) > 0).all(), "down the nose"
    assert np.allclose(x[[27, 28, 29, 30, 33]], 0, atol=0.02)
    assert (np.diff(x[31:36]) > 0).all(), "nostrils"
    for first, pupil in ((36, pupils[0]), (42, pupils[1])):
        assert x[first] < pupil[0] < x[first + 3], "corners of the eye"
        assert (y[first + 1 : first + 3] < y[first + 4 : first + 6]).all(), "its upper lid first"
        assert x[first + 1] < x[first + 2]
        assert x[first + 4] > x[first + 5]
    assert x[48] == x[48:68].min(), "corners of the mouth"
    assert x[54] == x[48:68].max()
    assert (np.diff(x[48:55]) > 0).all(), "the upper lip"
    assert (np.diff(x[54:60]) < 0).all(), "the lower lip"
    assert y[51] < y[62] <= y[66] < y[57]
    assert (np.diff(x[60:65]) > 0).all()
    assert (np.diff(x[64:68]) < 0).all()
    assert y[33] < y[51], "the mouth is below the nose"


def test_the_mirror_of_dlibs_points(neutral):
    points = to_dlib68(neutral)
    assert np.array_equal(MIRROR_DLIB68[MIRROR_DLIB68], np.arange(68))
    mirrored = points[MIRROR_DLIB68] * (-1, 1)
    assert np.linalg.norm(mirrored - points, axis=1).max() < 0.06


def test_batches_are_taken_over_leading_axes(neutral):
    batch = np.stack((neutral, 2 * neutral))[None].astype(np.float32)
    assert to_dlib68(batch).shape == (1, 2, 68, 2)
    assert np.array_equal(to_dlib68(batch)[0, 1], to_dlib68(batch[0, 1]))
    assert len(set(MESH_TO_DLIB68.tolist())) == 68


def test_contours_are_what_they_are_called(neutral):
    outlines = {name: neutral[list(line)] for name, line in CONTOURS.items()}
    for name in ("oval", "right_eye", "left_eye", "outer_lips", "inner_lips"):
        assert CONTOURS[name][0] == CONTOURS[name][-1], "closed"
        assert len(set(CONTOURS[name])) == len(CONTOURS[name]) - 1
    assert area(outlines["oval"]) > 0.97 * _hull_area(neutral)
    assert area(outlines["inner_lips"]) < area(outlines["outer_lips"])
    for side in ("right", "left"):
        sign = -1 if side == "right" else 1
        for part in ("eye", "brow"):
            assert (sign * outlines[f"{side}_{part}"][:, 0] > 0).all()
        low, high = outlines[f"{side}_eye"].min(axis=0), outlines[f"{side}_eye"].max(axis=0)
        pupil = neutral[RIGHT_PUPIL if side == "right" else LEFT_PUPIL]
        assert (low < pupil).all()
        assert (pupil < high).all()
        assert outlines[f"{side}_brow"][:, 1].max() < low[1]
    for line in outlines.values():
        assert np.linalg.norm(np.diff(line, axis=0), axis=1).max() < 0.5, "no point is far off"


def _hull_area(points):
    angles = np.linspace(0, 2 * np.pi, 360, endpoint=False)
    directions = np.stack((np.cos(angles), np.sin(angles)), axis=1)
    corners = points[np.argmax(points @ directions.T, axis=0)]
    return area(corners)


@needs_faces
def test_a_mirrored_face_has_mirrored_points(networks):
    distances = []
    for file in labelled(12):
        image = picture(file)
        flipped = np.ascontiguousarray(image[:, ::-1])
        points = to_dlib68(FaceTracker(networks.detector, networks.mesh).look(image).points)
        other = to_dlib68(FaceTracker(networks.detector, networks.mesh).look(flipped).points)
        back = other[MIRROR_DLIB68] * (-1, 1) + (image.shape[1] - 1, 0)
        eyes = np.linalg.norm(points[45] - points[36])
        distances.append(np.linalg.norm(back - points, axis=1).mean() / eyes)
    assert np.mean(distances) < 0.03
