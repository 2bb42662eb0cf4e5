"""The face pipeline on real faces and on pictures without one."""

import cv2
import numpy as np
import pytest

from agent_server import assets
from agent_server.domain.face import ARKIT_BLENDSHAPES, FaceLayout
from agent_server.errors import InvalidInput
from agent_server.face.blendshapes import FaceBlendshaper
from agent_server.face.detector import FaceDetector
from agent_server.face.image import decode_jpeg, jpeg_size
from agent_server.face.layouts import MESH_TO_DLIB68, MIRROR_DLIB68, to_dlib68
from agent_server.face.regions import Region, region_of_points
from agent_server.face.tracker import FaceTracker
from agent_server.inference.runtime import OnnxFaceNetwork
from tests.support.pictures import framed, jpeg, labelled, needs_faces, picture


def network(name, role):
    return OnnxFaceNetwork(assets.bundles() / name, role)


@pytest.fixture(scope="module")
def networks():
    return {
        "detector": network("face_detector", "detector"),
        "mesh": network("face_mesh", "mesh"),
        "fast": network("face_mesh_fast", "mesh"),
    }


@pytest.fixture
def tracker(networks):
    return FaceTracker(networks["detector"], networks["mesh"])


def settled(tracker, image):
    for _ in range(4):
        found = tracker.look(image)
    return found.points


def pupils(points):
    return float(np.linalg.norm(points[468, :2] - points[473, :2]))


def turned(image, degrees, scale):
    height, width = image.shape[:2]
    matrix = cv2.getRotationMatrix2D((width / 2, height / 2), degrees, scale)
    return cv2.warpAffine(image, matrix, (width, height), borderMode=cv2.BORDER_REPLICATE), matrix


@needs_faces
@pytest.mark.parametrize(("degrees", "scale"), [(0, 0.5), (20, 0.8), (-25, 0.7)])
def test_points_follow_a_face_that_is_turned_and_scaled(networks, degrees, scale):
    image = framed(picture(labelled(1)[0], 400))
    plain = settled(FaceTracker(networks["detector"], networks["mesh"]), image)
    other, matrix = turned(image, degrees, scale)
    points = settled(FaceTracker(networks["detector"], networks["mesh"]), other)
    expected = plain[:, :2] @ matrix[:, :2].T + matrix[:, 2]
    apart = np.linalg.norm(points[:, :2] - expected, axis=1).mean()
    assert apart < 0.03 * pupils(points)


@needs_faces
def test_every_face_is_found_and_the_fast_mesh_agrees(networks):
    for file in labelled(12):
        image = framed(picture(file))
        full = FaceTracker(networks["detector"], networks["mesh"]).look(image)
        fast = FaceTracker(networks["detector"], networks["fast"]).look(image)
        assert (full.layout, fast.layout) == (FaceLayout.MESH478, FaceLayout.MESH468)
        assert full.presence > 0.9
        apart = np.linalg.norm(full.points[:468, :2] - fast.points[:, :2], axis=1).mean()
        assert apart < 0.1 * pupils(full.points)


@needs_faces
def test_a_face_is_lost_and_found_again_elsewhere(tracker):
    face = picture(labelled(1)[0])
    here, there = framed(face, x=20), framed(face, x=390)
    first = tracker.look(here)
    assert tracker.look(np.full_like(here, 90)) is None
    again = tracker.look(there)
    moved = (again.points - first.points)[:, 0].mean()
    assert moved == pytest.approx(370, abs=6)


@needs_faces
def test_the_larger_of_two_faces_is_taken_and_kept(tracker):
    one, other = labelled(2)
    image = framed(picture(one, 300), x=10)
    image[100:220, 480:600] = picture(other, 120)
    assert tracker.look(image).points[:, 0].mean() < 320
    # The other one grows; the one that is followed is still there.
    image = framed(picture(one, 300), x=10)
    image[20:330, 325:635] = picture(other, 310)
    assert tracker.look(image).points[:, 0].mean() < 320
    tracker.reset()
    assert tracker.look(image).points[:, 0].mean() > 320


@needs_faces
def test_a_face_at_the_border_and_a_grey_one_are_found(networks):
    face = picture(labelled(1)[0], 300)
    cut = framed(face)[:, 200:]
    grey = framed(np.repeat(face.mean(axis=2, keepdims=True), 3, axis=2).astype(np.uint8))
    for image in (cut, grey, decode_jpeg(jpeg(grey))):
        assert FaceTracker(networks["detector"], networks["mesh"]).look(image) is not None


@pytest.mark.parametrize("shape", [(480, 640, 3), (720, 1280, 3), (64, 48, 3)])
def test_no_face_is_none(tracker, shape):
    assert tracker.look(np.full(shape, 120, np.uint8)) is None
    noise = np.random.default_rng(0).integers(0, 255, shape, dtype=np.uint8)
    assert tracker.look(noise) is None


@needs_faces
def test_detections_have_eyes_inside_their_box_the_right_one_first(networks):
    (face, *_) = FaceDetector(networks["detector"]).detect(framed(picture(labelled(1)[0], 300)))
    right, left = face.keypoints[:2]
    assert (face.low < np.minimum(right, left)).all()
    assert (face.high > np.maximum(right, left)).all()
    assert right[0] < left[0]
    assert 0.5 < face.score <= 1


def test_a_crop_of_a_region_maps_back_to_the_image():
    image = np.zeros((200, 200, 3), np.uint8)
    image[60, 120] = 255
    region = Region(110, 70, 80, 0.3)
    crop = region.crop(image, 160)
    row, column = np.unravel_index(crop[..., 0].argmax(), crop.shape[:2])
    x, y = region.to_image(160) @ (column, row, 1)
    assert (x, y) == pytest.approx((120, 60), abs=0.6)


def test_the_region_of_points_is_half_as_large_again():
    points = np.zeros((478, 3), np.float32)
    points[:, :2] = np.random.default_rng(0).uniform(100, 200, (478, 2))
    points[33, :2], points[263, :2] = (120, 150), (180, 150)
    region = region_of_points(points)
    assert region.size == pytest.approx(1.5 * np.ptp(points[:, :2], axis=0).max())
    assert region.angle == 0


@needs_faces
def test_blendshapes_see_a_smile():
    shaper = FaceBlendshaper(network("face_blendshapes", "blendshapes"))
    networks = network("face_detector", "detector"), network("face_mesh", "mesh")
    smile = ARKIT_BLENDSHAPES.index("mouthSmileLeft")

    def mean_smile(valence):
        files = labelled(8, valence=valence)
        return np.mean(
            [
                shaper.read(FaceTracker(*networks).look(framed(picture(f))).points)[smile]
                for f in files
            ]
        )

    assert mean_smile((0.4, 1)) > mean_smile((-1, -0.4)) + 0.3


def test_the_map_to_68_points_keeps_left_and_right():
    assert len(MESH_TO_DLIB68) == len(set(MESH_TO_DLIB68.tolist())) == 68
    assert np.array_equal(MIRROR_DLIB68[MIRROR_DLIB68], np.arange(68))
    points = np.random.default_rng(0).random((2, 478, 3)).astype(np.float32)
    assert to_dlib68(points).shape == (2, 68, 2)


def test_the_size_of_a_jpeg_is_read_before_it_is_decoded():
    assert jpeg_size(jpeg(np.zeros((48, 64, 3), np.uint8))) == (64, 48)
    good = jpeg(np.full((64, 64, 3), 50, np.uint8))
    for bad, code in (
        (b"", "bad_image"),
        (good[:12], "bad_image"),
        (b"\xff\xd8" + bytes(40), "bad_image"),
        (jpeg(np.zeros((721, 1280, 3), np.uint8)), "image_too_large"),
    ):
        with pytest.raises(InvalidInput) as caught:
            decode_jpeg(bad)
        assert caught.value.code == code
    portrait = decode_jpeg(jpeg(np.zeros((1280, 720, 3), np.uint8)))
    assert portrait.shape == (1280, 720, 3)
