"""What holds of head poses and of regions whatever the face."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from agent_server.domain.face import FaceLandmarks, FaceLayout
from agent_server.face.pose import HeadPose, canonical_points, head_pose, pose_indices
from agent_server.face.regions import Region, region_of_box, region_of_points

law = settings(derandomize=True, deadline=None, max_examples=150)
WIDTH, HEIGHT = 640, 480
LAYOUTS = st.sampled_from(list(FaceLayout))


def angles(limit: float) -> st.SearchStrategy[float]:
    return st.floats(-limit, limit)


regions = st.builds(
    Region, st.floats(-200, 900), st.floats(-200, 900), st.floats(20, 1500), angles(np.pi)
)
poses = st.builds(
    HeadPose,
    yaw=angles(1.2),
    pitch=angles(1.2),
    roll=angles(3.1),
    translation=st.tuples(st.floats(-0.3, 0.3), st.floats(-0.2, 0.2), st.floats(0.35, 2.0)),
)


def seen(pose: HeadPose, layout: FaceLayout) -> FaceLandmarks:
    """What the assumed camera sees of the canonical head; other points are left at 0."""
    head = canonical_points(layout) @ pose.rotation.T + pose.translation
    points = np.zeros((layout.points, layout.axes), dtype=np.float32)
    points[pose_indices(layout), :2] = head[:, :2] / head[:, 2:] * WIDTH + (WIDTH / 2, HEIGHT / 2)
    return FaceLandmarks(0, layout, points, WIDTH, HEIGHT)


def changed(face: FaceLandmarks, linear: np.ndarray, indices: np.ndarray) -> FaceLandmarks:
    """A face after a linear change of the image about its centre; ``indices`` rename points."""
    centre = np.array((WIDTH / 2, HEIGHT / 2))
    points = face.points.copy()
    moved = (face.points[indices, :2] - centre) @ linear.T + centre
    points[pose_indices(face.layout), :2] = moved
    return FaceLandmarks(0, face.layout, points, WIDTH, HEIGHT)


def mirrored_indices(layout: FaceLayout) -> np.ndarray:
    """The layout's pose points in the order of their mirror images."""
    points = canonical_points(layout)
    distances = np.linalg.norm(points[:, None] * (-1, 1, 1) - points[None], axis=2)
    return pose_indices(layout)[distances.argmin(axis=1)]


def turn(angle: float) -> np.ndarray:
    return np.array(((np.cos(angle), -np.sin(angle)), (np.sin(angle), np.cos(angle))))


def assert_same_pose(found: HeadPose | None, expected: HeadPose, tolerance: float = 2e-3) -> None:
    assert found is not None
    difference = np.abs(found.rotation - expected.rotation).max()
    assert difference < tolerance
    distance = np.subtract(found.translation, expected.translation)
    assert np.abs(distance).max() < tolerance * expected.translation[2]


@law
@given(poses, LAYOUTS)
def test_a_known_pose_is_found_back(pose: HeadPose, layout: FaceLayout) -> None:
    found = head_pose(seen(pose, layout))
    assert_same_pose(found, pose)
    assert found is not None
    assert abs(found.yaw - pose.yaw) < 5e-3
    assert abs(found.pitch - pose.pitch) < 5e-3
    assert abs(np.angle(np.exp(1j * (found.roll - pose.roll)))) < 5e-3


@law
@given(poses, LAYOUTS, angles(1.0))
def test_turning_the_image_changes_the_roll_alone(
    pose: HeadPose, layout: FaceLayout, angle: float
) -> None:
    face = changed(seen(pose, layout), turn(angle), pose_indices(layout))
    x, y = turn(angle) @ pose.translation[:2]
    expected = HeadPose(pose.yaw, pose.pitch, pose.roll + angle, (x, y, pose.translation[2]))
    assert_same_pose(head_pose(face), expected)


@law
@given(poses, LAYOUTS)
def test_a_mirrored_face_has_mirrored_yaw_and_roll(pose: HeadPose, layout: FaceLayout) -> None:
    mirror = np.diag((-1.0, 1.0))
    face = changed(seen(pose, layout), mirror, mirrored_indices(layout))
    x, y, z = pose.translation
    assert_same_pose(head_pose(face), HeadPose(-pose.yaw, pose.pitch, -pose.roll, (-x, y, z)))


@law
@given(poses, LAYOUTS, st.integers(0, 2**32 - 1))
def test_the_pose_bears_jitter(pose: HeadPose, layout: FaceLayout, seed: int) -> None:
    """A hundredth of the distance of the pupils, which is what the networks leave."""
    face = seen(HeadPose(pose.yaw / 2, pose.pitch / 2, pose.roll, pose.translation), layout)
    eyes_px = 0.063 / pose.translation[2] * WIDTH
    noise = np.random.default_rng(seed).normal(0, 0.01 * eyes_px, face.points.shape)
    points = (face.points + noise).astype(np.float32)
    found = head_pose(FaceLandmarks(0, layout, points, WIDTH, HEIGHT))
    assert found is not None
    expected = HeadPose(pose.yaw / 2, pose.pitch / 2, pose.roll, pose.translation)
    between = expected.rotation.T @ found.rotation
    assert np.degrees(np.arccos(np.clip((np.trace(between) - 1) / 2, -1, 1))) < 9
    assert abs(found.translation[2] / pose.translation[2] - 1) < 0.1


@law
@given(LAYOUTS, st.integers(0, 2**32 - 1), st.floats(0, 1))
def test_whatever_points_are_a_head_it_is_in_front_of_the_camera(
    layout: FaceLayout, seed: int, height: float
) -> None:
    points = np.random.default_rng(seed).uniform(0, 640, (layout.points, layout.axes))
    points[:, 1] *= height
    found = head_pose(FaceLandmarks(0, layout, points.astype(np.float32), WIDTH, HEIGHT))
    assert found is None or found.translation[2] > 0


@law
@given(poses)
def test_a_rotation_turns_nothing_inside_out(pose: HeadPose) -> None:
    assert np.allclose(pose.rotation @ pose.rotation.T, np.eye(3), atol=1e-9)
    assert np.isclose(np.linalg.det(pose.rotation), 1)


@law
@given(regions, st.integers(8, 512))
def test_a_crop_covers_its_region(region: Region, side: int) -> None:
    to_image = region.to_image(side).astype(np.float64)
    corners = np.array(((0, 0), (side, 0), (side, side), (0, side)), dtype=np.float64)
    placed = corners @ to_image[:, :2].T + to_image[:, 2]
    tolerance = 1e-3 * region.size
    assert np.allclose(placed.mean(axis=0), (region.x, region.y), atol=tolerance)
    along = placed[1] - placed[0]
    assert np.isclose(np.hypot(*along), region.size, atol=tolerance)
    assert np.isclose(np.hypot(*(placed[3] - placed[0])), region.size, atol=tolerance)
    assert np.allclose(along / region.size, (np.cos(region.angle), np.sin(region.angle)), atol=1e-3)
    # Downwards in the crop is a quarter turn clockwise from rightwards: nothing is mirrored.
    assert np.cross(np.append(along, 0), np.append(placed[3] - placed[0], 0))[2] > 0


@law
@given(
    st.integers(0, 2**32 - 1),
    st.floats(0.2, 5.0),
    st.tuples(st.floats(-300, 300), st.floats(-300, 300)),
)
def test_the_region_goes_with_the_face(seed: int, scale: float, shift: tuple[float, float]) -> None:
    points = np.random.default_rng(seed).uniform(0, 300, (478, 3)).astype(np.float32)
    before = region_of_points(points)
    moved = (points * scale + (*shift, 0)).astype(np.float32)
    after = region_of_points(moved)
    tolerance = 1e-3 * max(1.0, scale)
    assert np.isclose(after.x, before.x * scale + shift[0], atol=tolerance)
    assert np.isclose(after.y, before.y * scale + shift[1], atol=tolerance)
    assert np.isclose(after.size, before.size * scale, rtol=1e-4)
    assert np.isclose(after.angle, before.angle, atol=1e-3)


@law
@given(angles(3.1), st.floats(10, 300), st.floats(10, 300))
def test_the_eyes_lie_level_in_the_crop(angle: float, wide: float, high: float) -> None:
    low, high_corner = np.array((50.0, 60.0)), np.array((50.0 + wide, 60.0 + high))
    right_eye = np.array((100.0, 100.0))
    left_eye = right_eye + 40 * np.array((np.cos(angle), np.sin(angle)))
    boxed = (low, high_corner, right_eye, left_eye)
    region = region_of_box(*(each.astype(np.float32) for each in boxed))
    assert np.isclose(region.size, 1.5 * max(wide, high), rtol=1e-5)
    to_image = np.vstack((region.to_image(256), (0, 0, 1))).astype(np.float64)
    eyes = np.array(((*right_eye, 1), (*left_eye, 1))) @ np.linalg.inv(to_image).T
    assert np.isclose(eyes[0, 1], eyes[1, 1], atol=0.02)
    assert eyes[0, 0] < eyes[1, 0], "the person's right eye is on the left"
