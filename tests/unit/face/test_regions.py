"""What a crop shows."""

import numpy as np
import pytest

from agent_server.face.regions import Region, region_of_points

YELLOW = (255, 200, 0)


def dotted(x, y):
    """A black picture with a yellow square of five pixels about a place."""
    image = np.zeros((480, 640, 3), np.uint8)
    image[y - 2 : y + 3, x - 2 : x + 3] = YELLOW
    return image


@pytest.mark.parametrize(
    "region",
    [
        Region(320, 240, 200, 0.0),
        Region(300, 250, 300, 0.7),
        Region(280, 200, 256, -2.0),
        Region(560, 400, 400, 0.3),
    ],
)
def test_a_place_is_shown_where_the_map_says(region):
    x, y = round(region.x + 0.1 * region.size), round(region.y - 0.2 * region.size)
    crop = region.crop(dotted(x, y), 256)
    assert crop.shape == (256, 256, 3)
    assert crop.dtype == np.uint8
    rows, columns = np.nonzero(crop[..., 0] > 127)
    to_image = region.to_image(256)
    place = to_image[:, :2] @ (columns.mean(), rows.mean()) + to_image[:, 2]
    assert np.allclose(place, (x, y), atol=1.0)


def test_pixels_are_kept_where_the_crop_is_as_large_as_its_region():
    image = np.random.default_rng(0).integers(0, 256, (480, 640, 3), dtype=np.uint8)
    crop = Region(320, 240, 128, 0.0).crop(image, 128)
    assert np.array_equal(crop, image[176:304, 256:384])


def test_beyond_the_image_its_edge_goes_on():
    image = np.zeros((480, 640, 3), np.uint8)
    image[:, -1] = YELLOW
    crop = Region(640, 240, 100, 0.0).crop(image, 100)
    assert (crop[:, 52:] == YELLOW).all()
    assert (crop[:, :48] == 0).all()


def test_the_region_of_a_mesh_is_half_as_large_again_and_lies_along_its_eyes():
    points = np.random.default_rng(0).uniform(100, 200, (478, 3)).astype(np.float32)
    points[33, :2], points[263, :2] = (120, 150), (180, 180)
    points[7, :2], points[9, :2] = (80, 140), (150, 210)
    region = region_of_points(points)
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    assert (region.x, region.y) == pytest.approx(tuple((low + high) / 2))
    assert region.size == pytest.approx(1.5 * max(high - low))
    assert region.angle == pytest.approx(np.arctan2(30, 60))
