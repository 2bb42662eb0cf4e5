"""Finding faces: where they are, in which order, and as many as there are."""

import numpy as np
import pytest

from agent_server.face.detector import FaceDetector
from agent_server.face.layouts import LEFT_PUPIL, RIGHT_PUPIL

NOSE_TIP = 4
RIGHT_EYE, LEFT_EYE, NOSE = 0, 1, 2


class Anchors:
    """A detector network that is sure of some anchors.

    Boxes are a quarter of the image wide, but the one of anchor 511, which is twice as large.
    """

    name = "anchors"
    sha256 = "0" * 64
    input_shape = (1, 128, 128, 3)

    def __init__(self, *sure, size=(32.0, 32.0), logits=None):
        self.sure = list(sure)
        self.logits = [2.0] * len(sure) if logits is None else logits
        self.size = size

    def run(self, given):
        self.given = given
        scores = np.full((1, 896, 1), -100.0, dtype=np.float32)
        scores[0, self.sure, 0] = self.logits
        boxes = np.zeros((1, 896, 16), dtype=np.float32)
        boxes[..., 2:4] = self.size
        boxes[0, 511, 2:4] *= 2
        boxes[..., 4:] = np.arange(12)
        return {"scores": scores, "boxes": boxes}


def middle(detection):
    return (detection.low + detection.high) / 2


def side_by_side(*pictures):
    return np.concatenate(pictures, axis=1)


@pytest.mark.parametrize("share", [0.08, 0.11, 0.16])
@pytest.mark.parametrize(("width", "height"), [(640, 480), (480, 640), (1280, 720), (400, 400)])
def test_a_face_is_found_where_it_was_painted(networks, painted, share, width, height):
    eyes = share * max(width, height)
    image, points = painted(width * 0.55, height * 0.45, eyes, width=width, height=height)
    (found,) = FaceDetector(networks.detector).detect(image)
    assert found.score > 0.6
    tolerance = 0.2 * eyes
    for keypoint, index in ((RIGHT_EYE, RIGHT_PUPIL), (LEFT_EYE, LEFT_PUPIL), (NOSE, NOSE_TIP)):
        assert np.linalg.norm(found.keypoints[keypoint] - points[index, :2]) < tolerance
    inner = points[[RIGHT_PUPIL, LEFT_PUPIL, 61, 291], :2]
    assert (inner > found.low).all()
    assert (inner < found.high).all()


def test_the_eyes_line_is_the_regions(networks, painted):
    for degrees in (-40, 0, 40):
        image, points = painted(degrees=degrees)
        region = FaceDetector(networks.detector).detect(image)[0].region
        assert np.degrees(region.angle) == pytest.approx(degrees, abs=10)
        assert np.hypot(region.x - points[4, 0], region.y - points[4, 1]) < 30


def test_two_faces_come_with_the_larger_first(networks, painted):
    small, large = painted(x=160, eyes=45, width=320)[0], painted(x=160, eyes=80, width=320)[0]
    for image, at in ((side_by_side(small, large), 480), (side_by_side(large, small), 160)):
        first, second = FaceDetector(networks.detector).detect(image)
        assert abs(middle(first)[0] - at) < 20
        assert abs(middle(second)[0] - (640 - at)) < 20
        assert first.area > 1.5 * second.area


@pytest.mark.parametrize(
    "image",
    [
        np.zeros((480, 640, 3), np.uint8),
        np.full((720, 1280, 3), 255, np.uint8),
        np.zeros((1, 1, 3), np.uint8),
        np.zeros((3, 900, 3), np.uint8),
    ],
)
def test_nothing_is_found_where_nothing_is(networks, image):
    assert FaceDetector(networks.detector).detect(image) == []


def test_a_grey_picture_of_a_face_shows_a_face(networks, painted):
    image, _ = painted()
    grey = image.mean(axis=2, keepdims=True).astype(np.uint8).repeat(3, axis=2)
    assert len(FaceDetector(networks.detector).detect(grey)) == 1


@pytest.mark.parametrize(
    ("anchor", "centre"),
    [
        (0, (0.5 / 16, 0.5 / 16)),
        (1, (0.5 / 16, 0.5 / 16)),  # two anchors a cell
        (2, (1.5 / 16, 0.5 / 16)),  # x first
        (32, (0.5 / 16, 1.5 / 16)),
        (510, (15.5 / 16, 15.5 / 16)),
        (512, (0.5 / 8, 0.5 / 8)),
        (517, (0.5 / 8, 0.5 / 8)),  # six of them
        (518, (1.5 / 8, 0.5 / 8)),
        (895, (7.5 / 8, 7.5 / 8)),
    ],
)
def test_boxes_and_key_points_are_relative_to_their_anchor(anchor, centre):
    (found,) = FaceDetector(Anchors(anchor)).detect(np.zeros((480, 640, 3), np.uint8))
    # The wide image stands in the middle of a square of 640 pixels.
    place = np.array(centre) * 640 - (0, 80)
    assert np.allclose(middle(found), place, atol=1e-3)
    assert np.allclose(found.high - found.low, 160, atol=1e-3)
    offsets = np.arange(12).reshape(6, 2) * 640 / 128
    assert np.allclose(found.keypoints, place + offsets, atol=1e-3)
    assert found.score == pytest.approx(1 / (1 + np.exp(-2.0)))


def test_an_image_is_shown_whole_and_undistorted(painted):
    network = Anchors()
    image = np.full((200, 400, 3), (255, 0, 128), np.uint8)
    FaceDetector(network).detect(image)
    given = network.given[0]
    assert given.shape == (128, 128, 3)
    assert given.dtype == np.float32
    assert np.allclose(given[34:94], (1, -1, 256 / 255 - 1), atol=0.01)
    assert (given[:31] == -1).all()
    assert (given[97:] == -1).all()


def test_overlapping_boxes_are_averaged_by_their_scores():
    # Anchors 0 and 2 are a cell apart, their boxes share three quarters of their width.
    logits = [3.0, 0.5]
    (found,) = FaceDetector(Anchors(0, 2, logits=logits)).detect(np.zeros((128, 128, 3), np.uint8))
    weights = 1 / (1 + np.exp(-np.array(logits)))
    assert middle(found)[0] == pytest.approx((4 * weights[0] + 12 * weights[1]) / weights.sum())
    assert middle(found)[1] == pytest.approx(4)
    assert found.score == pytest.approx(weights[0])


@pytest.mark.parametrize(
    ("other", "faces"),
    [
        (4, 1),  # two cells to the right: a third of both boxes is shared
        (36, 2),  # and one down: less than a quarter
    ],
)
def test_boxes_are_one_face_where_three_tenths_are_shared(other, faces):
    found = FaceDetector(Anchors(0, other)).detect(np.zeros((128, 128, 3), np.uint8))
    assert len(found) == faces


def test_boxes_apart_stay_apart():
    found = FaceDetector(Anchors(0, 511)).detect(np.zeros((128, 128, 3), np.uint8))
    assert sorted(float(middle(each)[0]) for each in found) == pytest.approx([4, 124])


def test_the_larger_face_comes_before_the_surer_one():
    network = Anchors(0, 511, logits=[5.0, 0.5])
    first, second = FaceDetector(network).detect(np.zeros((128, 128, 3), np.uint8))
    assert first.score < second.score
    assert first.area == pytest.approx(4 * second.area)


def test_boxes_without_an_area_harm_nobody():
    network = Anchors(0, 1, 2, size=(0.0, 0.0))
    assert len(FaceDetector(network).detect(np.zeros((128, 128, 3), np.uint8))) == 3


def test_a_score_of_one_half_is_not_enough():
    network = Anchors(0, logits=[0.0])
    assert FaceDetector(network).detect(np.zeros((128, 128, 3), np.uint8)) == []
