import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from agent_server.errors import InvalidInput
from agent_server.skeleton.readers.source import Mark
from agent_server.skeleton.readers.utd_mhad import read_utd_mhad

Mat5 = Callable[..., bytes]


def test_a_recording(tmp_path: Path, mat5: Mat5) -> None:
    path = tmp_path / "a3_s2_t1_skeleton.mat"
    track = np.random.default_rng(1).normal(size=(20, 3, 7))
    path.write_bytes(mat5("d_skel", track))
    recording = read_utd_mhad(path)
    assert recording.subject == "utd_mhad_s2"
    assert recording.marks == (Mark(0, "a3"),)
    assert recording.end_ns == 200_000_000
    assert [frame.originating_ns for frame in recording.frames][:3] == [0, 33_333_333, 66_666_667]
    for index, frame in enumerate(recording.frames):
        assert frame.format == "utd_mhad"
        np.testing.assert_array_equal(frame.joints[:, :3], track[:, :, index].astype(np.float32))
        assert (frame.joints[:, 3] == 1.0).all()


@pytest.mark.parametrize(
    ("name", "variable", "shape", "what"),
    [
        ("wave.mat", "d_skel", (20, 3, 2), "not named"),
        ("a3_s2_t1_skeleton.mat", "other", (20, 3, 2), "found nothing"),
        ("a3_s2_t1_skeleton.mat", "d_skel", (25, 3, 2), "found 25x3x2"),
        ("a3_s2_t1_skeleton.mat", "d_skel", (20, 3), "found 20x3"),
    ],
)
def test_another_content_is_named(
    tmp_path: Path, mat5: Mat5, name: str, variable: str, shape: tuple[int, ...], what: str
) -> None:
    path = tmp_path / name
    path.write_bytes(mat5(variable, np.zeros(shape)))
    with pytest.raises(InvalidInput, match=what) as caught:
        read_utd_mhad(path)
    assert path.name in str(caught.value)


def test_a_number_that_is_not_finite_is_refused(tmp_path: Path, mat5: Mat5) -> None:
    path = tmp_path / "a3_s2_t1_skeleton.mat"
    path.write_bytes(mat5("d_skel", np.full((20, 3, 1), np.inf)))
    with pytest.raises(InvalidInput, match="not finite"):
        read_utd_mhad(path)


def test_a_real_recording() -> None:
    data = os.environ.get("AGENT_SERVER_DATA")
    path = Path(data or "", "utd_mhad", "a3_s1_t1_skeleton.mat")
    if data is None or not path.exists():
        pytest.skip("AGENT_SERVER_DATA has no utd_mhad")
    recording = read_utd_mhad(path)
    assert len(recording.frames) == 72
    joints = np.stack([frame.joints for frame in recording.frames])
    up = joints[:, 0, 1] - joints[:, 3, 1]  # head above hip centre, metres
    assert 0.4 < up.min() < up.max() < 0.9
    assert (joints[:, 8, 0] > joints[:, 4, 0]).all()  # the right shoulder at larger x
