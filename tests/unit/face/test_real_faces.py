"""What happens to one real face happens to others: lost, cut, grey, small, beside another."""

import numpy as np
import pytest

from agent_server.face.image import decode_jpeg
from agent_server.face.layouts import LEFT_PUPIL, RIGHT_PUPIL
from agent_server.face.tracker import FaceTracker
from tests.support.pictures import framed, jpeg, labelled, needs_faces, picture

pytestmark = needs_faces


@pytest.fixture
def tracker(networks):
    return FaceTracker(networks.detector, networks.mesh)


def middle(found):
    return found.points[:, :2].mean(axis=0)


def pupils(points):
    return float(np.linalg.norm(points[RIGHT_PUPIL, :2] - points[LEFT_PUPIL, :2]))


def apart(points, others):
    """Mean distance, as a share of the distance of the pupils."""
    return np.linalg.norm(points[:, :2] - others[:, :2], axis=1).mean() / pupils(others)


def test_a_face_is_lost_and_found_again_elsewhere(tracker):
    face = picture(labelled(1)[0])
    here, there = framed(face, x=20), framed(face, x=390)
    first = tracker.look(here)
    assert tracker.look(np.full_like(here, 90)) is None
    assert middle(tracker.look(there)) - middle(first) == pytest.approx([370, 0], abs=6)


def test_the_larger_of_two_faces_is_taken_and_kept(tracker):
    one, other = labelled(2)
    image = framed(picture(one, 300), x=10)
    image[100:220, 480:600] = picture(other, 120)
    assert middle(tracker.look(image))[0] < 320
    # The other one grows; the one that is followed is still there.
    image = framed(picture(one, 300), x=10)
    image[20:330, 325:635] = picture(other, 310)
    assert middle(tracker.look(image))[0] < 320
    tracker.reset()
    assert middle(tracker.look(image))[0] > 320


def test_a_face_cut_by_the_border_keeps_its_points(tracker):
    for file in labelled(4):
        whole = framed(picture(file, 300))
        expected = tracker.look(whole).points - (260, 0, 0)
        cut = np.ascontiguousarray(whole[:, 260:])
        tracker.reset()
        found = tracker.look(cut).points
        assert (expected[:, 0] < 0).sum() > 50, "a cheek and a part of an eye are cut off"
        assert apart(found, expected) < 0.06
        tracker.reset()


def test_a_grey_jpeg_shows_the_same_face(tracker):
    for file in labelled(4):
        image = framed(picture(file, 300))
        coloured = tracker.look(image).points
        tracker.reset()
        grey = image.mean(axis=2, keepdims=True).astype(np.uint8).repeat(3, axis=2)
        assert apart(tracker.look(decode_jpeg(jpeg(grey))).points, coloured) < 0.05
        tracker.reset()


def test_a_face_that_walks_away_is_followed_where_none_would_be_found(tracker):
    for file in labelled(4):
        large = tracker.look(framed(picture(file, 300))).points
        side = 300
        while side > 40:
            side = max(40, int(0.95 * side))
            small = framed(picture(file, side))
            found = tracker.look(small).points
        expected = (large - (320, 240, 0)) * (side / 300) + (320, 240, 0)
        assert apart(found, expected) < 0.1
        tracker.reset()
        assert tracker.look(small) is None, "too small to be detected"
