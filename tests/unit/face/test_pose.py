"""Head poses of made-up and of real faces."""

import numpy as np
import pytest

from agent_server.domain.affect import AffectSample
from agent_server.domain.face import FaceLandmarks, FaceLayout
from agent_server.face.layouts import LEFT_PUPIL, RIGHT_PUPIL, to_dlib68
from agent_server.face.pose import INTER_PUPIL_M, canonical_points, head_pose, pose_indices
from agent_server.face.tracker import FaceTracker
from agent_server.synthetic.face import SyntheticFace, face_shapes
from tests.support.pictures import framed, labelled, needs_faces, picture


def landmarks(points, layout=FaceLayout.MESH478):
    return FaceLandmarks(0, layout, np.asarray(points, np.float32), 640, 480)


def mean_face(eyes_px=70.0, x=320.0, y=240.0):
    """The mean face from the front: the pupils level, at equal distances from (x, y)."""
    points = face_shapes().expression[0]
    middle = points[[RIGHT_PUPIL, LEFT_PUPIL]].mean(axis=0)
    return (points - middle) * eyes_px + (x, y, 0)


def test_a_frontal_face_looks_into_the_camera_from_where_it_is():
    for eyes_px in (40, 70, 120):
        pose = head_pose(landmarks(mean_face(eyes_px)))
        assert np.degrees((pose.yaw, pose.pitch, pose.roll)) == pytest.approx([0, 0, 0], abs=3)
        assert pose.translation[:2] == pytest.approx([0, 0], abs=0.005)
        assert pose.translation[2] == pytest.approx(INTER_PUPIL_M * 640 / eyes_px, rel=0.08)


def test_directions_are_the_images():
    pose = head_pose(landmarks(mean_face(x=420, y=160)))
    x, y, z = pose.translation
    assert x == pytest.approx(100 / 640 * z, abs=0.005)
    assert y == pytest.approx(-80 / 640 * z, abs=0.005)


@pytest.mark.parametrize("angle", [-0.5, -0.2, 0.3, 0.5])
@pytest.mark.parametrize("axis", ["yaw", "pitch", "roll"])
def test_a_turned_mesh_is_found_turned(axis, angle):
    """Turned by the mesh's own depth: the nose goes right or up, or the head tilts clockwise."""
    cosine, sine = np.cos(angle), np.sin(angle)
    turn = {
        "yaw": ((cosine, 0, -sine), (0, 1, 0), (sine, 0, cosine)),
        "pitch": ((1, 0, 0), (0, cosine, sine), (0, -sine, cosine)),
        "roll": ((cosine, -sine, 0), (sine, cosine, 0), (0, 0, 1)),
    }[axis]
    mesh = np.add(mean_face(60, 0, 0) @ np.transpose(turn), (320, 240, 0))
    for face in (landmarks(mesh), landmarks(to_dlib68(mesh), FaceLayout.DLIB68)):
        pose = head_pose(face)
        expected = {"yaw": 0.0, "pitch": 0.0, "roll": 0.0, axis: angle}
        for name, value in expected.items():
            assert getattr(pose, name) == pytest.approx(value, abs=np.radians(6)), name


def test_an_expression_moves_the_head_little():
    def pose(valence, arousal):
        # The same seed gives the same person in the same place at the same instant.
        person = SyntheticFace(np.random.default_rng(5))
        found = head_pose(person.show(AffectSample(0, valence, arousal), "mesh478"))
        return np.degrees((found.yaw, found.pitch, found.roll))

    neutral = pose(0.0, 0.0)
    for mood in ((6.0, 3.0), (-4.0, 4.0), (0.0, 6.0)):
        assert np.abs(pose(*mood) - neutral).max() < 8


@pytest.mark.parametrize("layout", list(FaceLayout))
def test_what_is_no_head_has_no_pose(layout):
    nowhere = np.full((layout.points, layout.axes), 100.0)
    assert head_pose(landmarks(nowhere, layout)) is None


def test_the_canonical_head_is_symmetric_and_of_human_size():
    for layout in FaceLayout:
        points = canonical_points(layout)
        assert len(points) == len(pose_indices(layout))
        distances = np.linalg.norm(points[:, None] * (-1, 1, 1) - points[None], axis=2)
        assert distances.min(axis=1).max() < 1e-9
    corners = canonical_points(FaceLayout.MESH478)[[0, 3]]
    assert 0.08 < np.linalg.norm(corners[1] - corners[0]) < 0.1


@needs_faces
def test_the_canonical_head_is_the_mean_of_real_ones(networks):
    """Up to a similarity, most faces are within a few millimetres of it."""
    canonical = canonical_points(FaceLayout.MESH478)
    canonical = canonical - canonical.mean(axis=0)
    distances = []
    for file in labelled(40):
        found = FaceTracker(networks.detector, networks.mesh).look(picture(file))
        points = found.points[pose_indices(FaceLayout.MESH478)].astype(np.float64)
        points -= points.mean(axis=0)
        u, s, v = np.linalg.svd(points.T @ canonical)
        flip = np.array((1, 1, np.sign(np.linalg.det(u @ v))))
        scale = (s * flip).sum() / np.square(points).sum()
        distances.append(scale * points @ (u * flip) @ v - canonical)
    assert np.linalg.norm(np.mean(distances, axis=0), axis=1).max() < 0.003
    assert np.linalg.norm(distances, axis=2).mean() < 0.006


@needs_faces
def test_mesh_and_68_points_of_real_faces_agree_and_mirror(networks):
    apart, mirrored = [], []
    for file in labelled(24):
        image = framed(picture(file))
        tracker = FaceTracker(networks.detector, networks.mesh)
        points = tracker.look(image).points
        tracker.reset()
        flipped = tracker.look(np.ascontiguousarray(image[:, ::-1])).points
        mesh, other = head_pose(landmarks(points)), head_pose(landmarks(flipped))
        few = head_pose(landmarks(to_dlib68(points), FaceLayout.DLIB68))
        apart.append((mesh.yaw - few.yaw, mesh.pitch - few.pitch, mesh.roll - few.roll))
        mirrored.append((mesh.yaw + other.yaw, mesh.pitch - other.pitch, mesh.roll + other.roll))
    assert (np.degrees(np.abs(apart)).mean(axis=0) < 4).all()
    assert (np.degrees(np.abs(mirrored)).mean(axis=0) < 2).all()
