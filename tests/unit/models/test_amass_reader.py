"""AMASS-style files: the pose, the frame, the rate, and what is refused."""

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")
pytest.importorskip("kornia", reason="needs the train extra")

from agent_server.domain.skeleton import CoreJoint  # noqa: E402
from agent_server.errors import InvalidInput  # noqa: E402
from models.data.amass import SKELETON, read_amass  # noqa: E402

NAMES = [name for name, _, _ in SKELETON]
UPPER_ARM, FOREARM = 0.316, 0.248


@pytest.fixture
def save(tmp_path):
    def write(poses, **fields):
        path = tmp_path / "Subject7" / "wave_poses.npz"
        path.parent.mkdir(exist_ok=True)
        content = {
            "trans": np.zeros((len(poses), 3)),
            "mocap_framerate": np.array(25.0),
            "gender": np.array("female"),
            "betas": np.full(16, 3.0),
            **fields,
        }
        kept = {name: value for name, value in content.items() if value is not None}
        np.savez(path, poses=poses, **kept)
        return path

    return write


def turned(frames=1, width=156, **turns):
    """Poses with some joints turned, by their names with _ for a space."""
    poses = np.zeros((frames, width))
    for name, turn in turns.items():
        joint = NAMES.index(name.replace("_", " "))
        poses[:, 3 * joint : 3 * joint + 3] = turn
    return poses


def test_at_rest_the_arms_are_out_and_the_body_faces_the_sensor(save):
    motion = read_amass(save(turned(4)))
    assert motion.positions.shape == (4, 9, 3)
    assert not motion.positions.flags.writeable
    assert (motion.rate_hz, motion.source) == (25, "amass")
    assert (motion.subject, motion.label) == ("Subject7", "wave_poses")
    pose = motion.positions[0]
    reach = 0.19 + UPPER_ARM + FOREARM
    np.testing.assert_allclose(pose[CoreJoint.RIGHT_WRIST], [reach, 0.43, 2.5], atol=1e-6)
    np.testing.assert_allclose(pose[CoreJoint.LEFT_WRIST], [-reach, 0.43, 2.5], atol=1e-6)
    np.testing.assert_allclose(pose[CoreJoint.NAVEL], [0, 0.22, 2.5], atol=1e-6)
    np.testing.assert_allclose(pose[CoreJoint.HEAD], [0, 0.63, 2.46], atol=1e-6)


def test_a_quarter_turn_lowers_an_arm_and_another_points_at_the_sensor(save):
    # About z the left arm, along x, comes down; about y the right forearm, along -x, forwards.
    poses = turned(left_shoulder=(0, 0, -np.pi / 2), right_elbow=(0, np.pi / 2, 0))
    pose = read_amass(save(poses)).positions[0]
    arm = pose[CoreJoint.LEFT_WRIST] - pose[CoreJoint.LEFT_SHOULDER]
    np.testing.assert_allclose(arm, [0, -UPPER_ARM - FOREARM, 0], atol=1e-5)
    forearm = pose[CoreJoint.RIGHT_WRIST] - pose[CoreJoint.RIGHT_ELBOW]
    np.testing.assert_allclose(forearm, [0, 0, -FOREARM], atol=1e-5)


def test_nodding_moves_the_middle_of_the_head(save):
    pose = read_amass(save(turned(head=(np.pi / 2, 0, 0)))).positions[0]
    upright = read_amass(save(turned())).positions[0]
    moved = np.linalg.norm(pose - upright, axis=1) > 1e-3
    assert np.flatnonzero(moved).tolist() == [CoreJoint.HEAD]
    assert pose[CoreJoint.HEAD, 2] < upright[CoreJoint.HEAD, 2]  # towards the sensor


@pytest.mark.parametrize("width", [72, 156, 165])
def test_all_body_models_begin_with_the_same_joints(save, width):
    poses = turned(2, width, left_elbow=(0.1, 0.5, 0.2), spine_3=(0.3, 0, 0.1))
    poses[:, 66:] = 0.7  # hands and face are beyond the body
    motion = read_amass(save(poses))
    expected = read_amass(save(turned(2, left_elbow=(0.1, 0.5, 0.2), spine_3=(0.3, 0, 0.1))))
    np.testing.assert_array_equal(motion.positions, expected.positions)


def test_neither_the_roots_motion_nor_the_shape_counts(save):
    plain = read_amass(save(turned(2, left_elbow=(0, 0.4, 0))))
    moved = turned(2, left_elbow=(0, 0.4, 0), pelvis=(1.0, 0.2, -2.0))
    other = read_amass(save(moved, trans=np.ones((2, 3)), betas=np.zeros(10)))
    np.testing.assert_array_equal(plain.positions, other.positions)


@pytest.mark.parametrize("field", ["mocap_framerate", "mocap_frame_rate"])
def test_positions_are_interpolated_to_25_hz(save, field):
    poses = turned(121)  # 0 to 1 s at 120 Hz
    poses[:, 3 * NAMES.index("left elbow") + 1] = np.linspace(0, 1, 121)
    rates = {"mocap_framerate": None, field: np.array(120.0)}
    motion = read_amass(save(poses, **rates))
    assert motion.positions.shape == (26, 9, 3)
    angle = np.arange(26) / 25
    forearm = motion.positions[:, CoreJoint.LEFT_WRIST] - motion.positions[:, CoreJoint.LEFT_ELBOW]
    expected = FOREARM * np.stack([-np.cos(angle), 0 * angle, np.sin(angle)], axis=1)
    np.testing.assert_allclose(forearm, expected, atol=1e-5)


REFUSED = {
    "no rate": (turned(), {"mocap_framerate": None}, "neither mocap_framerate nor"),
    "no frames": (np.zeros((0, 156)), {}, r"poses: shape \(0, 156\)"),
    "odd width": (np.zeros((3, 63)), {}, r"poses: shape \(3, 63\), expected \(T, 72\) for SMPL"),
    "odd rate": (turned(), {"mocap_framerate": np.zeros(2)}, r"mocap_framerate: shape \(2,\)"),
    "no rate at all": (turned(), {"mocap_framerate": np.array(0.0)}, "the rate is 0 Hz"),
    "words": (np.array([["a"] * 72]), {}, "poses: no array of numbers"),
    "objects": (np.array([[None] * 72]), {}, "poses: no array of numbers"),
    "a hole": (np.full((2, 72), np.inf), {}, r"poses\[0, 0\] is inf: cut"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_does_not_fit_is_named(save, case):
    poses, fields, message = REFUSED[case]
    with pytest.raises(InvalidInput, match=message):
        read_amass(save(poses, **fields))


def test_other_files_are_refused_without_running_them(tmp_path):
    with pytest.raises(InvalidInput, match=r"none\.npz cannot be read"):
        read_amass(tmp_path / "none.npz")
    (tmp_path / "text.npz").write_text("hello")
    with pytest.raises(InvalidInput, match=r"text\.npz cannot be read"):
        read_amass(tmp_path / "text.npz")
    np.save(tmp_path / "single.npy", np.zeros((2, 72)))
    with pytest.raises(InvalidInput, match="single array"):
        read_amass(tmp_path / "single.npy")
    np.savez(tmp_path / "shape.npz", betas=np.zeros(10), mocap_framerate=60.0)
    with pytest.raises(InvalidInput, match="has no poses, only betas, mocap_framerate"):
        read_amass(tmp_path / "shape.npz")
