"""Landmarks of painted and of real faces: where they are, how they follow, how they are lost."""

import cv2
import numpy as np
import pytest

from agent_server.domain.face import FaceLayout
from agent_server.errors import InferenceError
from agent_server.face.layouts import LEFT_PUPIL, RIGHT_PUPIL
from agent_server.face.mesh import FaceMesh
from agent_server.face.regions import Region, region_of_points
from agent_server.face.tracker import MIN_PRESENCE, FaceTracker
from tests.support.pictures import framed, labelled, needs_faces, picture

LEFT_OUTER, RIGHT_OUTER = 263, 33
EMPTY = np.full((480, 640, 3), 120, np.uint8)


class Counting:
    """A network that counts how often it runs, and fails when it is told to."""

    def __init__(self, network):
        self._network = network
        self.name, self.sha256 = network.name, network.sha256
        self.input_shape = network.input_shape
        self.runs = 0
        self.fails = False

    def run(self, given):
        self.runs += 1
        if self.fails:
            raise InferenceError("told to fail")
        return self._network.run(given)


def settled(tracker, image, looks=4):
    """What is found in a still picture once the region comes from points."""
    for _ in range(looks):
        found = tracker.look(image)
    return found


def error(found, points):
    """Mean distance of points in the image, as a share of the distance of the outer eye corners."""
    count = min(len(found), len(points))
    eyes = np.linalg.norm(points[LEFT_OUTER, :2] - points[RIGHT_OUTER, :2])
    distances = np.linalg.norm(found[:count, :2] - points[:count, :2], axis=1)
    return distances.mean() / eyes


def similarity(degrees, scale, centre, to):
    """Affine map (2, 3) that turns and scales about ``centre`` and brings it to ``to``."""
    turn = np.radians(degrees)
    linear = scale * np.array(((np.cos(turn), -np.sin(turn)), (np.sin(turn), np.cos(turn))))
    return np.column_stack((linear, to - linear @ centre))


def middle(found):
    return found.points[:468, :2].mean(axis=0)


@pytest.fixture(params=["mesh", "fast"])
def tracker(request, networks):
    return FaceTracker(networks.detector, getattr(networks, request.param))


def test_points_lie_where_they_were_painted(tracker, painted):
    for eyes in (55, 90, 130):
        image, points = painted(eyes=eyes)
        found = settled(tracker, image)
        assert error(found.points, points) < 0.04
        assert found.presence > 0.99
        tracker.reset()


def test_the_layout_is_the_networks(networks, painted):
    image, _ = painted()
    full = FaceTracker(networks.detector, networks.mesh).look(image)
    fast = FaceTracker(networks.detector, networks.fast).look(image)
    assert (full.layout, full.points.shape) == (FaceLayout.MESH478, (478, 3))
    assert (fast.layout, fast.points.shape) == (FaceLayout.MESH468, (468, 3))
    assert full.points.dtype == fast.points.dtype == np.float32


def test_depth_is_in_pixels_and_smaller_towards_the_camera(tracker, painted):
    found = settled(tracker, painted(eyes=60)[0]).points
    larger = settled(tracker, painted(eyes=120)[0]).points
    nose, ear = 4, 454
    assert found[nose, 2] < found[ear, 2] - 30
    assert larger[ear, 2] - larger[nose, 2] == pytest.approx(
        2 * (found[ear, 2] - found[nose, 2]), rel=0.1
    )


@pytest.mark.parametrize(
    ("degrees", "scale", "to"),
    [
        (0, 1.0, (250, 300)),
        (30, 1.0, (320, 240)),
        (-45, 0.8, (400, 200)),
        (15, 1.6, (300, 240)),
        (0, 0.7, (100, 380)),
    ],
)
def test_landmarks_follow_a_moved_turned_and_scaled_face(tracker, painted, degrees, scale, to):
    image, _ = painted(eyes=80)
    flat, deep = _off(tracker, image, similarity(degrees, scale, (320, 240), to))
    assert flat < 0.035
    assert deep < 0.1


@needs_faces
@pytest.mark.parametrize(
    ("degrees", "scale", "to"),
    [(25, 1.0, (280, 230)), (-35, 1.2, (340, 240)), (0, 0.8, (180, 300))],
)
def test_landmarks_follow_real_faces(tracker, degrees, scale, to):
    for file in labelled(4):
        image = framed(picture(file, 240))
        flat, deep = _off(tracker, image, similarity(degrees, scale, (320, 240), to))
        assert flat < 0.035
        assert deep < 0.1


def _off(tracker, image, change):
    """How far points and depths are from where a change puts them, in distances of the eyes."""
    tracker.reset()
    before = settled(tracker, image).points
    moved = cv2.warpAffine(image, change, (640, 480), borderValue=(90, 90, 90))
    tracker.reset()
    after = settled(tracker, moved).points
    expected = before[:, :2] @ change[:, :2].T + change[:, 2]
    scale = np.sqrt(np.linalg.det(change[:, :2]))
    eyes = np.linalg.norm(expected[LEFT_OUTER] - expected[RIGHT_OUTER])
    return error(after, expected), np.abs(after[:, 2] - scale * before[:, 2]).mean() / eyes


@needs_faces
def test_real_faces_are_found_and_both_meshes_agree_on_them(networks):
    files = labelled(60)
    distances = []
    for file in files:
        image = picture(file)
        full = FaceTracker(networks.detector, networks.mesh).look(image)
        fast = FaceTracker(networks.detector, networks.fast).look(image)
        if full is not None and fast is not None:
            distances.append(error(fast.points, full.points))
    assert len(distances) >= 0.98 * len(files)
    assert np.mean(distances) < 0.03


def test_there_is_no_face_in_an_empty_or_a_noisy_picture(tracker):
    noise = np.random.default_rng(0).integers(0, 256, (480, 640, 3), dtype=np.uint8)
    for image in (EMPTY, noise, np.zeros((1, 1, 3), np.uint8)):
        assert tracker.look(image) is None


def test_a_grey_face_is_found_where_the_coloured_is(tracker, painted):
    image, points = painted()
    grey = cv2.cvtColor(cv2.cvtColor(image, cv2.COLOR_RGB2GRAY), cv2.COLOR_GRAY2RGB)
    assert error(settled(tracker, grey).points, points) < 0.05


def test_a_followed_face_is_not_detected_again(networks, painted):
    detector, mesh = Counting(networks.detector), Counting(networks.mesh)
    tracker = FaceTracker(detector, mesh)
    for step in range(12):
        image, points = painted(x=200 + 12 * step, y=200 + 4 * step, eyes=70 + step)
        assert error(tracker.look(image).points, points) < 0.06
    assert detector.runs == 1
    assert mesh.runs == 12


def test_a_face_is_lost_and_found_again(networks, painted):
    detector = Counting(networks.detector)
    tracker = FaceTracker(detector, networks.mesh)
    assert tracker.look(painted(x=150)[0]) is not None
    assert tracker.look(EMPTY) is None
    assert tracker.look(EMPTY) is None
    image, points = painted(x=500)
    assert error(tracker.look(image).points, points) < 0.06
    tracker.look(image)
    assert detector.runs == 4, "once at first, in each empty image, and when it came back"


def test_a_face_that_jumps_is_found_in_the_same_image(tracker, painted):
    tracker.look(painted(x=120, eyes=60)[0])
    image, points = painted(x=520, eyes=60)
    found = tracker.look(image)
    assert found is not None
    assert error(found.points, points) < 0.06


def test_of_two_faces_the_larger_is_chosen_and_then_kept(tracker, painted):
    def pair(left_eyes, right_eyes):
        left = painted(x=160, eyes=left_eyes, width=320)[0]
        right = painted(x=160, eyes=right_eyes, width=320)[0]
        return np.concatenate((left, right), axis=1)

    assert middle(tracker.look(pair(75, 50)))[0] < 320
    for left, right in ((70, 60), (60, 70), (50, 75)):
        assert middle(tracker.look(pair(left, right)))[0] < 320, "the one that was followed"
    tracker.reset()
    assert middle(tracker.look(pair(50, 75)))[0] > 320, "the larger one"


def test_when_the_followed_face_goes_the_other_is_taken(tracker, painted):
    left, right = painted(x=160, eyes=75, width=320)[0], painted(x=160, eyes=50, width=320)[0]
    tracker.look(np.concatenate((left, right), axis=1))
    found = tracker.look(np.concatenate((np.full_like(left, 120), right), axis=1))
    assert middle(found)[0] > 320


@pytest.mark.parametrize(("x", "y"), [(60, 220), (580, 220), (320, 40), (320, 430)])
def test_a_face_at_the_border_has_points_beyond_it(tracker, painted, x, y):
    image, points = painted(x=x, y=y, eyes=80)
    assert (points[:468, :2] < 0).any() or (points[:468, :2] > (640, 480)).any()
    found = settled(tracker, image)
    assert found is not None
    assert error(found.points, points) < 0.08


def test_the_same_images_give_the_same_points(tracker, painted):
    images = [painted(x=300 + 5 * step)[0] for step in range(3)]
    first = [tracker.look(image).points.tobytes() for image in images]
    tracker.reset()
    assert [tracker.look(image).points.tobytes() for image in images] == first


def test_the_image_is_left_as_it_was(tracker, painted):
    image, _ = painted()
    before = image.copy()
    image.flags.writeable = False
    settled(tracker, image)
    assert np.array_equal(image, before)


def test_a_failure_is_told_and_the_face_is_still_followed_after_it(networks, painted):
    detector, mesh = Counting(networks.detector), Counting(networks.mesh)
    tracker = FaceTracker(detector, mesh)
    image, _ = painted()
    tracker.look(image)
    mesh.fails = True
    with pytest.raises(InferenceError, match="told to fail"):
        tracker.look(image)
    mesh.fails = False
    assert tracker.look(image) is not None
    assert detector.runs == 1


@pytest.mark.parametrize("name", ["mesh", "fast"])
def test_presence_tells_faces_from_other_things(networks, painted, name):
    mesh = FaceMesh(getattr(networks, name))
    image, points = painted()
    assert mesh.look(image, region_of_points(points)).presence > 0.99
    assert mesh.look(image, Region(80.0, 420.0, 120.0, 0.0)).presence < MIN_PRESENCE
    assert mesh.look(EMPTY, region_of_points(points)).presence < MIN_PRESENCE


def test_pupils_lie_in_the_eyes(networks, painted):
    found = settled(FaceTracker(networks.detector, networks.mesh), painted(eyes=90)[0]).points
    for pupil, corners in ((RIGHT_PUPIL, (33, 133)), (LEFT_PUPIL, (362, 263))):
        near, far = found[list(corners), 0]
        assert near < found[pupil, 0] < far
