import json
import os
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")
pytest.importorskip("kornia", reason="needs the train extra")

from agent_server.domain.skeleton import CoreJoint  # noqa: E402
from agent_server.errors import InvalidInput  # noqa: E402
from models.data.cmu import COLUMNS, JOINTS, read_cmu, read_file, read_skeleton  # noqa: E402

DATA = os.environ.get("AGENT_SERVER_DATA")


def make_set(folder: Path, rows: np.ndarray) -> Path:
    """A set of one recording whose bones all have 100 mm; arms point sideways."""
    parents = [-1, 0, 1, 2, 3, 4, 5, 0, 7, 8, 9, 10, 11, 0, 13, 14, 15, 16, 17, 18]
    parents += [15, 20, 21, 22, 23, 24, 25, 23, 27, 15, 29, 30, 31, 32, 33, 34, 32, 36]
    offsets = [[0.0, 100.0, 0.0]] * JOINTS
    offsets = [[100.0, 0.0, 0.0] if 20 <= j <= 28 else o for j, o in enumerate(offsets)]
    offsets = [[-100.0, 0.0, 0.0] if j >= 29 else o for j, o in enumerate(offsets)]
    root = folder / "cmu_mocap"
    (root / "train" / "walking").mkdir(parents=True)
    skeleton = {"unit": "mm", "parents": parents, "offsets": offsets}
    (root / "skeleton.json").write_text(json.dumps(skeleton))
    np.savetxt(root / "train" / "walking" / "walking_1.txt", rows, delimiter=",")
    return folder


def test_facing_the_sensor_the_right_hand_is_at_larger_x(tmp_path: Path) -> None:
    (motion,) = read_cmu(make_set(tmp_path, np.zeros((10, COLUMNS))), "train")
    x = motion.positions[0, :, 0]
    assert x[CoreJoint.RIGHT_WRIST] > x[CoreJoint.RIGHT_SHOULDER] > 0
    assert x[CoreJoint.LEFT_WRIST] < x[CoreJoint.LEFT_SHOULDER] < 0
    assert motion.label == "walking"
    assert motion.subject == "walking_1"


def test_every_second_row_is_a_frame_in_metres(tmp_path: Path) -> None:
    (motion,) = read_cmu(make_set(tmp_path, np.zeros((11, COLUMNS))), "train")
    assert motion.positions.shape == (6, 9, 3)
    arm = motion.positions[0, CoreJoint.LEFT_WRIST] - motion.positions[0, CoreJoint.LEFT_ELBOW]
    assert np.linalg.norm(arm) == pytest.approx(0.1)


def test_the_roots_own_orientation_is_dropped(tmp_path: Path) -> None:
    turned = np.zeros((4, COLUMNS))
    turned[:, 3:6] = [0.3, 1.0, -0.2]
    plain = make_set(tmp_path / "a", np.zeros((4, COLUMNS)))
    other = make_set(tmp_path / "b", turned)
    (a,), (b,) = read_cmu(plain, "train"), read_cmu(other, "train")
    np.testing.assert_array_equal(a.positions, b.positions)


def test_a_joints_rotation_moves_what_hangs_on_it(tmp_path: Path) -> None:
    bent = np.zeros((2, COLUMNS))
    left_elbow = 22
    bent[:, 3 + 3 * left_elbow + 1] = -np.pi / 2  # about y: the left forearm points forwards
    (motion,) = read_cmu(make_set(tmp_path, bent), "train")
    forearm = motion.positions[0, CoreJoint.LEFT_WRIST] - motion.positions[0, CoreJoint.LEFT_ELBOW]
    np.testing.assert_allclose(np.abs(forearm), [0, 0, 0.1], atol=1e-6)


def test_wrong_columns_and_missing_sets_are_named(tmp_path: Path) -> None:
    data = make_set(tmp_path, np.zeros((4, COLUMNS)))
    odd = tmp_path / "odd_1.txt"
    np.savetxt(odd, np.zeros((2, 5)), delimiter=",")
    with pytest.raises(InvalidInput, match="5 columns, expected 117"):
        read_file(odd, read_skeleton(data))
    with pytest.raises(InvalidInput, match="--data"):
        list(read_cmu(tmp_path / "nothing", "train"))


@pytest.mark.skipif(DATA is None, reason="needs cmu_mocap (AGENT_SERVER_DATA)")
def test_walkers_arms_hang_and_swing_towards_the_sensor() -> None:
    assert DATA is not None
    data = Path(DATA)
    path = data / "cmu_mocap" / "test" / "walking" / "walking_1.txt"
    motion = read_file(path, read_skeleton(data))
    arm = motion.positions[:, CoreJoint.RIGHT_WRIST] - motion.positions[:, CoreJoint.RIGHT_SHOULDER]
    assert arm[:, 1].mean() < -0.4  # metres, hanging
    assert arm[:, 2].min() < -0.15  # the sensor is at smaller z
