import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from agent_server.errors import InvalidInput, RecordingError
from agent_server.skeleton.readers.mat5 import read_mat5

Mat5 = Callable[..., bytes]


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("packed", [True, False])
@pytest.mark.parametrize(
    "array",
    [
        np.arange(24, dtype="f8").reshape(2, 3, 4) / 7,
        np.array([[1.5]], dtype="f4"),
        np.array([[1, 2, 3]], dtype="u1"),
        np.zeros((0, 3), dtype="f8"),
    ],
    ids=["double", "single", "bytes", "empty"],
)
def test_an_array_comes_back(
    tmp_path: Path, mat5: Mat5, array: np.ndarray, packed: bool, order: str
) -> None:
    path = tmp_path / "a.mat"
    path.write_bytes(mat5("curve_B", array, order=order, packed=packed))
    back = read_mat5(path)
    assert list(back) == ["curve_B"]
    assert back["curve_B"].dtype == array.dtype
    np.testing.assert_array_equal(back["curve_B"], array)


def test_numbers_stored_small_keep_their_class(tmp_path: Path, mat5: Mat5) -> None:
    path = tmp_path / "a.mat"
    array = np.array([[1.0, 200.0, -3.0]])
    path.write_bytes(mat5("x", array, stored="i2"))
    back = read_mat5(path)["x"]
    assert back.dtype == np.float64
    np.testing.assert_array_equal(back, array)


def test_text_is_left_out(tmp_path: Path, mat5: Mat5) -> None:
    path = tmp_path / "a.mat"
    text = bytearray(mat5("note", np.array([[65]], dtype="u1"), packed=False))
    text[144] = 4  # the class of the array: characters
    numbers = mat5("x", np.ones((2, 2)))
    path.write_bytes(bytes(text) + numbers[128:])
    assert list(read_mat5(path)) == ["x"]


def test_another_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.mat"
    path.write_bytes(b"\x89HDF\r\n" + bytes(200))
    with pytest.raises(InvalidInput, match=r"a\.mat is no MAT-file of level 5.*-v7"):
        read_mat5(path)
    with pytest.raises(RecordingError, match="cannot be read"):
        read_mat5(tmp_path / "none.mat")


@pytest.mark.parametrize("packed", [True, False])
def test_a_damaged_file_is_named_wherever_it_ends(tmp_path: Path, mat5: Mat5, packed: bool) -> None:
    whole = mat5("x", np.random.default_rng(3).normal(size=(3, 5)), packed=packed)
    for size in range(129, len(whole)):
        path = tmp_path / "cut.mat"
        path.write_bytes(whole[:size])
        with pytest.raises(InvalidInput, match=r"cut\.mat is damaged"):
            read_mat5(path)


def test_scipy_reads_the_same_from_real_files() -> None:
    data = os.environ.get("AGENT_SERVER_DATA")
    if data is None:
        pytest.skip("AGENT_SERVER_DATA is not set: no real MAT-files")
    scipy_io = pytest.importorskip("scipy.io", reason="scipy is not installed")
    paths = [
        path
        for folder in ("utd_mhad", "sbu", "k3hi")
        for path in sorted(Path(data, folder).rglob("*.mat"))[::60]
    ]
    if not paths:
        pytest.skip(f"{data} has no utd_mhad, sbu or k3hi")
    for path in paths:
        theirs = {k: v for k, v in scipy_io.loadmat(path).items() if not k.startswith("__")}
        ours = read_mat5(path)
        assert ours.keys() == theirs.keys(), path
        for name, array in theirs.items():
            assert ours[name].dtype == array.dtype
            np.testing.assert_array_equal(ours[name], array)
