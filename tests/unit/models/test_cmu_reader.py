import json
import os
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")
pytest.importorskip("kornia", reason="needs the train extra")

from agent_server.domain.skeleton import CoreJoint  # noqa: E402
from agent_server.errors import InvalidInput  # noqa: E402
from models.data.cmu import (  # noqa: E402
    COLUMNS,
    JOINTS,
    read_cmu,
    read_cmu_positions,
    read_file,
    read_skeleton,
)
from models.data.kinematics import rotation_matrices  # noqa: E402
from models.data.splits import cmu_split  # noqa: E402

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


def test_positions_follow_the_published_recipe_in_mm(tmp_path: Path) -> None:
    rows = np.random.default_rng(4).normal(size=(5, COLUMNS))
    data = make_set(tmp_path, rows)
    ((key, positions),) = read_cmu_positions(data, "train").items()
    assert key == "walking/walking_1"
    assert positions.dtype == np.float32
    assert not positions.flags.writeable
    skeleton = read_skeleton(data)
    maps = rows[::2, 3:].reshape(3, JOINTS, 3)
    maps[:, 0] = 0.0
    local = rotation_matrices(torch.from_numpy(maps)).numpy()
    for frame in range(3):
        turned, places = [np.eye(3)], [np.array(skeleton.offsets[0])]
        for joint, parent in list(enumerate(skeleton.parents))[1:]:
            turned.append(local[frame, joint] @ turned[parent])
            places.append(np.array(skeleton.offsets[joint]) @ turned[parent] + places[parent])
        np.testing.assert_allclose(positions[frame], places, atol=1e-3)


def test_every_seventh_training_file_validates_in_every_reading(tmp_path: Path) -> None:
    data = make_set(tmp_path, np.zeros((4, COLUMNS)))
    folder = data / "cmu_mocap"
    rows = (folder / "train" / "walking" / "walking_1.txt").read_text()
    for action, count in {"train/jumping": 6, "train/walking": 6, "test/walking": 1}.items():
        (folder / action).mkdir(parents=True, exist_ok=True)
        for number in range(1, count + 1):
            (folder / action / f"{Path(action).name}_{number}.txt").write_text(rows)
    held = read_cmu_positions(data, "validation")
    assert list(held) == ["jumping/jumping_4", "walking/walking_5"]
    trained = read_cmu_positions(data, "train")
    assert len(trained) == 10
    assert not trained.keys() & held.keys()
    assert list(read_cmu_positions(data, "test")) == ["walking/walking_1"]
    for split, keys in (("train", trained), ("validation", held)):
        subjects = [recording.subject for recording in cmu_split(data, split)]
        assert subjects == [key.partition("/")[2] for key in keys]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "is empty"),
        (",".join(["0"] * 116), "line 1 has 116 columns, expected 117"),
        (",".join(["0"] * 117) + "\n\n" + ",".join(["0"] * 110), "line 3 has 110 columns"),
        (",".join(["0"] * 116 + ["left"]), "line 1, column 117 is 'left', expected a finite"),
        (",".join(["inf"] + ["0"] * 116), "line 1, column 1 is 'inf', expected a finite"),
    ],
)
def test_a_row_that_does_not_fit_is_named(tmp_path: Path, content: str, message: str) -> None:
    data = make_set(tmp_path, np.zeros((4, COLUMNS)))
    (data / "cmu_mocap" / "train" / "walking" / "walking_1.txt").write_text(content)
    with pytest.raises(InvalidInput, match=rf"walking_1\.txt.*{message}"):
        read_cmu_positions(data, "train")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"parents": [-1, 5, *range(1, 37)]}, r"parents\[1\] is 5, expected -1 or an earlier"),
        ({"parents": [-1]}, "has 1 joints, expected 38"),
        ({"offsets": [[0.0, 0.0]] * JOINTS}, "is no skeleton"),
    ],
)
def test_a_skeleton_that_is_no_tree_is_named(
    tmp_path: Path, change: dict[str, object], message: str
) -> None:
    data = make_set(tmp_path, np.zeros((4, COLUMNS)))
    path = data / "cmu_mocap" / "skeleton.json"
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    with pytest.raises(InvalidInput, match=message):
        read_cmu_positions(data, "train")


def test_a_split_without_files_is_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="test holds no ACTION/NAME_N"):
        read_cmu_positions(make_set(tmp_path, np.zeros((4, COLUMNS))), "test")


@pytest.mark.skipif(DATA is None, reason="needs cmu_mocap (AGENT_SERVER_DATA)")
def test_all_real_recordings_are_in_one_split_and_keep_their_bones() -> None:
    assert DATA is not None
    data = Path(DATA)
    splits = [read_cmu_positions(data, split) for split in ("train", "validation", "test")]
    assert [len(split) for split in splits] == [62, 10, 24]
    skeleton = read_skeleton(data)
    lengths = np.linalg.norm(skeleton.offsets[1:], axis=1)
    for positions in (each for split in splits for each in split.values()):
        bones = positions[:, 1:] - positions[:, skeleton.parents[1:]]
        np.testing.assert_allclose(
            np.linalg.norm(bones, axis=2), np.tile(lengths, (len(bones), 1)), atol=0.01
        )


@pytest.mark.skipif(DATA is None, reason="needs cmu_mocap (AGENT_SERVER_DATA)")
def test_walkers_arms_hang_and_swing_towards_the_sensor() -> None:
    assert DATA is not None
    data = Path(DATA)
    path = data / "cmu_mocap" / "test" / "walking" / "walking_1.txt"
    motion = read_file(path, read_skeleton(data))
    arm = motion.positions[:, CoreJoint.RIGHT_WRIST] - motion.positions[:, CoreJoint.RIGHT_SHOULDER]
    assert arm[:, 1].mean() < -0.4  # metres, hanging
    assert arm[:, 2].min() < -0.15  # the sensor is at smaller z
