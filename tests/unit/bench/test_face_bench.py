"""The face measurement measures every stage of a face, and says when there is none."""

import cv2
import numpy as np
import pytest

from agent_server.bench.face import measure_faces
from agent_server.errors import InvalidInput


@pytest.fixture(autouse=True)
def threads_as_before():
    before = cv2.getNumThreads()
    yield
    cv2.setNumThreads(before)


def test_every_stage_of_a_painted_face_is_measured():
    result = measure_faces(None, 3)
    assert (result.width, result.height, result.picture, result.rounds) == (640, 480, "painted", 3)
    full, fast = result.meshes["full"], result.meshes["fast"]
    parts = (full.crop, full.mesh, full.blendshapes, full.affect, fast.crop, fast.mesh, fast.affect)
    for part in (result.decode, result.detect, full.frame, fast.frame, *parts):
        assert 0 < part.p50_ms <= part.p95_ms <= part.p99_ms
    assert fast.blendshapes is None
    assert full.mesh.p50_ms > full.crop.p50_ms
    assert result.rss_mb is None or result.rss_mb > 20


@pytest.mark.parametrize(("width", "height"), [(50, 50), (1500, 300), (300, 1500)])
def test_a_picture_without_a_face_is_refused(tmp_path, width, height):
    path = tmp_path / "wall.png"
    cv2.imwrite(str(path), np.full((height, width, 3), 200, np.uint8))
    with pytest.raises(InvalidInput, match="no face"):
        measure_faces(path, 1)


@pytest.mark.parametrize("name", ["missing.png", "text.png"])
def test_what_is_no_picture_is_refused_by_name(tmp_path, name):
    (tmp_path / "text.png").write_text("no picture")
    with pytest.raises(InvalidInput, match=f"{name} cannot be read"):
        measure_faces(tmp_path / name, 1)
