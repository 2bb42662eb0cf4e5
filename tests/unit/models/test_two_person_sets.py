"""Small made-up files in the published formats of NTU RGB+D 120 and DuetDance."""

from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="needs the train extra")

from scipy.io import savemat  # noqa: E402

from agent_server.errors import ConfigError, InvalidInput  # noqa: E402
from models.data.duetdance import DUETDANCE, NECK, ORDER, TRUNK_M  # noqa: E402
from models.data.interaction_sets import TWO_PERSON_SETS, two_person_set  # noqa: E402
from models.data.interactions import TORSO, Pairs  # noqa: E402
from models.data.ntu_mutual import LABELS, NTU_MUTUAL, TRAINING_SUBJECTS  # noqa: E402
from tests.support.interactions import STANDING, body  # noqa: E402


def ntu_body(identity: int, x: float) -> list[str]:
    """The lines of one body whose joint j is at (x, j / 10, 3)."""
    joints = [f"{x} {joint / 10} 3.0 0 0 0 0 0 0 0 1 2" for joint in range(25)]
    return [f"{identity} 0 1 1 0 0 0 0.1 -0.1 2", "25", *joints]


def write_ntu(data: Path, name: str, frames: list[list[tuple[int, float]]]) -> None:
    lines = [str(len(frames))]
    for bodies in frames:
        lines.append(str(len(bodies)))
        for identity, x in bodies:
            lines += ntu_body(identity, x)
    folder = data / "ntu" / "nturgb+d_skeletons"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.skeleton").write_text("\n".join(lines) + "\n")


def both(count: int) -> list[list[tuple[int, float]]]:
    return [[(7, 0.01 * at), (9, 1.0)] for at in range(count)]


def test_mutual_actions_are_split_by_performers(tmp_path: Path) -> None:
    write_ntu(tmp_path, "S001C001P001R001A058", both(12))
    write_ntu(tmp_path, "S001C001P003R001A106", both(14))
    write_ntu(tmp_path, "S001C001P001R001A001", both(12))  # one person's action
    (one,) = NTU_MUTUAL.read(tmp_path, "train")
    assert (one.name, one.label, one.group) == ("S001C001P001R001A058", "shaking hands", "P001")
    assert one.action.shape == one.reaction.shape == (12, 15, 3)
    np.testing.assert_allclose(one.action[:, TORSO, 0], 0.01 * np.arange(12), atol=1e-6)
    np.testing.assert_allclose(one.action[0, :3, 1], [0.3, 2.0, 0.1])  # head, neck, torso
    (other,) = NTU_MUTUAL.read(tmp_path, "test")
    assert other.label == "hitting with object"
    assert len(Pairs.of([one, other], NTU_MUTUAL.labels)) == 2


def test_a_person_who_is_lost_for_a_while_keeps_the_last_pose(tmp_path: Path) -> None:
    frames = both(14)
    frames[5] = [(7, 0.5)]
    frames[:1] = [[], [(9, 1.0)], [(7, 0.0), (9, 2.0)]]
    frames += [[(7, 0.3)], [(11, 4.0)]]
    write_ntu(tmp_path, "S001C001P002R001A051", frames)
    (one,) = NTU_MUTUAL.read(tmp_path, "train")
    # Who is seen longer comes first; the time is that from the first to the last frame with both.
    walker, waiter = (one.action, one.reaction)
    if one.action[-1, TORSO, 0] > 0.9:
        walker, waiter = waiter, walker
    assert len(walker) == 14
    np.testing.assert_allclose(waiter[:2, TORSO, 0], [2.0, 1.0])
    assert waiter[5, TORSO, 0] == 1.0 and walker[5, TORSO, 0] == pytest.approx(0.5)


def test_recordings_without_two_people_are_counted(tmp_path: Path) -> None:
    write_ntu(tmp_path, "S001C001P001R001A050", [[(7, 0.1)]] * 12)
    write_ntu(tmp_path, "S001C001P001R002A050", [[(7, 0.1)]] * 12 + [[(9, 0.1)]] * 12)
    write_ntu(tmp_path, "S001C002P001R001A050", both(4))
    read, dropped = NTU_MUTUAL.read_counted(tmp_path, "train")
    assert not read and dropped == {"one_person": 2, "short": 1}
    with pytest.raises(InvalidInput, match="holds no train interaction of two people"):
        NTU_MUTUAL.read(tmp_path, "train")


def test_the_published_split_and_its_classes() -> None:
    assert len(TRAINING_SUBJECTS) == 53 and max(TRAINING_SUBJECTS) <= 106
    assert list(LABELS) == [f"A{n:03d}" for n in (*range(50, 61), *range(106, 121))]
    assert len(set(LABELS.values())) == 26


def write_dance(data: Path, part: str, name: str, frames: int, size: float) -> None:
    folder = data / "duetdance" / "Skeletons" / name
    folder.mkdir(parents=True)
    for person in ("A", "B"):
        motion = np.stack([body(0.01 * at) for at in range(frames)]) * size
        theirs = np.empty_like(motion)
        theirs[:, list(ORDER)] = motion * [-1, -1, 1]  # y down
        curve = theirs.transpose(2, 1, 0).reshape(45, frames)
        savemat(folder / f"skeleton_{person}.mat", {"skel": curve})
    line = f"Skeletons/{name}/skeleton_A.mat Skeletons/{name}/skeleton_B.mat\n"
    (data / "duetdance" / f"{part}.txt").write_text(line)


def test_dances_are_read_in_one_size_with_y_up(tmp_path: Path) -> None:
    write_dance(tmp_path, "Train", "cha-cha/0011", 30, size=0.2)
    write_dance(tmp_path, "Test", "samba/0001", 20, size=7.0)
    (one,), (other,) = DUETDANCE.read(tmp_path, "train"), DUETDANCE.read(tmp_path, "test")
    assert (one.name, one.label, other.label) == ("cha-cha/0011", "cha-cha", "samba")
    trunk = STANDING[NECK, 1] - STANDING[TORSO, 1]
    for dance, frames in ((one, 30), (other, 20)):
        expected = np.stack([body(0.01 * at) for at in range(frames)]) * TRUNK_M / trunk
        np.testing.assert_allclose(dance.action, expected, atol=1e-5)


def test_a_dance_of_another_format_is_refused(tmp_path: Path) -> None:
    write_dance(tmp_path, "Train", "salsa/0001", 12, size=1.0)
    path = tmp_path / "duetdance/Skeletons/salsa/0001/skeleton_B.mat"
    savemat(path, {"skeletons": np.zeros((45, 12))})
    with pytest.raises(InvalidInput, match=r"skel ought to be 45 rows .* found nothing"):
        DUETDANCE.read(tmp_path, "train")


def test_sets_have_names() -> None:
    assert list(TWO_PERSON_SETS) == ["sbu", "k3hi", "ntu", "duetdance"]
    with pytest.raises(ConfigError, match="'kit' is none of sbu, k3hi, ntu, duetdance"):
        two_person_set("kit")
